"""Arrays in memory → curvatures: curvcli's core columns with the topology, beside what peers compute of a mesh."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from contextlib import redirect_stdout
from typing import Any

import numpy as np

from curvcli.commands.allocation import keep_memory

from .harness import Case, Results, interleaved, python, report, seconds, show, times
from .meshes import Mesh
from .peers import COMPUTE

OURS = "curvcli"
# The command keeps the memory it has touched and does without huge pages.
AS_COMMAND = "curvcli, as its command"
CASES = (OURS, AS_COMMAND, *COMPUTE)
QUICK = (OURS, AS_COMMAND, "libigl angle defect", "libigl", "VTK", "trimesh angle defect")


def curvcli(points: Any, faces: Any) -> dict[str, Any]:
    """The core preset and every count of the topology."""
    from curvcli.curvatures.catalogue import CORE, loaded
    from curvcli.curvatures.engine import evaluate, prepare
    from curvcli.mesh.counts import classify, count_groups
    from curvcli.mesh.surface import Surface

    surface = Surface(points, faces)
    prepare(loaded(), surface, CORE)  # as every analysis does
    columns = evaluate(loaded(), surface, CORE)
    return {**columns, "census": count_groups(surface, surface.whole), "kinds": classify(surface, surface.whole)}


def _memory(field: str) -> int:
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith(field)) * 1024


def child(name: str, mesh: str, warm: str) -> None:
    """Compute once on a small mesh, then once on the mesh with the clock running and the memory peak reset."""
    if name == AS_COMMAND:
        keep_memory()
    function: Callable[[Any, Any], dict[str, Any]] = COMPUTE.get(name, curvcli)
    for path in (warm, mesh):
        with np.load(path) as stored:
            points, faces = stored["points"], stored["faces"]
        try:
            with open("/proc/self/clear_refs", "w") as reset:
                reset.write("5")
        except OSError:
            pass  # elsewhere than on Linux the peak is that of the whole process
        before = _memory("VmRSS")
        begin = time.perf_counter()
        with redirect_stdout(sys.stderr):
            found = function(points, faces)
        elapsed = time.perf_counter() - begin
        peak = _memory("VmHWM") - before
    measured = {"seconds": elapsed, "bytes_per_vertex": peak / len(points)}
    if "K" in found:
        euler = len(points) - len(faces) / 2  # of closed meshes
        measured["gauss_bonnet"] = float(np.sum(found["K"])) - 2 * np.pi * euler
    report(measured)


def measure(mesh: Mesh, warm: Mesh, repeats: int, quick: bool) -> Results:
    """Every library on one mesh, in turn."""
    paths = mesh.path(".npz"), warm.path(".npz")
    pages = {AS_COMMAND: {"NUMPY_MADVISE_HUGEPAGE": "0"}}
    cases = {
        name: Case(python("-m", "benchmarks.compute", name, *paths), pages.get(name, {}))
        for name in (QUICK if quick else CASES)
    }
    return interleaved(cases, repeats, f"compute {mesh.name}")


def tables(mesh: Mesh, warm: Mesh, repeats: int, quick: bool) -> None:
    """Measure and print."""
    results = measure(mesh, warm, repeats, quick)
    show(
        f"Compute: {mesh.size:,} vertices, {mesh.shape}, {mesh.order} order; medians of {repeats}",
        results,
        [
            ("time", lambda name: seconds(results.median(name))),
            ("curvcli / it", lambda name: times(results.ratio(OURS, name))),
            ("as its command / it", lambda name: times(results.ratio(AS_COMMAND, name))),
            ("peak over the arrays", lambda name: f"{results.median(name, 'bytes_per_vertex') or 0:.0f} B/vertex"),
            ("ΣK − 2πχ", lambda name: _defect(results.median(name, "gauss_bonnet") if mesh.closed else None)),
        ],
    )


def _defect(value: float | None) -> str:
    return "" if value is None else f"{value:.0e}"


if __name__ == "__main__":
    child(*sys.argv[1:])
