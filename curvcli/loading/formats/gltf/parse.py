"""glTF: triangles of all nodes of the scene, decoded by trimesh, in the order of the file."""

from __future__ import annotations

import binascii
import io
import struct
from collections.abc import Iterator
from itertools import accumulate
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import MeshFile
from ....support.words import number_of, pluralize
from ...copies import Matrix, check_copies, flip_mirrored, transformed
from ...corners import checked_corners
from ...pieces import Pieces
from .labels import scene_labels
from .scene import placed_meshes
from .tree import TRIANGLES, Primitive, Tree, check_accessor, check_primitive, embedded, parse_tree

_HEADER, _CHUNK = struct.Struct("<4sII"), struct.Struct("<II")
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_CHANNELS = ("red", "green", "blue", "alpha")
_LARGEST = {"i1": 127, "u1": 255, "i2": 32767, "u2": 65535}


def parse_glb(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse binary glTF. Errors: InputError for chunks that do not fit; those of `_parse`."""
    data = pieces.rest()
    if len(data) < _HEADER.size + _CHUNK.size:
        raise InputError(f"{number_of(len(data), 'byte')} found, the header of glTF has {_HEADER.size + _CHUNK.size}")
    _, version, length = _HEADER.unpack_from(data)
    if version != 2:
        raise InputError(f"version {version} of binary glTF found, 2 expected")
    if length > len(data):
        raise InputError(f"{length} bytes announced, {len(data)} found: the file is truncated")
    chunks = list(_chunks(data[:length]))
    if not chunks or chunks[0][0] != _JSON:
        raise InputError("no JSON found in the first chunk")
    tree = parse_tree(chunks[0][1])
    binary = next((content for kind, content in chunks[1:] if kind == _BIN), None)
    notices = []
    if rest := len(data) - length:
        message = pluralize(rest, "[byte|bytes] after the announced length, ignored")
        notices.append(
            Notice("trailing_data", rest, message, "the mesh is complete; export it again if it should hold more")
        )
    return _parse(tree, binary, "glb", len(data), max_faces, notices)


def parse_gltf(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse glTF as text; buffers stand in data URIs. Errors: those of `_parse`."""
    data = pieces.rest()
    return _parse(parse_tree(data), None, "gltf", len(data), max_faces, [])


def _chunks(data: bytes) -> Iterator[tuple[int, bytes]]:
    at = _HEADER.size
    while at + _CHUNK.size <= len(data):
        size, kind = _CHUNK.unpack_from(data, at)
        at += _CHUNK.size
        if at + size > len(data):
            problem = f"a chunk of {number_of(size, 'byte')} announced, {len(data) - at} found"
            raise InputError(problem, place=f"byte {at - _CHUNK.size}")
        yield kind, data[at : at + size]
        at += size


def _buffers(tree: Tree, binary: bytes | None) -> list[bytes]:
    """The bytes of all buffers. Errors: InputError for one in another file, or shorter than announced."""
    buffers = []
    for number, buffer in enumerate(tree.buffers):
        if number == 0 and buffer.uri is None and binary is not None:
            content = binary
        else:
            try:
                content = binascii.a2b_base64(embedded(buffer, number), strict_mode=True)
            except (binascii.Error, ValueError) as error:
                raise InputError(f"damaged base64 data found ({error})", place=f"buffer {number}") from None
        if len(content) < buffer.byte_length:
            problem = f"{buffer.byte_length} bytes announced, {len(content)} found"
            raise InputError(problem, place=f"buffer {number}")
        buffers.append(content)
    return buffers


def _parse(
    tree: Tree, binary: bytes | None, name: str, size: int, max_faces: int | None, notices: list[Notice]
) -> MeshFile:
    """Place the triangles of all meshes: rows are the positions of each node, once per array of positions.

    Errors: InputError for wrong references, data outside the file, or so many copies of a mesh that they are out of
    proportion to the file.
    """
    placed = placed_meshes(tree)
    used = sorted({mesh for _, mesh, _ in placed})
    primitives_of: dict[int, list[Primitive]] = {}
    for mesh in used:
        primitives = tree.meshes[mesh].primitives
        primitives_of[mesh] = [primitive for primitive in primitives if primitive.mode >= TRIANGLES]
        for k, primitive in enumerate(primitives):
            if primitive.mode >= TRIANGLES:
                check_primitive(tree, primitive, f"mesh {mesh}, primitive {k}")
    _check_size(tree, primitives_of, placed, size, max_faces)
    if not any(primitives_of.values()):
        raise InputError("no faces", hint="a surface needs a node with a mesh of triangles")
    buffers = _buffers(tree, binary)
    arrays = _decoded(tree, primitives_of, buffers)
    return _assembled(tree, primitives_of, placed, arrays, name, notices)


def _check_size(
    tree: Tree,
    primitives_of: dict[int, list[Primitive]],
    placed: list[tuple[int, int, Matrix]],
    size: int,
    most: int | None,
) -> None:
    copies = sum(len(primitives_of[mesh]) for _, mesh, _ in placed)
    check_copies(copies, 0, 0, size, most)
    faces = vertices = 0
    for _, mesh, _ in placed:
        for primitive in primitives_of[mesh]:
            position = tree.accessors[primitive.position].count
            corners = position if primitive.indices is None else tree.accessors[primitive.indices].count
            faces += corners // 3 if primitive.mode == TRIANGLES else max(0, corners - 2)
        vertices += sum(tree.accessors[at].count for at in {primitive.position for primitive in primitives_of[mesh]})
    check_copies(copies, vertices, faces, size, most)


def _decoded(tree: Tree, primitives_of: dict[int, list[Primitive]], buffers: list[bytes]) -> list[dict[str, Any]]:
    """The arrays of all primitives in their order, by trimesh: a file with nothing but these is given to its loader."""
    from trimesh.exchange.gltf import load_glb

    kept: dict[int, int] = {}
    meshes = []
    for primitives in primitives_of.values():
        for primitive in primitives:
            names = [*_extra(tree, primitive)]
            attributes = {name: kept.setdefault(primitive.attributes[name], len(kept)) for name in ("POSITION", *names)}
            reduced = {"attributes": attributes, "mode": primitive.mode}
            if primitive.indices is not None:
                reduced["indices"] = kept.setdefault(primitive.indices, len(kept))
            meshes.append({"primitives": [reduced]})
    offsets = [0, *accumulate(len(buffer) for buffer in buffers)]
    views, accessors = [], []
    for number in kept:
        accessor = tree.accessors[number]
        view = tree.buffer_views[accessor.buffer_view or 0]
        moved = {"buffer": 0, "byteOffset": offsets[view.buffer] + view.byte_offset, "byteLength": view.byte_length}
        views.append(moved | ({"byteStride": view.byte_stride} if view.byte_stride else {}))
        kind = {"componentType": accessor.component_type, "count": accessor.count, "type": accessor.type}
        accessors.append({"bufferView": len(views) - 1, "byteOffset": accessor.byte_offset, **kind})
    header = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": offsets[-1]}],
        "bufferViews": views,
        "accessors": accessors,
        "meshes": meshes,
        "nodes": [],
        "scenes": [{"nodes": []}],
    }
    text = msgspec.json.encode(header)
    length = _HEADER.size + 2 * _CHUNK.size + len(text) + offsets[-1]
    head = _HEADER.pack(b"glTF", 2, length % 2**32), _CHUNK.pack(len(text), _JSON), text
    stream = io.BytesIO(b"".join((*head, _CHUNK.pack(offsets[-1], _BIN), *buffers)))
    try:
        geometry: dict[str, dict[str, Any]] = load_glb(stream, skip_materials=True)["geometry"]
    except (MemoryError, InputError):
        raise
    except Exception as error:
        raise InputError(f"cannot be read as glTF: {type(error).__name__}: {error}") from None
    return list(geometry.values())


