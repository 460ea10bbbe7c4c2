"""Test data that may lie beside the repository: `shared/meshes` and `shared/exact`."""

from __future__ import annotations

from pathlib import Path

import pytest


def _find() -> Path | None:
    """The folder `shared` next to the repository or to a folder above it."""
    for folder in Path(__file__).resolve().parents[2].parents:
        if (folder / "shared" / "meshes" / "index.csv").is_file():
            return folder / "shared"
    return None


SHARED = _find()
needs_shared = pytest.mark.skipif(
    SHARED is None, reason="no folder shared/meshes with an index.csv beside the repository"
)


def case(name: str) -> str:
    """The path of a file of `shared/cases`; the test is skipped without it."""
    path = None if SHARED is None else SHARED / "cases" / name
    if path is None or not path.is_file():
        pytest.skip(f"no {name} in shared/cases")
    return str(path)
