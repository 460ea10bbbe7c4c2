"""The whole process: a file goes in, a CSV and a coloured PLY come out."""

from __future__ import annotations

import tempfile
from pathlib import Path

from .harness import Case, Results, interleaved, python, seconds, show, times
from .meshes import Mesh

FORMATS = (".ply", ".obj", ".stl")
OURS = "curvcli"
SUMMARY = "curvcli, core preset and summary"

# The columns that peers have, or can derive from what they have.
PEERS_COLUMNS = "K,A,H_vec,h,K_density,willmore"
PEERS = {
    "VTK, polars": ("VTK", "polars"),
    "VTK, savetxt": ("VTK", "savetxt"),
    "libigl, savetxt": ("libigl", "savetxt"),
    "trimesh, savetxt": ("trimesh", "savetxt"),
    "PyMeshLab, savetxt": ("PyMeshLab", "savetxt"),
}


def measure(path: str, folder: Path, repeats: int) -> Results:
    """Every way from one file to its outputs, in turn; all make the same two files anew."""
    csv, ply = str(folder / "out.csv"), str(folder / "out.ply")
    ours = python("-m", "curvcli", "analyze", path, "-o", csv, "-o", ply)
    commands = {OURS: [*ours, "-q", "-p", PEERS_COLUMNS], SUMMARY: ours}
    commands |= {name: python("-m", "benchmarks.peers", *how, path, csv, ply) for name, how in PEERS.items()}
    cases = {name: Case(command, outputs=(csv, ply)) for name, command in commands.items()}
    return interleaved(cases, repeats, f"end to end {Path(path).name}")


def tables(mesh: Mesh, repeats: int) -> None:
    """Measure and print, a table for each format."""
    with tempfile.TemporaryDirectory(dir=mesh.folder) as folder:
        for suffix in FORMATS:
            _table(mesh, suffix, measure(mesh.path(suffix), Path(folder), repeats), repeats)


def _table(mesh: Mesh, suffix: str, results: Results, repeats: int) -> None:
    show(
        f"File to CSV and coloured PLY: {mesh.size:,} vertices, {suffix[1:].upper()}, whole process; "
        f"medians of {repeats}",
        results,
        [
            ("time", lambda name: seconds(results.median(name, "wall"))),
            ("curvcli / it", lambda name: times(results.ratio(OURS, name, "wall"))),
        ],
    )