def _extra(tree: Tree, primitive: Primitive) -> Iterator[str]:
    """Attributes of a primitive that are kept as properties."""
    rows = tree.accessors[primitive.position].count
    for name, number in primitive.attributes.items():
        if name == "COLOR_0" or name.startswith("_"):
            accessor = check_accessor(tree, number, f"attribute {name[:40]}")
            kinds = ("VEC3", "VEC4") if name == "COLOR_0" else ("SCALAR",)
            if accessor.type in kinds and accessor.count == rows:
                yield name


def _assembled(
    tree: Tree,
    primitives_of: dict[int, list[Primitive]],
    placed: list[tuple[int, int, Matrix]],
    arrays: list[dict[str, Any]],
    name: str,
    notices: list[Notice],
) -> MeshFile:
    first = dict(zip(primitives_of, np.cumsum([0, *map(len, primitives_of.values())]).tolist(), strict=False))
    points: list[NDArray[Any]] = []
    corners: list[NDArray[np.int32]] = []
    columns: list[tuple[int, dict[str, NDArray[Any]]]] = []
    nodes: list[tuple[int, int]] = []
    materials: list[tuple[int, int]] = []
    rows = 0
    for number, (_, mesh, matrix) in enumerate(placed):
        begins: dict[int, int] = {}
        for primitive, content in zip(primitives_of[mesh], arrays[first[mesh] :], strict=False):
            if primitive.position not in begins:
                begins[primitive.position] = rows
                points.append(transformed(_positions(tree, primitive, content), matrix))
                columns.append((rows, _properties(content)))
                rows += len(points[-1])
            count = len(content["vertices"])
            faces = np.asarray(content["faces"])
            place = f"mesh {mesh}: triangle"
            own = checked_corners(faces.reshape(-1), 3, place, count).reshape(-1, 3) + np.int32(
                begins[primitive.position]
            )
            corners.append(flip_mirrored(own, matrix))
            nodes.append((number, len(own)))
            materials.append((-1 if primitive.material is None else primitive.material, len(own)))
    if not sum(map(len, corners)):
        raise InputError("no faces", hint="a surface needs a node with a mesh of triangles")
    notices = [*notices, *_ignored(tree, primitives_of)]
    return MeshFile(
        name,
        np.ascontiguousarray(np.concatenate(points).T),
        np.concatenate(corners).reshape(-1),
        vertex_properties=_merged(columns, rows),
        polygon_labels=scene_labels(tree, placed, nodes, materials),
        notices=tuple(notices),
    )


