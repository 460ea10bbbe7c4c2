"""Binary glTF: the JSON of a scene and its buffer in one file, with triangles read by trimesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ...mesh.file import MeshFile
    from ..pieces import Pieces


def has_sign(pieces: Pieces) -> bool:
    """Test for the first four bytes of binary glTF."""
    return pieces.ahead()[:4] == b"glTF"


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .gltf.parse import parse_glb

    return parse_glb(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="glb",
        parse=_parse,
        has_sign=has_sign,
        seams=True,
        library="trimesh",
        encodings="binary",
        rows="positions of each node, in the order of the scene",
        digits="float32, then the transforms of nodes",
        keeps="`COLOR_0` as stored, scalar `_NAME` attributes",
        labels="nodes as `groups` and `objects`, `materials`",
        polygons="triangles only; strips too",
    )
)
