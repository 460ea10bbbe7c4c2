"""The objects, materials and items of a 3MF model."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ...copies import Matrix
from ...corners import checked_corners
from .rows import read_rows

_OPENING = re.compile(rb"<((?:[\w.-]+:)?(?:vertices|triangles))(?:\s[^<>]*)?(?<!/)>")
_OPTIONAL = ("pid", "p1")
_NO_UNIT = "millimeter"


@dataclass(frozen=True)
class ObjectMesh:
    """The mesh of an object. material: (F,) number of each triangle's material, -1 for none."""

    points: NDArray[np.float64]
    faces: NDArray[np.int32]
    material: NDArray[np.int32]


@dataclass
class Model:
    """One model of a package. objects: by id. items: (object, path of another model or None, transform)."""

    unit: str = _NO_UNIT
    names: dict[str, str] = field(default_factory=dict)
    meshes: dict[str, ObjectMesh] = field(default_factory=dict)
    components: dict[str, list[tuple[str, str | None, Matrix]]] = field(default_factory=dict)
    items: list[tuple[str, str | None, Matrix, str | None]] = field(default_factory=list)


def parse_model(data: bytes, place: str, materials: dict[str, int]) -> Model:
    """Parse the XML of a model. materials: numbers by name, to which those of the model are added.

    Errors: InputError for damaged XML, missing attributes, or corners out of range.
    """
    skeleton, blocks = _without_rows(data)
    try:
        root = ElementTree.fromstring(skeleton)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise InputError(f"damaged XML found ({error})", place=place[:80]) from None
    if _local(root) != "model":
        raise InputError(f"XML of `{_local(root)[:40]}` found, `model` expected", place=place[:80])
    model = Model(root.get("unit", _NO_UNIT)[:40])
    palette = _palette(root)
    for each in _below(root, "resources", "object"):
        number = _required(each, "id")
        model.names[number] = each.get("name") or f"object {number}"
        for mesh in _below(each, "mesh"):
            model.meshes[number] = _part(each, mesh, blocks, palette, materials)
        model.components[number] = [_placed(component) for component in _below(each, "components", "component")]
    for item in _below(root, "build", "item"):
        model.items.append((*_placed(item), item.get("partnumber")))
    return model


def _without_rows(data: bytes) -> tuple[bytes, list[bytes]]:
    """The document with empty lists of vertices and triangles, numbered by an attribute `block`, and their content."""
    remains: list[bytes] = []
    blocks: list[bytes] = []
    at = 0
    while opening := _OPENING.search(data, at):
        end = data.find(b"</" + opening[1], opening.end())
        if end < 0:
            break
        remains.append(data[at : opening.start()] + b'<%s block="%d">' % (opening[1], len(blocks)))
        blocks.append(data[opening.end() : end])
        at = end
    return b"".join((*remains, data[at:])), blocks


def _local(element: Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _below(element: Element, name: str, *inner: str) -> Iterator[Element]:
    """The children of a name, or their children of the next name."""
    for each in element:
        if _local(each) == name:
            yield from _below(each, *inner) if inner else (each,)


def _required(element: Element, name: str) -> str:
    value = element.get(name)
    if value is None:
        raise InputError(f"`{_local(element)}` without `{name}` found")
    return value


def _placed(element: Element) -> tuple[str, str | None, Matrix]:
    """The object of a component or an item, the path of its model if it is another, and the transform."""
    path = next((value for key, value in element.attrib.items() if key.endswith("}path")), None)
    matrix, text = np.eye(4), element.get("transform")
    if text is not None:
        try:
            matrix[:3, :4] = np.array([float(word) for word in text.split()]).reshape(4, 3).T
        except ValueError:
            problem = f"transform {text[:60]!r} found, 12 numbers expected"
            raise InputError(problem, place=_local(element)) from None
    return _required(element, "objectid"), path, matrix


def _palette(root: Element) -> dict[tuple[str, str], str]:
    """The name of every material by its group and its place there."""
    palette: dict[tuple[str, str], str] = {}
    for group in root.iter():
        if _local(group) in ("basematerials", "colorgroup"):
            rows = [each for each in group if _local(each) in ("base", "color")]
            for k, each in enumerate(rows):
                name = each.get("name") or each.get("color") or each.get("displaycolor")
                palette[group.get("id", ""), str(k)] = name or f"material {k}"
    return palette


def _part(
    owner: Element, mesh: Element, blocks: list[bytes], palette: dict[tuple[str, str], str], materials: dict[str, int]
) -> ObjectMesh:
    text = {_local(each): blocks[int(each.get("block", "0"))] for each in mesh if each.get("block") is not None}
    xyz, _ = read_rows(text.get("vertices", b""), "vertex", "xyz", (), np.float64)
    columns, chosen = read_rows(text.get("triangles", b""), "triangle", ("v1", "v2", "v3"), _OPTIONAL, np.int32)
    corners = checked_corners(np.stack(columns, axis=1).reshape(-1), 3, "triangle", len(xyz[0]))
    count = len(corners) // 3

    def number(group: str | None, place: str | None) -> int:
        if group is None:
            return -1
        key = (group, place or "0")
        return materials.setdefault(palette.get(key, f"{key[0]}/{key[1]}"), len(materials))

    own = number(owner.get("pid"), owner.get("pindex")), owner.get("pid"), owner.get("pindex")
    codes = np.full(count, own[0], np.int32)
    if chosen and any(value is not None for value in (*chosen["pid"], *chosen["p1"])):
        pairs = zip(chosen["pid"], chosen["p1"], strict=True)
        codes[:] = [own[0] if pid is p1 is None else number(pid or own[1], p1 or own[2]) for pid, p1 in pairs]
    points: NDArray[Any] = np.stack(xyz, axis=1).astype(np.float64, copy=False)
    return ObjectMesh(points, corners.reshape(-1, 3), codes)
