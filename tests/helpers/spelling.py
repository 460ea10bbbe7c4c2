"""Files written on purpose in many spellings, so that reading can be compared with what was meant."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st

from curvcli.mesh.file import MeshFile


@dataclass(frozen=True)
class Meant:
    """Vertices and polygons as they were meant."""

    points: list[tuple[float, float, float]]
    polygons: list[tuple[int, ...]]


def same(mesh: MeshFile, meant: Meant) -> None:
    """The mesh holds exactly these positions, bit for bit but for the sign of zero, and these polygons."""
    assert mesh.xyz.dtype == np.float64
    assert mesh.corners.dtype == np.int32
    assert mesh.xyz.flags.c_contiguous
    assert mesh.xyz.shape == (3, len(meant.points))
    np.testing.assert_array_equal(mesh.xyz.T, np.array(meant.points, float).reshape(-1, 3))
    assert polygons(mesh) == meant.polygons


def polygons(mesh: MeshFile) -> list[tuple[int, ...]]:
    """The polygons of a mesh as tuples."""
    sizes = np.full(mesh.polygons, 3) if mesh.sizes is None else mesh.sizes
    return [tuple(part.tolist()) for part in np.split(mesh.corners, np.cumsum(sizes)[:-1])]


def meant(*, triangles: bool = False, single: bool = False) -> st.SearchStrategy[Meant]:
    """Any few points with any few polygons on them; single: positions that are float32."""
    number = st.floats(allow_nan=False, allow_infinity=False, width=32 if single else 64)
    points = st.lists(st.tuples(number, number, number), min_size=3, max_size=9)

    def on(p: list[tuple[float, float, float]]) -> st.SearchStrategy[Meant]:
        index = st.integers(0, len(p) - 1)
        polygon = st.lists(index, min_size=3, max_size=3 if triangles else 6).map(tuple)
        return st.builds(Meant, st.just(p), st.lists(polygon, min_size=1, max_size=9))

    return points.flatmap(on)


BLANKS = st.sampled_from([" ", "  ", "\t", " \t "])
ENDS = st.sampled_from(["\n", "\r\n", "\r"])


@st.composite
def number_text(draw: st.DrawFn, value: float) -> str:
    """A spelling that means exactly this double."""
    plain = repr(value)
    spellings = [plain, f"{value:.17g}", f"{value:.20e}", f"{value:.17E}"]
    if value >= 0 and not plain.startswith("-"):
        spellings.append("+" + plain)
    if plain.endswith(".0"):
        spellings.append(plain[:-1])
    if plain.startswith("0."):
        spellings.append(plain[1:])
    return draw(st.sampled_from(spellings))


@st.composite
def obj_text(draw: st.DrawFn, mesh: Meant) -> bytes:
    """An OBJ file that means this mesh, with seams, comments, groups and odd white space."""
    blank = draw(BLANKS)
    end = draw(ENDS)
    lines = []
    for p in mesh.points:
        lines.append(blank.join(["v", *[draw(number_text(x)) for x in p]]))
        if draw(st.booleans()):
            lines.append(
                draw(st.sampled_from(["vt 0 1", "vn 0 0 1", "# v 7 7 7", "", "g a b", "usemtl f 1 2 3", "s off"]))
            )
    many = len(mesh.points)
    form = draw(st.sampled_from(["{}", "{}/1", "{}/1/1", "{}//1", "{}//"]))
    for polygon in mesh.polygons:
        relative = draw(st.booleans())
        corners = [form.format(i - many if relative else i + 1) for i in polygon]
        if draw(st.integers(0, 4)) == 0:
            corners[1] = "\\" + end + corners[1]
        lines.append(blank.join(["f", *corners]))
        if draw(st.integers(0, 4)) == 0:
            lines[-1] += " # f 1 2 3"
    indent = draw(st.sampled_from(["", " ", "\t"]))
    trail = draw(st.sampled_from(["", " ", "\t "]))
    bom = draw(st.sampled_from(["", "\ufeff"]))
    last = draw(st.sampled_from(["", end]))
    return (bom + end.join(indent + line + ("" if line.endswith("\\") else trail) for line in lines) + last).encode()


PLY_NAMES = {
    "i1": ("char", "int8"),
    "u1": ("uchar", "uint8"),
    "i2": ("short", "int16"),
    "u2": ("ushort", "uint16"),
    "i4": ("int", "int32"),
    "u4": ("uint", "uint32"),
    "f4": ("float", "float32"),
    "f8": ("double", "float64"),
}


@st.composite
def ply_file(draw: st.DrawFn, mesh: Meant, position: str = "f8") -> bytes:
    """A PLY file that means this mesh, of any format, with further properties and elements on the way."""
    order = draw(st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]))
    end = draw(st.sampled_from(["\n", "\r\n"]))
    length_type = draw(st.sampled_from(["u1", "i1", "u2", "i4"]))
    index_type = draw(st.sampled_from(["i1", "u1", "i2", "u2", "i4", "u4"]))
    extra, extra_list, faces_first = draw(st.booleans()), draw(st.booleans()), draw(st.booleans())
    index_name = draw(st.sampled_from(["vertex_indices", "vertex_index"]))

    def name(kind: str) -> str:
        return draw(st.sampled_from(PLY_NAMES[kind]))

    vertex_head = [f"element vertex {len(mesh.points)}"]
    vertex_head += [f"property {name(position)} {axis}" for axis in "xyz"]
    vertex_rows: list[list[tuple[str, float]]] = [[(position, x) for x in p] for p in mesh.points]
    if extra:
        vertex_head.insert(2, f"property {name('u2')} mark")
        for k, row in enumerate(vertex_rows):
            row.insert(1, ("u2", 1000 + k))
    face_head = [f"element face {len(mesh.polygons)}"]
    face_rows: list[list[tuple[str, float]]] = [[] for _ in mesh.polygons]
    if extra_list:
        face_head.append(f"property list {name('u1')} {name('f4')} texcoord")
        for k, row in enumerate(face_rows):
            row += [("u1", k % 3), *[("f4", 0.5)] * (k % 3)]
    face_head.append(f"property list {name(length_type)} {name(index_type)} {index_name}")
    for polygon, row in zip(mesh.polygons, face_rows, strict=True):
        row += [(length_type, len(polygon)), *[(index_type, i) for i in polygon]]
    if extra:
        face_head.append(f"property {name('i2')} part")
        for k, row in enumerate(face_rows):
            row.append(("i2", -k))
    blocks = [(vertex_head, vertex_rows), (face_head, face_rows)]
    if faces_first:
        blocks.reverse()
    if draw(st.booleans()):
        blocks.insert(1, (["element camera 2", f"property {name('f8')} zoom"], [[("f8", 1.5)], [("f8", -2.0)]]))
    head = ["ply", f"format {order} 1.0", "comment element vertex 7", "obj_info made for a test"]
    head += [line for lines, _ in blocks for line in lines] + ["end_header"]
    data = (end.join(head) + end).encode()
    if order == "ascii":
        blank, trail = draw(BLANKS), draw(st.sampled_from(["", " "]))
        rows = [blank.join(repr(v) if t[0] == "f" else str(int(v)) for t, v in row) for _, rs in blocks for row in rs]
        return data + "".join(row + trail + end for row in rows).encode()
    codes = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f4": "f", "f8": "d"}
    sign = "<" if "little" in order else ">"
    return data + b"".join(struct.pack(sign + codes[t], v) for _, rs in blocks for row in rs for t, v in row)


def binary_stl(corners: np.ndarray, header: bytes = b"", attribute: int = 0) -> bytes:
    """A binary STL file with these corners (n, 3, 3)."""
    facets = b"".join(
        np.concatenate(([0, 0, 1], t.reshape(-1))).astype("<f4").tobytes() + struct.pack("<H", attribute)
        for t in corners
    )
    return header.ljust(80, b"\0")[:80] + struct.pack("<I", len(corners)) + facets


def ascii_stl(
    corners: np.ndarray, *, end: str = "\n", upper: bool = False, indent: str = "  ", last: bool = True
) -> bytes:
    """An ASCII STL file with these corners (n, 3, 3)."""
    lines = ["solid made for a test"]
    for t in corners:
        lines += [indent + "facet normal 0 0 1", 2 * indent + "outer loop"]
        lines += [3 * indent + "vertex " + " ".join(repr(float(x)) for x in p) for p in t]
        lines += [2 * indent + "endloop", indent + "endfacet"]
    if last:
        lines.append("endsolid made for a test")
    text = end.join(lines) + end
    return (text.upper() if upper else text).encode()
