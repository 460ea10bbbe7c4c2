"""Two shapes of triangles and polygons, and a writer for each variant of the formats that other programs read too."""

from __future__ import annotations

import struct
from typing import Any

from tests.helpers.readers import Polygons

Points = list[tuple[float, float, float]]


def prism() -> tuple[Points, Polygons]:
    """A closed body of triangles, quadrilaterals and two pentagons that fit float32; one vertex is not used."""
    ring = [(4.0, 0.0), (2.0, 3.0), (-2.0, 2.0), (-3.0, -1.0), (1.0, -3.0)]
    points = [(x, y, z) for z in (0.0, 2.5) for x, y in ring] + [(9.0, 9.0, 9.0), (0.5, 0.25, 4.0)]
    sides: Polygons = [(k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k) for k in range(5)]
    return points, [(4, 3, 2, 1, 0), *sides, *((5 + k, 5 + (k + 1) % 5, 11) for k in range(5))]


def sheet() -> tuple[Points, Polygons]:
    """An open strip of quadrilaterals, twisted but each of them plane, and a triangle beside it."""
    points = [(float(k), float(j), 0.5 * k) for k in range(6) for j in (0, 1)]
    strip: Polygons = [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(5)]
    return [*points, (20.0, 0.0, 0.0), (21.0, 0.0, 1.0), (20.0, 3.0, 0.0)], [*strip, (12, 13, 14)]


SHAPES = {"prism": prism(), "sheet": sheet()}


def halved(polygons: Polygons) -> Polygons:
    return [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]


def obj(form: str = "{v}", *, relative: bool = False, triangles: bool = False, end: str = "\n") -> Any:
    def write(points: Points, polygons: Polygons) -> bytes:
        lines = ["# made for a test", *("v " + " ".join(map(repr, p)) for p in points)]
        lines += [f"vt {k / 16!r} 0.5" for k in range(len(points))] if "{t}" in form else []
        lines += ["vn 0.0 0.0 1.0" for _ in points] if "{n}" in form else []
        for polygon in halved(polygons) if triangles else polygons:
            numbers = [k - len(points) if relative else k + 1 for k in polygon]
            lines.append("f " + " ".join(form.format(v=k, t=k, n=k) for k in numbers))
        return (end.join(lines) + end).encode()

    return write


def ply(
    order: str,
    number: str = "double",
    length: str = "uchar",
    index: str = "int",
    *,
    extra: bool = False,
    triangles: bool = False,
    name: str = "vertex_indices",
    end: str = "\n",
) -> Any:
    codes = {"uchar": "B", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d", "short": "h"}

    def write(points: Points, polygons: Polygons) -> bytes:
        faces = halved(polygons) if triangles else polygons
        head = ["ply", f"format {order} 1.0", "comment made for a test", f"element vertex {len(points)}"]
        head += [f"property {number} {axis}" for axis in "xyz"]
        head += ["property uchar red", "property uchar green", "property uchar blue", "property float q"] * extra
        head += [f"element face {len(faces)}", f"property list {length} {index} {name}"]
        head += ["property short part"] * extra
        head += ["end_header"]
        vertex = codes[number] * 3 + "BBBf" * extra
        rows = [(vertex, (*p, *(1, 2, 3, 0.5) * extra)) for p in points]
        for k, face in enumerate(faces):
            row = (len(face), *face, *(k,) * extra)
            rows.append((codes[length] + codes[index] * len(face) + "h" * extra, row))
        text = (end.join(head) + end).encode()
        if order == "ascii":
            return text + "".join(" ".join(map(repr, row)) + end for _, row in rows).encode()
        sign = "<" if "little" in order else ">"
        return text + b"".join(struct.pack(sign + code, *row) for code, row in rows)

    return write


def stl(binary: bool, header: bytes = b"made for a test", end: str = "\n") -> Any:
    def write(points: Points, polygons: Polygons) -> bytes:
        faces = [[points[k] for k in face] for face in halved(polygons)]
        if binary:
            body = b"".join(struct.pack("<12fH", 0, 0, 1, *(x for p in face for x in p), 0) for face in faces)
            return header.ljust(80, b"\0") + struct.pack("<I", len(faces)) + body
        lines = ["solid made for a test"]
        for face in faces:
            lines += ["  facet normal 0 0 1", "    outer loop"]
            lines += ["      vertex " + " ".join(map(repr, p)) for p in face]
            lines += ["    endloop", "  endfacet"]
        return (end.join([*lines, "endsolid made for a test"]) + end).encode()

    return write


LITTLE, BIG = "binary_little_endian", "binary_big_endian"
ORDERS, WHOLE = ("ascii", LITTLE, BIG), ("uchar", "int", "uint")
VARIANTS: dict[str, Any] = {
    "v.obj": obj(),
    "v-vt.obj": obj("{v}/{t}"),
    "v--vn.obj": obj("{v}//{n}"),
    "v-vt-vn.obj": obj("{v}/{t}/{n}"),
    "triangles.obj": obj(triangles=True),
    "negative.obj": obj(relative=True),
    "negative-v--vn.obj": obj("{v}//{n}", relative=True),
    "negative-v-vt-vn.obj": obj("{v}/{t}/{n}", relative=True, triangles=True),
    "crlf.obj": obj(end="\r\n"),
    **{f"{order}-{number}.ply": ply(order, number) for order in ORDERS for number in ("float", "double")},
    **{f"{LITTLE}-{n}-{i}.ply": ply(LITTLE, "float", n, i) for n in WHOLE for i in WHOLE},
    **{f"{order}-extra.ply": ply(order, extra=True) for order in ORDERS},
    **{f"{order}-triangles.ply": ply(order, "float", triangles=True) for order in ORDERS},
    "vertex_index.ply": ply(LITTLE, name="vertex_index"),
    "crlf.ply": ply("ascii", end="\r\n"),
    "ascii.stl": stl(False),
    "crlf-ascii.stl": stl(False, end="\r\n"),
    "binary.stl": stl(True),
    "solid-binary.stl": stl(True, b"solid that is none"),
}  # fmt: skip
