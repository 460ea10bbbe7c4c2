"""Conventions: what a number means depends on them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Conventions:
    """The choices that change numbers or their names; every output states them."""

    mean: str = "sum"
    area: str = "barycentric"
    orient: str = "file"
    weld: str = "none"
    unit: str | None = None
    regions: str | None = None
    scale: str | None = None
    normals: str | None = None
    noise: str | None = None
