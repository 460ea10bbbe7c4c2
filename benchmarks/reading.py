"""`python -m benchmarks.reading`: CPU seconds per million vertices of every input format, beside other readers.

Each reader runs in a process of its own and reads a small file of the format first. CPU time is that of all threads. A
grid of n vertices and about 2n triangles is written by curvcli or by the library named in `WRITERS`.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray

Points, Faces = NDArray[np.float64], NDArray[np.int64]

# Large enough that its reader imports what it needs.
_SMALL = 20_000
_TIMED = """
import sys, time, warnings
warnings.simplefilter("ignore")
{reader}
read(sys.argv[1])
before = time.process_time()
read(sys.argv[2])
print(time.process_time() - before)
"""
READERS = {
    "curvcli": "from curvcli.loading.read import read_mesh_file as read",
    "trimesh": "import trimesh\ndef read(path): return trimesh.load_scene(path, process=False)",
    "trimesh with merging": "import trimesh\ndef read(path): return trimesh.load_mesh(path)",
    "meshio": "import meshio\ndef read(path): return meshio.read(path)",
    "pymeshlab": "import pymeshlab\ndef read(path): pymeshlab.MeshSet().load_new_mesh(path)",
    "pyvista": "import pyvista\ndef read(path): return pyvista.read(path)",
    "nibabel": "import nibabel\ndef read(path): return nibabel.load(path).agg_data()",
    "nibabel.freesurfer": "import nibabel\ndef read(path): return nibabel.freesurfer.read_geometry(path)",
}
# Format and kind of file: suffix, writer, other readers.
CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "ply": (".ply", "curvcli", ("trimesh", "meshio", "pymeshlab", "pyvista")),
    "stl": (".stl", "trimesh", ("trimesh", "meshio", "pymeshlab", "pyvista")),
    "obj": (".obj", "curvcli", ("meshio", "pymeshlab", "pyvista")),
    "off": (".off", "curvcli", ("trimesh", "meshio", "pymeshlab")),
    "glb": (".glb", "trimesh", ("trimesh", "trimesh with merging")),
    "gltf": (".gltf", "trimesh", ("trimesh", "trimesh with merging")),
    "3mf": (".3mf", "trimesh", ("trimesh",)),
    "fe": (".fe", "curvcli", ()),
    "vtp": (".vtp", "pyvista", ("pyvista",)),
    "vtu": (".vtu", "meshio", ("meshio", "pyvista")),
    "vtk": (".vtk", "pyvista", ("pyvista",)),
    "msh": (".msh", "meshio", ("meshio",)),
    "gii": (".gii", "nibabel", ("nibabel",)),
    "freesurfer": (".white", "nibabel", ("nibabel.freesurfer",)),
}


def grid(vertices: int) -> tuple[Points, Faces]:
    """A graph over a square grid."""
    n = int(vertices**0.5)
    u, v = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
    rows = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (rows[:-1, :-1], rows[:-1, 1:], rows[1:, 1:], rows[1:, :-1]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return np.stack([u, v, np.sin(5 * u * v)], axis=1), faces


def write(path: Path, writer: str, points: Points, faces: Faces) -> None:
    """Write a file by the named program."""
    if writer == "curvcli":
        from curvcli.output.meshes.write import write_mesh

        with path.open("wb") as stream:
            write_mesh(stream, path.suffix, points, faces)
        return
    writers: dict[str, Callable[[Path, Points, Faces], Any]] = {
        "trimesh": _by_trimesh,
        "meshio": _by_meshio,
        "pyvista": _by_pyvista,
        "nibabel": _by_nibabel,
    }
    writers[writer](path, points, faces)


def _by_trimesh(path: Path, points: Points, faces: Faces) -> None:
    import trimesh

    scene = trimesh.Scene(trimesh.Trimesh(points, faces, process=False))
    if path.suffix == ".gltf":
        files = scene.export(file_type="gltf", merge_buffers=True, embed_buffers=True)
        path.write_bytes(files["model.gltf"])
    else:
        scene.export(path)


def _by_meshio(path: Path, points: Points, faces: Faces) -> None:
    import meshio  # type: ignore[import-untyped]

    meshio.Mesh(points, [("triangle", faces)]).write(path, "gmsh" if path.suffix == ".msh" else None)


def _by_pyvista(path: Path, points: Points, faces: Faces) -> None:
    import pyvista

    pyvista.PolyData.from_regular_faces(points, faces).save(path)


def _by_nibabel(path: Path, points: Points, faces: Faces) -> None:
    import nibabel

    if path.suffix != ".gii":
        nibabel.freesurfer.write_geometry(str(path), points, faces)
        return
    arrays = [
        nibabel.gifti.GiftiDataArray(points.astype(np.float32), "NIFTI_INTENT_POINTSET"),
        nibabel.gifti.GiftiDataArray(faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE"),
    ]
    nibabel.save(nibabel.gifti.GiftiImage(darrays=arrays), str(path))


def measured(reader: str, small: Path, large: Path) -> float | None:
    """CPU seconds of a reader in a process of its own; None if it cannot read the file."""
    code = _TIMED.format(reader=READERS[reader])
    ended = subprocess.run([sys.executable, "-c", code, str(small), str(large)], capture_output=True, text=True)
    return float(ended.stdout.split()[-1]) if ended.returncode == 0 else None


@click.command()
@click.option("--size", type=click.IntRange(100), default=1_000_000, show_default=True, help="Vertices.")
@click.option("--rounds", type=click.IntRange(1), default=3, show_default=True, help="Rounds; the least time counts.")
@click.option("--save", type=click.Path(dir_okay=False), help="Write the seconds of curvcli to this JSON file.")
@click.argument("formats", nargs=-1, type=click.Choice(list(CASES)), metavar="[FORMAT]...")
def main(size: int, rounds: int, save: str | None, formats: tuple[str, ...]) -> None:
    """Measure readers of the formats, all of them if none is named, and print a Markdown table."""
    results: dict[str, dict[str, float]] = {}
    print("| format | MB | CPU seconds of curvcli | of others |\n|---|---|---|---|")
    for name in formats or CASES:
        suffix, writer, others = CASES[name]
        with tempfile.TemporaryDirectory() as folder:
            small, large = Path(folder) / f"small{suffix}", Path(folder) / f"large{suffix}"
            write(small, writer, *grid(_SMALL))
            write(large, writer, *grid(size))
            times: dict[str, list[float]] = {}
            for reader in [reader for _ in range(rounds) for reader in ("curvcli", *others)]:
                if (seconds := measured(reader, small, large)) is not None:
                    times.setdefault(reader, []).append(seconds * 1e6 / size)
            results[name] = {reader: round(min(each), 2) for reader, each in times.items()}
            rest = ", ".join(f"{reader} {value}" for reader, value in results[name].items() if reader != "curvcli")
            megabytes = round(large.stat().st_size / size)
            print(f"| {name} | {megabytes} | {results[name].get('curvcli')} | {rest} |", flush=True)
    if save:
        path = Path(save)
        known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        path.write_text(json.dumps(known | results, indent=1, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
