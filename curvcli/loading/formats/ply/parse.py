"""PLY, ASCII and binary of either byte order: vertices, faces and triangle strips in file order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import MeshFile
from ....support.words import pluralize
from ...corners import checked_corners
from ...limits import check_faces
from ...pieces import Pieces
from ...strips import strip_triangles
from .header import CORNERS, HEADER_END, TOO_SMALL, Header, PlyElement, parse_header
from .rows import ElementColumns, read_binary_rows
from .text import read_text_rows


def parse_ply(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse a PLY file.

    Scalar properties of vertices and faces are kept, lists other than the corners and other elements are not.
    Triangle strips (`tristrips`, -1 begins a new strip) become triangles of alternating winding.
    Errors: InputError with the malformed line, or element and row.
    """
    header = _header(pieces)
    pieces.take(header.body)
    by_name = {element.name: element for element in header.elements}
    vertex = by_name.get("vertex")
    scalars = {p.name for p in vertex.properties if p.length is None} if vertex else set()
    if not {"x", "y", "z"} <= scalars:
        raise InputError("no vertex element with the properties x, y, z found", place="header")
    for name in ("face", "tristrips"):
        if name in by_name and by_name[name].count:
            _corner_property(by_name[name])
    check_faces(by_name["face"].count if "face" in by_name else 0, max_faces)
    notices: list[Notice] = []
    content = read_text_rows(pieces.rest(), header, notices) if header.ascii else _read_binary(pieces, header, notices)
    if header.unknown:
        message = "[line|lines] of the header that [begins|begin] with an unknown keyword, ignored"
        place = f"the first is line {header.unknown[0]}"
        notices.append(
            Notice("unknown_statements", len(header.unknown), pluralize(len(header.unknown), message), place)
        )
    return _mesh(content, by_name, notices)


def _corner_property(element: PlyElement) -> str:
    for p in element.properties:
        if p.name in CORNERS and p.length is not None:
            if p.type.kind == "f":
                raise InputError(f"`{p.name}` holds fractions, an integer type expected", place="header")
            return p.name
    raise InputError(f"element `{element.name[:40]}` without a list `vertex_indices` found", place="header")


def _header(pieces: Pieces) -> Header:
    start = pieces.ahead()
    # The bytes behind `end_header` show the kind of line end.
    complete = HEADER_END.search(start, 0, len(start) - 1)
    return parse_header(start if complete else pieces.whole())


def _read_binary(pieces: Pieces, header: Header, notices: list[Notice]) -> dict[str, ElementColumns]:
    content = {element.name: read_binary_rows(pieces, element) for element in header.elements}
    if rest := pieces.left:
        message = pluralize(rest, "[byte|bytes] after the announced elements, ignored")
        notices.append(Notice("trailing_data", rest, message, TOO_SMALL))
    return content


def _mesh(content: dict[str, ElementColumns], elements: dict[str, PlyElement], notices: list[Notice]) -> MeshFile:
    vertex = content["vertex"].scalars
    xyz = content["vertex"].xyz
    if xyz is None:
        xyz = np.stack([vertex[axis] for axis in "xyz"], dtype=np.float64)
    corners, sizes, properties = np.empty(0, np.int32), np.empty(0, np.int64), {}
    if "face" in elements and elements["face"].count:
        faces = content["face"]
        sizes, indices = faces.lists[_corner_property(elements["face"])]
        _refuse_shifted(sizes, elements, "face", notices)
        corners = checked_corners(indices, sizes, "face", xyz.shape[1])
        properties = faces.scalars
        corners, sizes, properties = _without_short(corners, sizes, properties, notices)
    if "tristrips" in elements and elements["tristrips"].count:
        lengths, indices = content["tristrips"].lists[_corner_property(elements["tristrips"])]
        _refuse_shifted(lengths, elements, "tristrips", notices)
        checked_corners(indices, lengths, "tristrips", xyz.shape[1], lowest=-1)
        strips, _ = strip_triangles(indices, lengths)
        corners, properties = np.concatenate((corners, strips.reshape(-1))), {}
        sizes = np.concatenate((sizes, np.full(len(strips), 3)))
    if not len(corners):
        raise InputError("no faces", hint="a surface needs a `face` or `tristrips` element with at least one face")
    return MeshFile(
        "ply",
        xyz,
        corners,
        None if (_once(sizes) == 3).all() else sizes.astype(np.int32),
        vertex_properties={name: values for name, values in vertex.items() if name not in ("x", "y", "z")},
        polygon_properties=properties,
        notices=tuple(notices),
    )


def _refuse_shifted(
    sizes: NDArray[np.int64], elements: dict[str, PlyElement], name: str, notices: list[Notice]
) -> None:
    """Refuse lists at a wrong offset, caused by a wrong count of an element before them.

    A count that is too large ends inside a row of lists, whose last byte is then the length of an empty list; one that
    is too small leaves a row of numbers before the lists, and a row of them after the end.
    """
    empty = np.flatnonzero(_once(sizes) == 0)
    least = 3 if name == "face" else 1
    odd = bool(len(sizes)) and (min(sizes[0], sizes[-1]) < least or _has_extra_values(notices, name))
    remains = any(notice.code == "trailing_data" for notice in notices)
    if not len(empty) and not (odd and remains):
        return
    hint = (
        f"`element vertex {elements['vertex'].count}` in the header is too small or too large, or the file is damaged"
    )
    if len(empty):
        problem = "list length 0 found, 3 or more expected"
        raise InputError(problem, place=f"{name} {int(empty[0])}", hint=hint)
    row = 0 if sizes[0] < least or sizes[-1] >= least else len(sizes) - 1
    raise InputError(
        f"list length {int(sizes[row])} found, and data after the last row", place=f"{name} {row}", hint=hint
    )


def _has_extra_values(notices: list[Notice], name: str) -> bool:
    """Test whether the first row of an element has more values than announced."""
    return any(n.code == "extra_values" and n.examples[:1] == (0,) and f"`{name}`" in n.message for n in notices)


def _without_short(
    corners: NDArray[np.int32], sizes: NDArray[np.int64], properties: dict[str, NDArray[Any]], notices: list[Notice]
) -> tuple[NDArray[np.int32], NDArray[np.int64], dict[str, NDArray[Any]]]:
    if (_once(sizes) >= 3).all():
        return corners, sizes, properties
    keep = sizes >= 3
    short = np.flatnonzero(~keep)
    notices.append(
        Notice.at(
            "short_faces",
            short,
            "[face|faces] with fewer than 3 corners, dropped",
            "[it has|they have] no area; `curvcli check` refuses such files without --allow no-degenerate",
        )
    )
    return corners[np.repeat(keep, sizes)], sizes[keep], {name: v[keep] for name, v in properties.items()}


def _once(sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """The common size as a view of one number if all sizes are equal."""
    return sizes[:1] if sizes.strides == (0,) else sizes
