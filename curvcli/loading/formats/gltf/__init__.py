"""glTF as text: the JSON of a scene with its buffers inside, with triangles read by trimesh."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...registry import InputFormat, ParserOptions, register

if TYPE_CHECKING:
    from ....mesh.file import MeshFile
    from ...pieces import Pieces

_SIGN = re.compile(rb"(?:\xef\xbb\xbf)?\s*+\{")
_KEYS = (b'"asset"', b'"accessors"', b'"bufferViews"', b'"meshes"')


def has_sign(pieces: Pieces) -> bool:
    """Test for a JSON object with a key of glTF near its start."""
    start = pieces.ahead()
    return bool(_SIGN.match(start)) and any(key in start for key in _KEYS)


def _parse(pieces: Pieces, options: ParserOptions) -> MeshFile:
    from .parse import parse_gltf

    return parse_gltf(pieces, max_faces=options.max_faces)


register(
    InputFormat(
        name="gltf",
        full_name="glTF",
        parse=_parse,
        has_sign=has_sign,
        seams=True,
        library="trimesh",
        encodings="text with buffers inside, as base64",
        rows="positions of each node, in the order of the scene",
        digits="float32, then the transforms of nodes",
        keeps="`COLOR_0` as stored, scalar `_NAME` attributes",
        labels="nodes as `groups` and `objects`, `materials`",
        polygons="triangles only; strips too",
    )
)
