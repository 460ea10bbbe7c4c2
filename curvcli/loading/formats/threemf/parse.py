"""3MF: the items of the build, each with its object placed, in the order of the file."""

from __future__ import annotations

import numpy as np

from ....errors import InputError
from ....mesh.file import MeshFile
from ...copies import (
    Matrix,
    Runs,
    check_copies,
    compose,
    flip_mirrored,
    label_faces,
    label_runs,
    transformed,
    unique_names,
)
from ...pieces import Pieces
from .model import Model, ObjectMesh, parse_model
from .package import Package

_DEEPEST = 100


def parse_3mf(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse a package: vertices and triangles of every item of the build, components in their order, placed.

    The unit is that of the model. Errors: InputError for a damaged package, an object that does not exist or contains
    itself, or so many copies that they are out of proportion to the file.
    """
    data = pieces.rest()
    package = Package(data)
    materials: dict[str, int] = {}
    root = package.root()
    models = {_key(root): parse_model(package.model(root), root, materials)}
    placed: list[tuple[ObjectMesh, Matrix]] = []
    runs: Runs = []
    names: list[str] = []
    vertices = faces = copies = 0
    for number, (target, path, matrix, part_number) in enumerate(models[_key(root)].items):
        stack = [(target, _key(path or root), matrix, 0)]
        count = 0
        while stack:
            each, key, outer, depth = stack.pop()
            if key not in models:
                models[key] = parse_model(package.model(key), key, materials)
            model = models[key]
            if each not in model.names:
                raise InputError(f"object {each[:40]} not found in the model", place=key[:80])
            if depth > _DEEPEST:
                raise InputError("components more than 100 deep found, or an object that contains itself")
            if part := model.meshes.get(each):
                placed.append((part, outer))
                vertices, faces = vertices + len(part.points), faces + len(part.faces)
                count += len(part.faces)
            inner = model.components[each]
            stack += [
                (child, _key(other or key), compose(outer, own), depth + 1) for child, other, own in reversed(inner)
            ]
            copies += len(inner)
            check_copies(copies, vertices, faces, len(data), max_faces)
        runs.append((number, count))
        names.append(part_number or models[_key(path or root)].names[target])
    if not faces:
        raise InputError("no faces", hint="a surface needs an item in the build with a mesh of triangles")
    return _assembled(models[_key(root)], placed, runs, unique_names(names), list(materials))


def _key(path: str) -> str:
    return path.lower().lstrip("/")


def _assembled(
    root: Model, placed: list[tuple[ObjectMesh, Matrix]], runs: Runs, names: list[str], materials: list[str]
) -> MeshFile:
    begins = np.cumsum([0, *(len(part.points) for part, _ in placed)]).tolist()
    points = np.concatenate([transformed(part.points, matrix) for part, matrix in placed])
    pairs = zip(placed, begins, strict=False)
    corners = np.concatenate([flip_mirrored(part.faces, matrix) + np.int32(begin) for (part, matrix), begin in pairs])
    labels = {kind: label_runs(runs, names) for kind in ("groups", "objects")}
    material = np.concatenate([part.material for part, _ in placed])
    if (material >= 0).any():
        labels["materials"] = label_faces(material, materials)
    return MeshFile("3mf", np.ascontiguousarray(points.T), corners.reshape(-1), polygon_labels=labels, unit=root.unit)
