"""One mesh too large for most tools: a binary PLY written row by row, then the whole command on it.

`python -m benchmarks.large --faces 100000000 --folder /somewhere/with/8/GB`
"""

from __future__ import annotations

import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import click
import numpy as np

from .harness import CONSOLE, python


def write_torus(path: Path, faces: int) -> int:
    """Write a torus of about so many triangles, a row of the grid at a time; returns the number of its vertices."""
    rows = int(np.sqrt(faces / 4))
    columns = faces // (2 * rows)
    v = np.linspace(0, 2 * np.pi, columns, endpoint=False)
    here = np.arange(columns, dtype=np.int64)
    right = np.roll(here, -1)
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {rows * columns}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {2 * rows * columns}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    triangles = np.empty(2 * columns, [("size", "u1"), ("corners", "<i4", 3)])
    triangles["size"] = 3
    with path.open("wb") as stream:
        stream.write(header.encode())
        for row in range(rows):
            u = 2 * np.pi * row / rows
            ring = 3 + np.cos(v)
            points = np.stack([ring * np.cos(u), ring * np.sin(u), np.sin(v)], axis=1)
            stream.write(points.astype("<f4").tobytes())
        for row in range(rows):
            low, high = row * columns, (row + 1) % rows * columns
            triangles["corners"][:columns] = np.stack([low + here, high + here, high + right], axis=1)
            triangles["corners"][columns:] = np.stack([low + here, high + right, low + right], axis=1)
            stream.write(triangles.tobytes())
    return rows * columns


@click.command()
@click.option("--faces", type=click.IntRange(1000), default=100_000_000, show_default=True)
@click.option("--folder", type=click.Path(exists=True, file_okay=False), help="For the mesh and the table.")
def main(faces: int, folder: str | None) -> None:
    """Analyze one very large mesh to Parquet; print seconds and the peak of memory per vertex."""
    with tempfile.TemporaryDirectory(dir=folder) as inside:
        mesh, table = Path(inside, "torus.ply"), Path(inside, "torus.parquet")
        vertices = write_torus(mesh, faces)
        begin = time.perf_counter()
        done = subprocess.run(python("-m", "curvcli", "analyze", str(mesh), "-p", "core", "-o", str(table)))
        elapsed = time.perf_counter() - begin
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
        arrays = 24 * vertices + 12 * 2 * vertices  # positions as doubles, corners as 32-bit integers
        CONSOLE.print(
            f"{vertices:,} vertices, {2 * vertices:,} faces, exit code {done.returncode}: {elapsed:.0f} s, "
            f"{1e6 * elapsed / vertices:.2f} µs per vertex; peak {peak / 2**30:.1f} GiB, "
            f"{(peak - arrays) / vertices:.0f} bytes per vertex over the arrays of the mesh; "
            f"table {os.path.getsize(table) / 2**30 if done.returncode == 0 else 0:.1f} GiB"
        )


if __name__ == "__main__":
    main()
