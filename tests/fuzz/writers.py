"""Whole files of every kind that a shape can be written as."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st

from tests.fuzz.shapes import shapes
from tests.helpers.spelling import Meant, ascii_stl, binary_stl, obj_text, ply_file


@dataclass(frozen=True)
class Written:
    """A file and what it means; meant is None where the file says less or more than a shape."""

    kind: str
    data: bytes
    meant: Meant | None


@st.composite
def obj(draw: st.DrawFn) -> Written:
    """OBJ in every spelling: seams, groups, comments, continued lines, relative indices."""
    shape = draw(shapes())
    return Written("obj", draw(obj_text(shape)), shape)


@st.composite
def ply(draw: st.DrawFn) -> Written:
    """PLY, text or binary of either byte order, of every scalar type, with further properties and elements."""
    position = draw(st.sampled_from(["f8", "f8", "f4", "i2"]))
    if position == "f8":
        shape = draw(shapes())
    elif position == "f4":
        shape = draw(shapes(single=True))
        shape = Meant([tuple(float(np.float32(x)) for x in p) for p in shape.points], shape.polygons)  # type: ignore[misc]
    else:
        shape = draw(shapes(single=True))
        shape = Meant([tuple(int(x) % 2000 - 1000 for x in p) for p in shape.points], shape.polygons)  # type: ignore[misc]
    return Written("ply", draw(ply_file(shape, position)), shape)


@st.composite
def strips(draw: st.DrawFn) -> Written:
    """PLY of triangle strips, several to a row."""
    shape = draw(shapes())
    count = len(shape.points)
    index = st.one_of(st.integers(0, count - 1), st.just(-1))
    rows = draw(st.lists(st.lists(index, max_size=30), min_size=1, max_size=3))
    order = draw(st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]))
    head = f"ply\nformat {order} 1.0\nelement vertex {count}\n" + "".join(f"property double {a}\n" for a in "xyz")
    head += f"element tristrips {len(rows)}\nproperty list int int vertex_indices\nend_header\n"
    if order == "ascii":
        lines = [" ".join(map(repr, p)) for p in shape.points]
        lines += [" ".join(map(str, [len(row), *row])) for row in rows]
        return Written("ply", (head + "\n".join(lines) + "\n").encode(), None)
    sign = "<" if "little" in order else ">"
    body = b"".join(struct.pack(sign + "3d", *p) for p in shape.points)
    body += b"".join(struct.pack(f"{sign}{len(row) + 1}i", len(row), *row) for row in rows)
    return Written("ply", head.encode() + body, None)


@st.composite
def stl(draw: st.DrawFn) -> Written:
    """STL, binary (also with a header that begins with `solid`) or text (also several solids, also cut short)."""
    shape = draw(shapes(single=True, triangles=True))
    corners = np.array([[shape.points[i] for i in polygon] for polygon in shape.polygons])
    if draw(st.booleans()):
        header = draw(st.sampled_from([b"", b"solid binary", b"solid facet", b"\xff" * 80, b"COLOR=\x01\x02\x03\x04"]))
        return Written("stl", binary_stl(corners, header, draw(st.sampled_from([0, 0x8000, 65535]))), shape)
    end = draw(st.sampled_from(["\n", "\r\n", "\r"]))
    data = ascii_stl(corners, end=end, upper=draw(st.booleans()), last=draw(st.booleans()))
    return Written("stl", data * draw(st.sampled_from([1, 1, 1, 2])), shape)


def whole() -> st.SearchStrategy[Written]:
    """A whole file of any kind."""
    return st.one_of(obj(), ply(), stl(), strips())
