"""Start-up time: an empty Python, imports, the help, a mesh of a thousand vertices."""

from __future__ import annotations

import tempfile

from .harness import Case, Results, interleaved, python, show
from .meshes import Mesh

EMPTY = "empty Python"
TRIMESH = "import trimesh"
IMPORTS = (
    "numpy",
    "scipy.sparse.csgraph",
    "trimesh",
    "polars",
    "click",
    "rich.console",
    "msgspec",
    "cmap",
    "click, rich.console, polars, trimesh",
)


def measure(mesh: Mesh, repeats: int) -> Results:
    """Imports and small commands, in turn, after one round that fills the caches."""
    cases = {EMPTY: Case(python("-c", "pass"))}
    cases |= {f"import {names}": Case(python("-c", f"import {names}")) for names in IMPORTS}
    cases["curvcli --help"] = Case(python("-m", "curvcli", "--help"))
    with tempfile.TemporaryDirectory(dir=mesh.folder) as folder:
        for suffix in (".ply", ".obj", ".stl"):
            path = mesh.path(suffix)
            analyze = python("-m", "curvcli", "analyze", path)
            cases[f"curvcli analyze, {suffix[1:].upper()}"] = Case(analyze)
            cases[f"curvcli analyze -o CSV, {suffix[1:].upper()}"] = Case(
                [*analyze, "-q", "--force", "-o", f"{folder}/out.csv"]
            )
        return interleaved(cases, repeats, "start", warm_up=True)


def tables(mesh: Mesh, repeats: int) -> None:
    """Measure and print."""
    results = measure(mesh, repeats)
    show(
        f"Start: whole process, the mesh has {mesh.size:,} vertices; medians of {repeats}",
        results,
        [
            ("time", lambda name: _milliseconds(results.median(name, "wall"))),
            ("over an empty Python", lambda name: _beyond(results, name, EMPTY)),
            ("over import trimesh", lambda name: _beyond(results, name, TRIMESH) if "curvcli" in name else ""),
        ],
    )


def _beyond(results: Results, name: str, base: str) -> str:
    one, other = results.median(name, "wall"), results.median(base, "wall")
    return "" if one is None or other is None else _milliseconds(one - other)


def _milliseconds(value: float | None) -> str:
    return "" if value is None else f"{1000 * value:.0f} ms"
