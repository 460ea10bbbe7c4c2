"""The part of the JSON of glTF that describes triangles, and the checks of all references in it."""

from __future__ import annotations

import re
from typing import Annotated, Any, NoReturn

import msgspec
from msgspec import Meta, Struct

from ....errors import InputError

Reference = Annotated[int, Meta(ge=0)]
Size = Annotated[int, Meta(ge=0, le=2**53)]
Triple = Annotated[list[float], Meta(min_length=3, max_length=3)]

TRIANGLES, STRIP, FAN = 4, 5, 6
_ITEM_SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# Extensions without which a reader misses geometry.
_COMPRESSED = re.compile(r"draco|meshopt|gpu_instancing", re.IGNORECASE)
_DATA = re.compile(r"data:[^,]*;base64,")


class Asset(Struct, rename="camel", frozen=True):
    """Version of the format."""

    version: str = "2.0"


class Buffer(Struct, rename="camel"):
    """Bytes: of the file itself, or of a data URI."""

    byte_length: Size
    uri: str | None = None


class View(Struct, rename="camel", omit_defaults=True):
    """A range of a buffer."""

    buffer: Reference
    byte_length: Size
    byte_offset: Size = 0
    byte_stride: Size | None = None


class Accessor(Struct, rename="camel", omit_defaults=True):
    """An array in a view."""

    component_type: int
    count: Size
    type: str
    buffer_view: Reference | None = None
    byte_offset: Size = 0
    normalized: bool = False
    sparse: Any = None

    @property
    def row_bytes(self) -> int:
        """Bytes of one element."""
        return _ITEM_SIZES[self.component_type] * _COMPONENTS[self.type]


class Primitive(Struct, rename="camel", omit_defaults=True):
    """A part of a mesh with one material."""

    attributes: dict[str, Reference]
    indices: Reference | None = None
    material: Reference | None = None
    mode: int = TRIANGLES
    targets: list[Any] = []
    extensions: dict[str, Any] = {}

    @property
    def position(self) -> int:
        """The accessor of the positions."""
        return self.attributes["POSITION"]


class Mesh(Struct, rename="camel"):
    """Primitives under one name."""

    primitives: list[Primitive]
    name: str | None = None


class Node(Struct, rename="camel"):
    """A place in the scene."""

    mesh: Reference | None = None
    children: list[Reference] = []
    name: str | None = None
    matrix: Annotated[list[float], Meta(min_length=16, max_length=16)] | None = None
    translation: Triple | None = None
    rotation: Annotated[list[float], Meta(min_length=4, max_length=4)] | None = None
    scale: Triple | None = None
    skin: Reference | None = None
    extensions: dict[str, Any] = {}


class Scene(Struct, rename="camel"):
    """Root nodes."""

    nodes: list[Reference] = []


class Material(Struct, rename="camel"):
    """A name; what a material looks like is not read."""

    name: str | None = None


class Tree(Struct, rename="camel"):
    """A file of glTF without what describes no triangles."""

    asset: Asset = Asset()
    buffers: list[Buffer] = []
    buffer_views: list[View] = []
    accessors: list[Accessor] = []
    meshes: list[Mesh] = []
    nodes: list[Node] = []
    scenes: list[Scene] = []
    scene: Reference | None = None
    materials: list[Material] = []
    extensions_required: list[str] = []


def parse_tree(data: bytes) -> Tree:
    """Parse and check the JSON of a file.

    Errors: InputError for malformed JSON, a wrong type or reference, or an encoding that trimesh cannot decode.
    """
    try:
        tree = msgspec.json.decode(data.removeprefix(b"\xef\xbb\xbf"), type=Tree)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"no glTF 2 found in its JSON: {error}") from None
    if not tree.asset.version.startswith("2."):
        raise InputError(f"glTF {tree.asset.version[:20]} found, 2.0 expected")
    for extension in tree.extensions_required:
        if _COMPRESSED.search(extension):
            _refuse_extension(extension)
    return tree


