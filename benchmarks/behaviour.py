"""`python -m benchmarks.behaviour`: the answer of each library to five files with known curvature.

Every library reads the file with its own reader and computes with its own functions, at their defaults. Densities are
multiplied with the area that the library divides by, so that sums of Gauss curvature can be compared. Peers that are
not installed are named and left out.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np
from numpy.typing import NDArray
from rich.table import Table

from curvcli.errors import CurvcliError
from curvcli.output.meshes.stl import write_stl
from curvcli.samples import get

from . import peers
from .harness import CONSOLE

Floats = NDArray[np.float64]

# geometry-central has no curvatures in Python; `build` beside it makes this program.
GEOMETRY_CENTRAL = Path(__file__).parent / "geometry_central" / "curvatures"


@dataclass(frozen=True)
class Said:
    """The answer of a library: K at every row, as a measure; H, if it has one, as its own density."""

    K: Floats
    H: Floats | None = None

    @property
    def rows(self) -> int:
        return len(self.K)

    @property
    def total(self) -> float:
        """The sum of K in units of π, its rounding left out."""
        return round(float(np.nansum(self.K)) / np.pi, 12) + 0.0  # zero has no sign


def star_areas(points: Any, faces: Any) -> Floats:
    """A third of the area of the faces at each vertex."""
    a, b, c = (np.asarray(points, np.float64)[np.asarray(faces)[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
    return np.asarray(np.bincount(np.asarray(faces).ravel(), np.repeat(area, 3), len(points)), np.float64)


def mixed_areas(points: Any, faces: Any) -> Floats:
    """The mixed cells of Meyer et al., 0 where there is no face."""
    import curvcli

    return np.nan_to_num(curvcli.analyze((points, faces), ["A_mixed"]).column("A_mixed"))


# ---------------------------------------------------------------- the libraries, by their own readers


def ours(path: str) -> Said:
    import curvcli

    analysis = curvcli.analyze(path)
    K, turning = analysis.vertices["K"], analysis.vertices["kappa_g"]
    # The sum that Gauss–Bonnet speaks of has both; a row has one of them, or neither.
    return Said(np.where(np.isnan(K), turning, K), analysis.vertices["h_signed"])


def libigl(path: str) -> Said:
    points, faces = peers.read_file_libigl(path)
    K = peers.libigl_angle_defect(points, faces)["K"]
    if faces.max() + 1 < len(points):  # its mass matrix has no rows for them
        return Said(K)
    return Said(K, np.linalg.norm(peers.libigl(points, faces)["H"], axis=1))


def vtk(path: str) -> Said:
    points, faces = peers.read_vtk(path)
    found = peers.vtk(points, faces)
    return Said(found["pointwise"] * star_areas(points, faces), found["H"])


def trimesh(path: str) -> Said:
    points, faces = peers.read_trimesh(path)
    return Said(peers.trimesh(points, faces)["K"])


def pymeshlab(path: str) -> Said:
    import pymeshlab as library

    meshes = library.MeshSet()
    meshes.load_new_mesh(path)
    mesh = meshes.current_mesh()
    found = peers.discrete_curvatures(meshes)
    return Said(found["pointwise"] * mixed_areas(mesh.vertex_matrix(), mesh.face_matrix()), found["H"])


def geometry_central(path: str) -> Said:
    if not GEOMETRY_CENTRAL.exists():
        raise ModuleNotFoundError(name="benchmarks/geometry_central/build makes it")
    done = subprocess.run([str(GEOMETRY_CENTRAL), path], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    gauss, mean, area = np.array([line.split() for line in done.stdout.splitlines()], np.float64).T
    return Said(gauss, mean / area)


LIBRARIES: dict[str, Callable[[str], Said]] = {
    "curvcli": ours,
    "libigl": libigl,
    "VTK": vtk,
    "PyMeshLab": pymeshlab,
    "trimesh": trimesh,
    "geometry-central": geometry_central,
}


# ---------------------------------------------------------------- the files


def write_obj(path: Path, points: Floats, faces: Any, corners: Any = None, texture: Any = ()) -> None:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()] + [f"vt {u!r} {v!r}" for u, v in texture]
    for number, face in enumerate(np.asarray(faces).tolist()):
        if corners is None:
            lines.append("f " + " ".join(str(vertex + 1) for vertex in face))
        else:
            pairs = zip(face, corners[number], strict=True)
            lines.append("f " + " ".join(f"{vertex + 1}/{corner + 1}" for vertex, corner in pairs))
    path.write_text("\n".join(lines) + "\n")


def hemisphere(folder: Path) -> Path:
    made = get("hemisphere")(size=400)
    write_obj(folder / "hemisphere.obj", made.points, made.faces)
    return folder / "hemisphere.obj"


def square(folder: Path) -> Path:
    made = get("plane")(size=100, jitter=0.3)
    write_obj(folder / "square.obj", made.points, made.faces)
    return folder / "square.obj"


def stl(folder: Path) -> Path:
    made = get("icosphere")(size=162)
    with (folder / "sphere.stl").open("wb") as stream:
        write_stl(stream, made.points, made.faces)
    return folder / "sphere.stl"


def loose(folder: Path) -> Path:
    """The sphere with one more vertex, the last, which no face uses."""
    made = get("icosphere")(size=162)
    write_obj(folder / "loose.obj", np.vstack([made.points, [2.0, 2.0, 2.0]]), made.faces)
    return folder / "loose.obj"


def seam(folder: Path) -> Path:
    """The sphere with texture coordinates that jump along a meridian."""
    made = get("icosphere")(size=162)
    u = np.arctan2(made.points[:, 1], made.points[:, 0])[made.faces] / (2 * np.pi) % 1
    u = np.where(u.max(axis=1, keepdims=True) - u > 0.5, u + 1, u)
    pairs = np.round(np.stack([u, (made.points[:, 2][made.faces] + 1) / 2], axis=2).reshape(-1, 2), 9)
    texture, corners = np.unique(pairs, axis=0, return_inverse=True)
    write_obj(folder / "seam.obj", made.points, made.faces, corners.reshape(-1, 3).tolist(), texture.tolist())
    return folder / "seam.obj"


@dataclass(frozen=True)
class Case:
    """A file, its known curvature, and a summary of an answer in a few words."""

    make: Callable[[Path], Path]
    truth: str
    told: Callable[[Said], str]


def _boundary(said: Said) -> str:
    """The total, and the largest |H| where the surface is of constant mean curvature."""
    if said.H is None:
        return f"ΣK = {said.total:.2f}π"
    largest = float(np.nanmax(np.abs(said.H)))
    return f"ΣK = {said.total:.2f}π, H up to {largest if largest > 1e-9 else 0:.3g}"


def _rows(said: Said) -> str:
    return f"{said.rows} vertices, ΣK = {said.total:.2f}π"


def _last(said: Said) -> str:
    value = "null" if np.isnan(said.K[-1]) else f"{said.K[-1] / np.pi:.2f}π"
    kept = "row dropped" if said.rows == 162 else f"K = {value} there"
    return f"{kept}, ΣK = {said.total:.2f}π"


CASES: dict[str, Case] = {
    "hemisphere": Case(hemisphere, "ΣK + Σκ_g = 2π; H = 2 (or 1, averaged) inside, undefined on the rim", _boundary),
    "flat square": Case(square, "ΣK + Σκ_g = 2π, all of it at the corners; H = 0", _boundary),
    "STL": Case(stl, "162 vertices, ΣK = 4π", _rows),
    "loose vertex": Case(loose, "no curvature there; ΣK = 4π", _last),
    "texture seam": Case(seam, "162 vertices, ΣK = 4π", _rows),
}


@contextmanager
def quiet() -> Any:
    """Native code of libraries writes to the streams themselves."""
    sys.stdout.flush()
    kept, nowhere = (os.dup(1), os.dup(2)), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1), os.dup2(nowhere, 2)
    try:
        with redirect_stdout(sys.stderr):
            yield
    finally:
        for number, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, number)
            os.close(copy)
        os.close(nowhere)


def measure(libraries: Iterable[str] | None = None) -> dict[str, dict[str, str]]:
    """The answer of each library, or of the named ones, to each case, in words; `not installed` without the library."""
    found: dict[str, dict[str, str]] = {}
    with tempfile.TemporaryDirectory() as folder:
        files = {name: str(case.make(Path(folder))) for name, case in CASES.items()}
        for library in libraries or LIBRARIES:
            ask = LIBRARIES[library]
            found[library] = {}
            for name, case in CASES.items():
                try:
                    with quiet():
                        said = ask(files[name])
                    found[library][name] = case.told(said)
                except ModuleNotFoundError as error:
                    found[library][name] = f"not installed: {error.name}"
                except (RuntimeError, ValueError, IndexError, OSError, CurvcliError) as error:
                    found[library][name] = f"fails: {' '.join(str(error).split())[:60]}"
    return found


def markdown(found: dict[str, dict[str, str]]) -> str:
    """A row for each library, a column for each case, the truth first."""
    lines = ["| | " + " | ".join(CASES) + " |", "|---" * (len(CASES) + 1) + "|"]
    lines.append("| *true* | " + " | ".join(case.truth for case in CASES.values()) + " |")
    lines += [f"| {library} | " + " | ".join(said.values()) + " |" for library, said in found.items()]
    return "\n".join(lines)


@click.command()
@click.option("--markdown", "as_markdown", is_flag=True, help="As a Markdown table.")
def main(as_markdown: bool) -> None:
    """Ask every installed library about five files on which the truth is known."""
    found = measure()
    if as_markdown:
        click.echo(markdown(found))
        return
    table = Table(pad_edge=False)
    for header in ("", *CASES):
        table.add_column(header, overflow="fold")
    table.add_row("true", *(case.truth for case in CASES.values()))
    for library, said in found.items():
        table.add_row(library, *said.values())
    CONSOLE.print(table)


if __name__ == "__main__":
    main()
