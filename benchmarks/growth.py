"""Cost of each preset, and growth of the cost per vertex with the mesh."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence

import numpy as np

from curvcli.commands.allocation import keep_memory

from .harness import Case, Results, interleaved, python, report, show, times
from .meshes import Mesh

PRESETS = ("topology", "core", "paper")


def preset(name: str, path: str) -> None:
    """Time a preset with the topology, per vertex, on the mesh, after one run of it on a small mesh."""
    from curvcli.curvatures.catalogue import loaded, resolve
    from curvcli.curvatures.engine import evaluate, prepare
    from curvcli.mesh.counts import classify, count_groups
    from curvcli.mesh.surface import Surface
    from curvcli.samples import get

    small = get("icosphere")(size=1000)
    with np.load(path) as stored:
        given = (stored["points"], stored["faces"])
    for points, faces in ((small.points, small.faces), given):
        begin = time.perf_counter()
        surface = Surface(points, faces)
        names = resolve([name])
        prepare(loaded(), surface, names)  # as every analysis does
        found = evaluate(loaded(), surface, names)
        count_groups(surface, surface.whole), classify(surface, surface.whole)
        elapsed = time.perf_counter() - begin
    report({"seconds": elapsed / len(points) * 1e6, "columns": len(found)})


def _case(*arguments: str) -> Case:
    return Case(python("-m", "benchmarks.growth", *arguments), {"NUMPY_MADVISE_HUGEPAGE": "0"})


def tables(meshes: Sequence[Mesh], repeats: int) -> None:
    """Measure the presets on meshes of growing size and print the cost per vertex."""
    cases = {_row(name, mesh): _case(name, mesh.path(".npz")) for mesh in meshes for name in PRESETS}
    results = interleaved(cases, repeats, "presets")

    def against(row: str, size: int | None, name: str | None) -> str:
        mine, mesh = next((n, m) for n in PRESETS for m in meshes if row == _row(n, m))
        base = next(m for m in meshes if size in (None, m.size) and (size is not None or m == mesh))
        return times(results.ratio(row, _row(name or mine, base)))

    smallest = meshes[0].size
    show(
        f"Presets with topology, per million vertices; medians of {repeats}",
        results,
        [
            ("time", lambda row: _milliseconds(results, row)),
            ("of core", lambda row: against(row, None, "core")),
            (f"of {smallest:,} vertices", lambda row: against(row, smallest, None)),
        ],
    )


def _row(name: str, mesh: Mesh) -> str:
    order = "" if mesh.order == "regular" else f", {mesh.order} order"
    return f"{name}, {mesh.size:,} vertices{order}"


def _milliseconds(results: Results, row: str) -> str:
    return f"{1000 * (results.median(row) or 0):.0f} ms"


if __name__ == "__main__":
    keep_memory()
    preset(*sys.argv[1:])
