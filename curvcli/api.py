"""The Python interface: `load`, `analyze` and what they return."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .analysis.request import Request
from .analysis.result import Result, compute
from .curvatures.catalogue import loaded
from .curvatures.registry import Registry
from .loading.load import load
from .mesh.surface import Orient, Surface
from .output.write import write_outputs
from .report.build import build

__all__ = ["Analysis", "Registry", "Surface", "analyze", "load", "loaded"]


class Analysis(Result):
    """Everything computed of one surface: `vertices`, `edges`, `faces`, `totals`, `checks`, `notices`, `report()`.

    Columns are in the file's unit of length and in the chosen convention for H; NaN is undefined.
    """

    def report(self) -> dict[str, Any]:
        """The report of the interface, as plain Python values ready for JSON."""
        return build(self)

    def write(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the vertex table, a coloured mesh, a picture or the report, as the suffix says; whole or not at all."""
        write_outputs(self, [str(path)], force=force)


def analyze(
    surface: Any,
    passes: str | Iterable[str] | None = None,
    *,
    area: Literal["barycentric", "mixed", "voronoi"] = "barycentric",
    mean: Literal["sum", "average"] = "sum",
    orient: Orient | None = None,
    weld: str | float = "auto",
    unit: str | None = None,
    regions: str | os.PathLike[str] | NDArray[np.integer[Any]] | None = None,
    checks: str | Iterable[str] | None = None,
    rings: str | int | Iterable[str | int] | None = None,
    radius: str | float | Iterable[str | float] | None = None,
    normals: Literal["mesh", "file"] = "mesh",
    noise: float | None = None,
) -> Analysis:
    """Compute curvatures of a surface, its totals and the identities that prove them.

    surface: a Surface, a path, a trimesh.Trimesh or a pair (points (V, 3), faces (F, 3)).
    passes: a preset (`topology`, `core`, `paper`, `estimates`, `all`) or names; None is `core`, with `estimates` where
    a scale is asked for. area: the cell of `K_density`. mean: whether H is κ₁ + κ₂ or their average. orient: `file`, or
    `outward` to turn closed patches that are inside out; None is what a Surface was made with, else `file`. weld: how
    the vertices of a file are merged, see `curvcli.load`. unit: a label for lengths. regions: a label per face
    (negative: none), or the name of the file, record or property that holds them. checks: names of the identities to
    test, whatever they need; None is those whose needs the chosen passes meet. rings, radius: how far estimates look,
    in rings of edges or at a radius (a length, or mean edge lengths such as `3e`); several (`2e,4e`, or a list) give
    one column for each. normals: whose normals the corrected curvatures use, the mesh's or those the file gives. noise:
    the standard deviation of each coordinate, for `K_sigma` and `h_sigma`; None is the precision of the coordinates.
    Errors: UsageError for an unknown name or an option that does not fit, InputError for a mesh that is no surface.
    """
    options: dict[str, Any] = {
        "area": area,
        "mean": mean,
        "orient": orient,
        "weld": weld,
        "unit": unit,
        "regions": regions,
        "checks": checks,
        "rings": rings,
        "radius": radius,
        "normals": normals,
        "noise": noise,
    }
    return compute(surface, Request(passes=passes, **options), Analysis)