def _positions(tree: Tree, primitive: Primitive, content: dict[str, Any]) -> NDArray[np.float64]:
    points = np.asarray(content["vertices"])
    largest = _LARGEST.get(points.dtype.str[1:])
    if tree.accessors[primitive.position].normalized and largest:
        return np.maximum(points / largest, -1.0)
    return points.astype(np.float64)


def _properties(content: dict[str, Any]) -> dict[str, NDArray[Any]]:
    columns: dict[str, NDArray[Any]] = {}
    if (colours := content.get("vertex_colors")) is not None:
        columns |= dict(zip(_CHANNELS, np.asarray(colours).T, strict=False))
    for name, values in content.get("vertex_attributes", {}).items():
        columns[name] = np.asarray(values).reshape(-1)
    return columns


def _merged(columns: list[tuple[int, dict[str, NDArray[Any]]]], rows: int) -> dict[str, NDArray[np.generic]]:
    """Columns of all vertices: NaN where a mesh has none, in the type of the file where all have the same."""
    merged: dict[str, NDArray[np.generic]] = {}
    for name in dict.fromkeys(name for _, own in columns for name in own):
        kinds = {own[name].dtype if name in own else np.dtype(np.float64) for _, own in columns}
        column = np.full(rows, np.nan, np.float64 if len(kinds) > 1 else None)
        column = np.empty(rows, kinds.pop()) if len(kinds) == 1 and all(name in own for _, own in columns) else column
        for begin, own in columns:
            if name in own:
                column[begin : begin + len(own[name])] = own[name]
        merged[name] = column
    return merged


def _ignored(tree: Tree, primitives_of: dict[int, list[Primitive]]) -> list[Notice]:
    others = sum(primitive.mode < TRIANGLES for mesh in primitives_of for primitive in tree.meshes[mesh].primitives)
    moving = sum(bool(primitive.targets) for primitives in primitives_of.values() for primitive in primitives)
    skins = sum(node.skin is not None for node in tree.nodes)
    kinds = [
        (others, "[primitive|primitives] of points or lines"),
        (moving, "[primitive|primitives] with morph targets"),
        (skins, "[node|nodes] with a skin, in [its|their] bind pose"),
    ]
    phrases = [f"{count} {pluralize(count, word)}" for count, word in kinds if count]
    if not phrases:
        return []
    message = f"parts of the scene that are no triangles at rest, ignored: {', '.join(phrases)}"
    return [Notice("ignored_parts", others + moving + skins, message, "export a still mesh to have them")]
