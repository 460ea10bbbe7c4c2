"""Meshes large enough that a process can be met in the middle of its work, written once per run."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.process.meshes import write


@pytest.fixture(scope="session")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """150,000 vertices as PLY."""
    return write("torus", 150_000, tmp_path_factory.mktemp("large") / "torus.ply")


@pytest.fixture(scope="session")
def middling(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """100,000 vertices in each format."""
    folder = tmp_path_factory.mktemp("middling")
    return {suffix: write("torus", 100_000, folder / f"torus.{suffix}") for suffix in ("obj", "ply", "stl")}


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """5,000 vertices as PLY: more in a table than a pipe or a very small disk holds."""
    return write("irregular_torus", 5_000, tmp_path_factory.mktemp("small") / "torus.ply")
