"""What each registered pass and each preset costs, and how the cost of a vertex grows with the mesh."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from curvcli.commands.allocation import keep_memory

from .harness import CONSOLE, Case, Results, interleaved, python, report, show, times
from .meshes import Mesh

PRESETS = ("topology", "core", "paper")


def each_pass(path: str) -> None:
    """Time every registered pass once, what it needs being there; `(incidence)` stands for edges, stars and pieces."""
    from curvcli.census import census, classify
    from curvcli.declare import passes
    from curvcli.pipeline import evaluate, load_passes, schedule
    from curvcli.surface import Surface

    load_passes()
    with np.load(path) as stored:
        points, faces = stored["points"], stored["faces"]
    begin = time.perf_counter()
    surface = Surface(points, faces)
    census(surface, surface.whole), classify(surface, surface.whole), surface.interior, surface.corner_sign
    measured = {"(incidence)": time.perf_counter() - begin}
    have: dict[str, NDArray[Any]] = {}
    for one in schedule([q.name for q in passes.quantities(public=False)], "barycentric"):
        begin = time.perf_counter()
        have = evaluate(surface, [quantity.name for quantity in one.provides], known=have)
        measured[one.name] = time.perf_counter() - begin
    report({name: value / len(points) * 1e6 for name, value in measured.items()})


def preset(name: str, path: str) -> None:
    """Time a preset with the topology, per vertex, on the mesh, after one run of it on a small mesh."""
    from curvcli.census import census, classify
    from curvcli.pipeline import evaluate, prepare, resolve
    from curvcli.samples import get
    from curvcli.surface import Surface

    small = get("icosphere")(size=1000)
    with np.load(path) as stored:
        given = (stored["points"], stored["faces"])
    for points, faces in ((small.points, small.faces), given):
        begin = time.perf_counter()
        surface = Surface(points, faces)
        names = resolve([name])
        prepare(surface, names)  # as every analysis does
        found = evaluate(surface, names)
        census(surface, surface.whole), classify(surface, surface.whole)
        elapsed = time.perf_counter() - begin
    report({"seconds": elapsed / len(points) * 1e6, "columns": len(found)})


def _case(*arguments: str) -> Case:
    return Case(python("-m", "benchmarks.quantities", *arguments), {"NUMPY_MADVISE_HUGEPAGE": "0"})


def pass_table(mesh: Mesh, repeats: int) -> None:
    """Measure every pass and print the dearest first."""
    results = interleaved({"passes": _case("passes", mesh.path(".npz"))}, repeats, f"passes {mesh.name}")
    for reason in results.failures.values():
        CONSOLE.print(f"[yellow]the passes could not be timed:[/yellow] {reason}")
        return
    cost = {name: results.median("passes", name) or 0.0 for name in results.rounds["passes"][0] if name != "wall"}
    table = Table(title=f"Passes: {mesh.size:,} vertices; medians of {repeats}", title_justify="left", pad_edge=False)
    table.add_column("pass")
    table.add_column("per million vertices", justify="right")
    table.add_column("of star_sums", justify="right")
    for name, value in sorted(cost.items(), key=lambda item: -item[1]):
        table.add_row(name, f"{1000 * value:.0f} ms", times(value / cost["star_sums"]))
    CONSOLE.print(table)
    CONSOLE.print()


def growth_table(meshes: Sequence[Mesh], repeats: int) -> None:
    """Measure the presets on meshes of growing size and print the cost per vertex."""
    cases = {_row(name, mesh): _case("preset", name, mesh.path(".npz")) for mesh in meshes for name in PRESETS}
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
    if sys.argv[1] == "passes":
        each_pass(sys.argv[2])
    else:
        preset(sys.argv[2], sys.argv[3])