def check_primitive(tree: Tree, primitive: Primitive, place: str) -> None:
    """Check the accessors of a primitive. Errors: InputError."""
    for extension in primitive.extensions:
        position = primitive.attributes.get("POSITION")
        fallback = position is not None and position < len(tree.accessors) and tree.accessors[position].buffer_view
        if _COMPRESSED.search(extension) and fallback is None:
            _refuse_extension(extension)
    if "POSITION" not in primitive.attributes:
        raise InputError("no attribute `POSITION` found", place=place)
    if primitive.mode == FAN:
        raise InputError("a triangle fan found, triangles or strips expected", place=place)
    if primitive.material is not None and primitive.material >= len(tree.materials):
        raise InputError(f"material {primitive.material} found, {len(tree.materials)} exist", place=place)
    positions = check_accessor(tree, primitive.position, place)
    if positions.type != "VEC3":
        raise InputError(f"positions of type {positions.type} found, VEC3 expected", place=place)
    if primitive.indices is not None:
        indices = check_accessor(tree, primitive.indices, place)
        if indices.type != "SCALAR" or indices.component_type == 5126:
            raise InputError("indices that are no whole numbers found", place=place)
    rows = positions.count if primitive.indices is None else tree.accessors[primitive.indices].count
    if primitive.mode == TRIANGLES and rows % 3:
        raise InputError(f"{rows} corners of triangles found, a multiple of 3 expected", place=place)


def check_accessor(tree: Tree, index: int, place: str) -> Accessor:
    """Check that an accessor lies within its buffer. Errors: InputError."""
    if index >= len(tree.accessors):
        raise InputError(f"accessor {index} found, 0 to {len(tree.accessors) - 1} expected", place=place)
    accessor, place = tree.accessors[index], f"accessor {index}"
    if accessor.component_type not in _ITEM_SIZES or accessor.type not in _COMPONENTS:
        raise InputError(f"type {accessor.component_type} {accessor.type[:20]!r} found, unknown to glTF", place=place)
    if accessor.sparse is not None or accessor.buffer_view is None:
        content = "sparse data" if accessor.sparse is not None else "no data"
        raise InputError(f"{content} found, an array in a buffer expected", place=place, hint="export it without")
    if accessor.buffer_view >= len(tree.buffer_views):
        raise InputError(f"bufferView {accessor.buffer_view} found, {len(tree.buffer_views)} exist", place=place)
    view = tree.buffer_views[accessor.buffer_view]
    stride = view.byte_stride or accessor.row_bytes
    if accessor.count and accessor.byte_offset + (accessor.count - 1) * stride + accessor.row_bytes > view.byte_length:
        problem = f"{accessor.count} elements announced, more than the {view.byte_length} bytes of its view can hold"
        raise InputError(problem, place=place)
    if view.buffer >= len(tree.buffers):
        raise InputError(f"buffer {view.buffer} found, {len(tree.buffers)} exist", place=place)
    if view.byte_offset + view.byte_length > tree.buffers[view.buffer].byte_length:
        raise InputError("the end lies beyond the end of the buffer", place=f"bufferView {accessor.buffer_view}")
    return accessor


def embedded(buffer: Buffer, number: int) -> str:
    """The base64 text of a buffer. Errors: InputError for a buffer in another file, which is not opened."""
    uri = buffer.uri or ""
    mark = _DATA.match(uri)
    if mark is None:
        content = f"`{uri[:60]}`" if uri else "no data"
        hint = "export it as .glb, which holds its buffers"
        raise InputError(f"{content} found, data inside the file expected", place=f"buffer {number}", hint=hint)
    return uri[mark.end() :]


def _refuse_extension(extension: str) -> NoReturn:
    hint = "export it without compression and without instancing, for example from Blender"
    raise InputError(f"{extension[:60]} found, plain arrays of triangles expected", hint=hint)
