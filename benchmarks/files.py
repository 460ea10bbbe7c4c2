"""Files → arrays and columns → files, without what stands before and after: reading and writing alone."""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from .harness import Case, Results, interleaved, python, report, seconds, show, times
from .meshes import Mesh
from .peers import READ, write_polars, write_savetxt

SUFFIXES = (".ply", ".obj", ".stl")
OURS, ARRAYS, BYTES = "curvcli", "numpy.fromfile, as arrays", "numpy.fromfile, bytes alone"
NAMES = ["vertex", "x", "y", "z", *(f"column_{k}" for k in range(8))]


def read_curvcli(path: str) -> object:
    """Positions and triangles of the file, equal positions of STL merged exactly, all that is wrong with it counted."""
    from curvcli.loading.load import load

    return load(path)


def read_bytes(path: str) -> object:
    """The bytes of the file: nothing reads faster."""
    return np.fromfile(path, np.uint8)


def read_fromfile(path: str) -> object:
    """Positions and triangles of a binary PLY that has nothing else, as contiguous arrays; nothing is checked."""
    with open(path, "rb") as stream:
        header = iter(stream.readline, b"end_header\n")
        vertices, faces = (int(line.split()[2]) for line in header if line.startswith(b"element"))
        positions = np.fromfile(stream, "<f4", 3 * vertices).reshape(-1, 3)
        rows = np.fromfile(stream, [("size", "u1"), ("corners", "<i4", 3)], faces)
    return positions.astype(np.float64), np.ascontiguousarray(rows["corners"])


def write_curvcli(path: str, names: list[str], table: list[Any]) -> None:
    """The table of the command."""
    from curvcli.output.tables.write import write_table

    with open(path, "wb") as stream:
        write_table(stream, dict(zip(names, table, strict=True)), ".csv")


def write_ply(path: str, names: list[str], table: list[Any]) -> None:
    """A PLY file with every column as a property, without faces."""
    from curvcli.output.meshes.ply import write_ply as write

    columns = dict(zip(names, table, strict=True))
    points = np.stack([columns.pop(axis) for axis in "xyz"], axis=1)
    with open(path, "wb") as stream:
        write(stream, points, np.empty((0, 3), np.int32), vertex_properties=columns)


def write_bytes(path: str, names: list[str], table: list[Any]) -> None:
    """The columns as they lie in memory."""
    with open(path, "wb") as stream:
        for column in table:
            column.tofile(stream)


READERS: dict[str, Callable[[str], object]] = {OURS: read_curvcli, **READ, ARRAYS: read_fromfile, BYTES: read_bytes}
WRITERS: dict[str, Callable[[str, list[str], list[Any]], None]] = {
    "curvcli, CSV": write_curvcli,
    "polars, CSV": write_polars,
    "savetxt, CSV": write_savetxt,
    "curvcli, PLY": write_ply,
    "numpy.tofile, bytes alone": write_bytes,
}


def child(what: str, name: str, path: str, warm: str) -> None:
    """Do it once with a small file, so that imports do not count, then with the clock running."""
    for each in (warm, path):
        if what == "read":
            begin = time.perf_counter()
            READERS[name](each)
        else:
            with np.load(each) as stored:
                points = stored["points"]
            columns = np.random.default_rng(0).standard_normal((8, len(points)))
            table = [np.arange(len(points), dtype=np.int32), *np.ascontiguousarray(points.T), *columns]
            with tempfile.TemporaryDirectory(dir=os.path.dirname(path)) as folder:
                begin = time.perf_counter()
                WRITERS[name](f"{folder}/out", NAMES, table)
                elapsed = time.perf_counter() - begin
            continue
        elapsed = time.perf_counter() - begin
    report({"seconds": elapsed})


def tables(mesh: Mesh, warm: Mesh, repeats: int) -> None:
    """Measure and print, a table for each format that is read and one for writing."""

    def cases(what: str, names: Any, suffix: str) -> dict[str, Case]:
        paths = mesh.path(suffix), warm.path(suffix)
        return {name: Case(python("-m", "benchmarks.files", what, name, *paths)) for name in names}

    def readers(suffix: str) -> list[str]:
        return [name for name in READERS if suffix == ".ply" or name != ARRAYS]

    jobs = [(f"Read {suffix[1:].upper()}", OURS, cases("read", readers(suffix), suffix)) for suffix in SUFFIXES]
    jobs.append(("Write twelve columns", "curvcli, CSV", cases("write", WRITERS, ".npz")))
    for title, ours, these in jobs:
        _table(title, ours, interleaved(these, repeats, f"{title} {Path(mesh.name).name}"), mesh, repeats)


def _table(title: str, ours: str, results: Results, mesh: Mesh, repeats: int) -> None:
    show(
        f"{title}: {mesh.size:,} vertices, imports not counted; medians of {repeats}",
        results,
        [
            ("time", lambda name: seconds(results.median(name))),
            (f"{ours} / it", lambda name: times(results.ratio(ours, name))),
        ],
    )


if __name__ == "__main__":
    child(*sys.argv[1:])
