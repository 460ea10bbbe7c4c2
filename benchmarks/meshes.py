"""Meshes of any size as arrays and files, made once per cache folder."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import polars as pl
from numpy.typing import NDArray

from curvcli.output.meshes.stl import write_stl
from curvcli.samples import get

Shape = Literal["sphere", "torus", "plate"]
Order = Literal["regular", "morton", "random"]
SUFFIXES = (".npz", ".ply", ".obj", ".stl")


@dataclass(frozen=True)
class Mesh:
    """A mesh in the cache folder, one file per format. order: of its vertices and faces.

    `regular` as the shape is made, row by row; `morton` along a space-filling curve, as scanners and octrees leave it;
    `random` as nothing would have it."""

    folder: Path
    shape: Shape
    size: int
    order: Order = "regular"

    @property
    def name(self) -> str:
        """Stem of its files."""
        return f"{self.shape}-{self.order}-{self.size}"

    @property
    def closed(self) -> bool:
        """True without a boundary."""
        return self.shape != "plate"

    def path(self, suffix: str) -> str:
        """Its file of that format, written if it is not there."""
        path = self.folder / f"{self.name}{suffix}"
        if not path.exists():
            points, faces = self._arrays() if suffix != ".npz" else make(self.shape, self.size, self.order)
            unfinished = path.with_name(f"unfinished-{path.name}")
            _WRITERS[suffix](unfinished, points, faces)
            unfinished.rename(path)
        return str(path)

    def _arrays(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        with np.load(self.path(".npz")) as stored:
            return stored["points"], stored["faces"]


def make(shape: Shape, size: int, order: Order) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points (V, 3) that float32 holds exactly, and faces (F, 3).

    A bumpy sphere with jitter, a torus with jitter, or a wavy plate with jitter and up to 400 holes, in which vertices
    are left that no face uses.
    """
    if shape == "torus":
        sample = get("torus")(size=size, jitter=0.2)
        points, faces = sample.points, sample.faces
    elif shape == "plate":
        sample = get("plane")(size=size, jitter=0.2)
        x, y, _ = sample.points.T
        points = np.stack([x, y, 0.1 * np.sin(9 * x) * np.cos(7 * y)], axis=1)
        hole = np.hypot(20 * x % 1 - 0.5, 20 * y % 1 - 0.5) < 0.2
        faces = sample.faces[~hole[sample.faces].any(axis=1)]
    else:
        sample = get("icosphere")(size=size)
        faces = sample.faces
        x, y, z = sample.points.T
        edge = (4 * np.pi / len(sample.faces)) ** 0.5 * 1.5
        shaken = np.random.default_rng(0).normal(scale=0.07 * edge, size=sample.points.shape)
        points = sample.points * (1 + 0.1 * np.sin(5 * x) * np.cos(3 * y) + 0.05 * np.sin(7 * z))[:, None] + shaken
    faces = faces.astype(np.int64)
    if order != "regular":
        keys = morton(points) if order == "morton" else np.random.default_rng(1).permutation(len(points))
        first = np.argsort(keys, kind="stable")
        place = np.empty(len(points), np.int64)
        place[first] = np.arange(len(points))
        points, faces = points[first], place[faces]
        faces = faces[np.argsort(faces.min(axis=1)) if order == "morton" else slice(None)]
    return np.ascontiguousarray(points, np.float32).astype(np.float64), np.ascontiguousarray(faces)


def morton(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """(V,) the bits of the three coordinates, 20 of each, one after the other: near in space is near in this order."""
    low, high = points.min(axis=0), points.max(axis=0)
    cells = ((points - low) / (high - low).max() * (2**20 - 1)).astype(np.int64)
    keys = np.zeros(len(points), np.int64)
    for bit in range(20):
        for axis in range(3):
            keys |= (cells[:, axis] >> bit & 1) << (3 * bit + axis)
    return keys


def _write_npz(path: Path, points: NDArray[Any], faces: NDArray[Any]) -> None:
    with path.open("wb") as stream:
        np.savez(stream, points=points, faces=faces)


def _write_ply(path: Path, points: NDArray[Any], faces: NDArray[Any]) -> None:
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(faces), [("size", "u1"), ("corners", "<i4", 3)])
    rows["size"], rows["corners"] = 3, faces
    with path.open("wb") as stream:
        stream.write(header.encode())
        points.astype("<f4").tofile(stream)
        rows.tofile(stream)


def _write_obj(path: Path, points: NDArray[Any], faces: NDArray[Any]) -> None:
    with path.open("wb") as stream:
        for keyword, rows in (("v", points), ("f", faces + 1)):
            table = pl.DataFrame({"keyword": [keyword]}).join(pl.DataFrame(rows), how="cross")
            table.write_csv(stream, include_header=False, separator=" ", float_precision=7)


def _write_stl(path: Path, points: NDArray[Any], faces: NDArray[Any]) -> None:
    with path.open("wb") as stream:
        write_stl(stream, points, faces)


_WRITERS = {".npz": _write_npz, ".ply": _write_ply, ".obj": _write_obj, ".stl": _write_stl}
