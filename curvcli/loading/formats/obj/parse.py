"""Wavefront OBJ: the `v`, `f` and `l` records and the labels of the faces, in file order.

Texture coordinates, normals, materials and groups never split or reorder vertices. No other file is opened.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import NO_POLYLINES, Labels, MeshFile, Polylines
from ....support.words import number_of, pluralize
from ...limits import check_faces
from ...text import NEWLINE, Records, Untidy, decode, plain_lines
from .lines import ObjLines, split_lines, tidy_lines
from .normals import corner_normals
from .texture import corner_texture

_LABELS = {b"g": "groups", b"o": "objects", b"usemtl": "materials"}
_SILENT = frozenset(b"vn vt s mtllib mg usemap maplib lod bevel c_interp d_interp shadow_obj trace_obj".split())
_IGNORED = frozenset(
    b"p vp cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con"
    b" bzp bsp cdc cdp res ctech stech call csh".split()
)


def parse_obj(data: bytes, *, max_faces: int | None = None, normals: bool = False, texture: bool = False) -> MeshFile:
    """Parse an OBJ file.

    Negative indices count back from their own record. Vertex colours (`v x y z r g b`) become the properties
    `red`, `green`, `blue`; a rational weight `w` is ignored and counted. normals, texture: also read the `vn`, the `vt`
    records.
    Errors: InputError with the line of a malformed record or of an index out of range.
    """
    text = plain_lines(data)
    try:
        return _read(split_lines(text), max_faces, normals, texture)
    except Untidy:
        return _read(tidy_lines(text), max_faces, normals, texture)


def _read(lines: ObjLines, max_faces: int | None, normals: bool, texture: bool) -> MeshFile:
    is_v, is_f, is_l = lines.of("v"), lines.of("f"), lines.of("l")
    check_faces(int(np.count_nonzero(is_f)), max_faces)
    notices: list[Notice] = []
    labels = _statements(lines, is_v | is_f | is_l, notices)
    xyz, colours = _vertices(lines, is_v, notices)
    corners, sizes = _corners(lines, is_f, is_v)
    given = corner_normals(lines, is_f, corners, xyz.shape[1]) if normals and is_f.any() else None
    uv = corner_texture(lines, is_f) if texture and is_f.any() else None
    count = int(np.count_nonzero(is_f))
    keep = sizes >= 3 if isinstance(sizes, np.ndarray) else np.full(count, sizes >= 3)
    if not keep.all():
        short = np.flatnonzero(~keep)
        place = lines.place(int(np.flatnonzero(is_f)[short[0]]))
        hint = f"the first is in {place}; `curvcli check` refuses such files without --allow no-degenerate"
        notices.append(Notice.at("short_faces", short, "[face|faces] with fewer than 3 corners, dropped", hint))
        kept = np.repeat(keep, sizes)
        corners, uv = corners[kept], None if uv is None else uv[:, kept]
        sizes = sizes[keep] if isinstance(sizes, np.ndarray) else 3
    if not len(corners) and not is_l.any():
        raise InputError("no faces", hint="a surface needs `f` records with at least 3 corners each")
    before = np.concatenate(([0], np.cumsum(is_f))) if labels else np.empty(0, np.int64)
    return MeshFile(
        "obj",
        xyz,
        corners,
        _int32_sizes(sizes, count),
        vertex_properties=colours,
        polygon_labels={kind: _label(before[at], names, keep) for kind, (at, names) in labels.items()},
        polylines=_polylines(lines, is_l, is_v) if is_l.any() else NO_POLYLINES,
        notices=tuple(notices),
        corner_normals=given,
        corner_texture=uv,
    )


def _int32_sizes(sizes: int | NDArray[np.int64], count: int) -> NDArray[np.int32] | None:
    if isinstance(sizes, int):
        return None if sizes == 3 else np.full(count, sizes, np.int32)
    return None if (sizes == 3).all() else sizes.astype(np.int32)


def _statements(
    lines: ObjLines, geometry: NDArray[np.bool_], notices: list[Notice]
) -> dict[str, tuple[NDArray[np.int64], list[str]]]:
    """Positions and values of the statements that set labels; other statements are counted, unknown ones refused."""
    kinds = np.flatnonzero(np.bincount(lines.kind, minlength=1 << 16)).tolist()
    quiet = [code for code in kinds if code & 255 in (NEWLINE, ord("#")) or code in (0x6E76, 0x7476)]  # vn, vt
    others = np.flatnonzero(~geometry & ~np.isin(lines.kind, quiet))
    at: dict[str, list[int]] = {}
    names: dict[str, list[str]] = {}
    counted: dict[str, dict[bytes, list[int]]] = {"ignored_statements": {}, "unknown_statements": {}}
    recognised = bool(geometry.any()) or any(code & 255 == ord("v") for code in quiet)
    for line in others.tolist():
        keyword, _, rest = lines.text(line).partition(b" ")
        if keyword in _LABELS:
            at.setdefault(_LABELS[keyword], []).append(line)
            names.setdefault(_LABELS[keyword], []).append(decode(b" ".join((b" " + rest).partition(b" #")[0].split())))
        elif keyword not in _SILENT:
            code = "ignored_statements" if keyword in _IGNORED else "unknown_statements"
            counted[code].setdefault(keyword, []).append(line)
            continue
        recognised = True
    if not recognised and not counted["ignored_statements"]:
        raise InputError("no OBJ record found; lines that begin with `v` and `f` expected")
    for code, positions in counted.items():
        if positions:
            names_listed = ", ".join(f"`{decode(word[:20])}`" for word in list(positions)[:5])
            what = "free-form, point or drawing" if code == "ignored_statements" else "unknown"
            first = lines.place(min(where[0] for where in positions.values()))
            total = sum(map(len, positions.values()))
            message = f"{what} {pluralize(total, '[statement|statements]')}, ignored: {names_listed}"
            notices.append(Notice(code, total, message, f"the first is in {first}"))
    return {kind: (np.array(where, np.int64), names[kind]) for kind, where in at.items()}


def _label(before: NDArray[np.int64], names: list[str], keep: NDArray[np.bool_]) -> Labels:
    """The label of each kept face. before: number of faces before each label statement."""
    number: dict[str, int] = {}
    codes = np.array([-1, *(number.setdefault(name, len(number)) for name in names)], np.int32)
    each = np.repeat(codes, np.diff(np.concatenate(([0], before, [len(keep)]))))
    return Labels(each[keep], tuple(number))


def _vertices(
    lines: ObjLines, is_v: NDArray[np.bool_], notices: list[Notice]
) -> tuple[NDArray[np.float64], dict[str, NDArray[np.generic]]]:
    count = int(np.count_nonzero(is_v))
    if not count:
        return np.empty((3, 0)), {}
    records = lines.records(is_v, np.float64, "a number")
    sizes = records.sizes
    too_few = np.flatnonzero(np.broadcast_to(np.asarray(sizes) < 3, count))
    if len(too_few):
        line = int(np.flatnonzero(is_v)[too_few[0]])
        size = int(np.broadcast_to(sizes, count)[too_few[0]])
        raise InputError(f"`v` record with {number_of(size, 'number')}, at least 3 expected", place=lines.place(line))
    xyz = np.empty((3, count))
    for k in range(3):
        xyz[k] = _column(records, k)
    colours: dict[str, NDArray[np.generic]] = {}
    if np.any(np.asarray(sizes) >= 6):
        some = np.asarray(sizes)
        skip = np.where(some >= 6, 3 + (some >= 7), some)  # a record without colours has none of these columns
        colours = {name: _column(records, skip + k) for k, name in enumerate(("red", "green", "blue"))}
    weighted = np.isin(sizes, (4, 7))
    if weighted.any():
        weights = np.where(weighted, _column(records, 3), 1.0)
        rational = np.flatnonzero(weights != 1)
        if len(rational):
            message = "[vertex|vertices] with a rational weight `w` other than 1, which is ignored"
            hint = "only free-form surfaces use weights; x, y and z are taken as they stand"
            notices.append(Notice.at("rational_weights", rational, message, hint))
    extra = np.flatnonzero(np.broadcast_to((np.asarray(sizes) == 5) | (np.asarray(sizes) > 7), count))
    if len(extra):
        line = int(np.flatnonzero(is_v)[extra[0]])
        message = "[vertex|vertices] with numbers that are neither a weight nor a colour, which are ignored"
        notices.append(Notice.at("extra_values", extra, message, f"the first is in {lines.place(line)}"))
    return xyz, colours


def _column(records: Records, k: int | NDArray[np.int64]) -> NDArray[np.float64]:
    """The k-th number of each record, NaN where it has none."""
    if records.columns is not None:
        return np.asarray(records.columns[int(k)], np.float64)
    assert records.values is not None
    sizes = np.asarray(records.sizes)
    at = np.cumsum(sizes) - sizes + k
    present = np.broadcast_to(np.asarray(k) < sizes, at.shape)
    values = np.full(len(sizes), np.nan)
    values[present] = records.values[at[present]]
    return values


def _corners(
    lines: ObjLines, wanted: NDArray[np.bool_], is_v: NDArray[np.bool_]
) -> tuple[NDArray[np.int32], int | NDArray[np.int64]]:
    """The vertex indices (from 0) of `f` or `l` records, concatenated, and the number of each."""
    if not wanted.any():
        return np.empty(0, np.int32), 3
    records = lines.records(wanted, np.int32, "a vertex index")
    corners: NDArray[np.int32] = records.flat()
    vertices = int(np.count_nonzero(is_v))
    if not len(corners):
        return corners, records.sizes
    if corners.min() < 1:
        relative = np.flatnonzero(corners < 0)
        row = _row_of(records, relative)
        defined = np.cumsum(is_v)[np.flatnonzero(wanted)[row]]
        wrong = relative[corners[relative] + defined < 0]
        if not len(wrong):
            corners[relative] += (defined + 1).astype(np.int32)
        else:
            corners[wrong] = 0
        wrong = np.flatnonzero(corners == 0)
    else:
        wrong = np.empty(0, np.int64)
    if len(wrong) or corners.max() > vertices:
        _refuse_index(lines, wanted, records, corners, vertices)
    corners -= 1
    return corners, records.sizes


def _row_of(records: Records, at: NDArray[np.int64]) -> NDArray[np.int64]:
    """The record of each of the given numbers."""
    if isinstance(records.sizes, int):
        return at // records.sizes
    return np.searchsorted(np.cumsum(records.sizes), at, side="right")


def _refuse_index(
    lines: ObjLines, wanted: NDArray[np.bool_], records: Records, corners: NDArray[np.int32], vertices: int
) -> None:
    wrong = np.flatnonzero((corners == 0) | (corners > vertices))
    row = int(_row_of(records, wrong[:1])[0])
    line = int(np.flatnonzero(wanted)[row])
    position = int(wrong[0] - np.searchsorted(_row_of(records, np.arange(len(corners))), row))
    token = lines.text(line).split()[1 + position].decode("utf-8", "backslashreplace")
    expected = f"1 to {vertices} expected, or negative: counted back from this line" if vertices else "but no vertex"
    raise InputError(f"vertex index `{token}` found, {expected}", place=lines.place(line))


def _polylines(lines: ObjLines, is_l: NDArray[np.bool_], is_v: NDArray[np.bool_]) -> Polylines:
    corners, sizes = _corners(lines, is_l, is_v)
    each = np.broadcast_to(np.asarray(sizes, np.int64), int(np.count_nonzero(is_l)))
    return Polylines(corners, np.concatenate(([0], np.cumsum(each))))
