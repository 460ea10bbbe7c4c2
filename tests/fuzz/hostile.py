"""Files of megabytes that are made to be slow: much of one thing that is small in any honest mesh."""

from __future__ import annotations

import gzip
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Polygons = NDArray[np.int64] | list[list[int]]


@dataclass(frozen=True)
class Hostile:
    """Maker of the file of a size n, the options that make it worse, and bytes of memory allowed for each of n."""

    suffix: str
    make: Callable[[int], bytes]
    n: int
    options: tuple[str, ...] = ()
    memory: int = 5_000


def _obj(points: NDArray[np.float64], polygons: Polygons, between: str = "") -> bytes:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    for k, polygon in enumerate(polygons):
        if between:
            lines.append(between.format(k))
        lines.append("f " + " ".join(str(i + 1) for i in polygon))
    return ("\n".join(lines) + "\n").encode()


def _apart(n: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """n triangles that touch nowhere."""
    corner = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0.5]])
    points = (corner[None] + np.arange(n)[:, None, None] * 2.0).reshape(-1, 3)
    return points, np.arange(3 * n).reshape(-1, 3)


def objects(n: int) -> bytes:
    """As many objects as triangles."""
    return _obj(*_apart(n), between="o part{0}\ng a{0} b\nusemtl m{0}")


def _circle(n: int) -> NDArray[np.float64]:
    angle = np.arange(n) * (2 * np.pi / n)
    return np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)


def convex_polygon(n: int) -> bytes:
    """One polygon of n corners."""
    return _obj(_circle(n), [list(range(n))])


def star_polygon(n: int) -> bytes:
    """One polygon of n corners, every second of them reflex."""
    points = _circle(n)
    points[1::2] *= 0.5
    return _obj(points, [list(range(n))])


def crossed_polygon(n: int) -> bytes:
    """One polygon whose corners come in a random order."""
    return _obj(_circle(n), [np.random.default_rng(0).permutation(n).tolist()])


def comb_polygon(n: int) -> bytes:
    """One polygon of long teeth."""
    k = np.arange(n)
    teeth = np.stack([k / n, np.where(k % 2, 1.0, 0.1), 0.0 * k], axis=1)
    points = np.concatenate([teeth, [[1.0, 0, 0], [0, 0, 0]]])
    return _obj(points, [list(range(len(points)))[::-1]])


def fan(n: int) -> bytes:
    """A cone of n faces at one apex."""
    points = np.concatenate([_circle(n), [[0.0, 0.0, 1.0]]])
    k = np.arange(n)
    return _obj(points, np.stack([k, (k + 1) % n, np.full(n, n)], axis=1))


def book(n: int) -> bytes:
    """n faces at one edge."""
    points = np.concatenate([_circle(n), [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]])
    return _obj(points, np.stack([np.full(n, n), np.full(n, n + 1), np.arange(n)], axis=1))


def pinched(n: int) -> bytes:
    """n triangles that meet in one vertex only."""
    points = np.concatenate([_circle(2 * n), [[0.0, 0.0, 1.0]]])
    k = np.arange(n)
    return _obj(points, np.stack([2 * k, 2 * k + 1, np.full(n, 2 * n)], axis=1))


def doubled(n: int) -> bytes:
    """One face n times."""
    return _obj(_circle(3), np.tile(np.arange(3), (n, 1)))


def one_place(n: int) -> bytes:
    """n triangles whose vertices are all at three places."""
    return _obj(np.tile(_circle(3), (n, 1)), np.arange(3 * n).reshape(-1, 3))


def apart(n: int) -> bytes:
    """n components."""
    return _obj(*_apart(n))


_LITTLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def long_comment(n: int) -> bytes:
    """A line of n characters."""
    return _LITTLE + b"#" + b" x" * (n // 2) + b"\n"


def long_name(n: int) -> bytes:
    """The name of an object of n characters."""
    return b"o " + b"ab" * (n // 2) + b"\n" + _LITTLE


def continued(n: int) -> bytes:
    """A line continued n times."""
    return _LITTLE + b"f 1 2 \\\n" + b"\\\n" * n + b"3\n"


def unknown(n: int) -> bytes:
    """n statements that nobody knows, all of them different."""
    return _LITTLE + b"".join(b"x%d 1\n" % k for k in range(n))


def blank(n: int) -> bytes:
    """n empty lines and carriage returns."""
    return _LITTLE + b"\r\n\r \t\n" * n


def many_slashes(n: int) -> bytes:
    """A face of n corners with all that may stand beside an index."""
    return b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + b" ".join(b"%d/1/1" % (k % 3 + 1) for k in range(n)) + b"\n"


_XYZ = b"property float x\nproperty float y\nproperty float z\n"


def _ply(head: bytes, body: bytes, order: bytes = b"binary_little_endian") -> bytes:
    return b"ply\nformat " + order + b" 1.0\n" + head + b"end_header\n" + body


def mixed_lists(n: int) -> bytes:
    """Lists of changing length, which must be walked from row to row."""
    faces = b"".join(struct.pack("<B3i", 3, 0, 1, 2) + struct.pack("<B4i", 4, 0, 1, 2, 3) for _ in range(n))
    head = b"element vertex 4\n" + _XYZ + b"element face %d\nproperty list uchar int vertex_indices\n" % (2 * n)
    return _ply(head, struct.pack("<12f", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0) + faces)


def many_elements(n: int) -> bytes:
    """A header of n elements and as many comments."""
    head = b"element vertex 3\n" + _XYZ + b"element face 1\nproperty list uchar int vertex_indices\n"
    head += b"".join(b"comment x\nelement e%d 1\nproperty int a\n" % k for k in range(n))
    return _ply(head, b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" + b"1\n" * n, b"ascii")


def many_properties(n: int) -> bytes:
    """An element of n properties."""
    head = b"element vertex 3\n" + _XYZ + b"".join(b"property uchar p%d\n" % k for k in range(n))
    head += b"element face 1\nproperty list uchar int vertex_indices\n"
    rows = b"".join(struct.pack("<3f", *p) + b"\1" * n for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    return _ply(head, rows + struct.pack("<B3i", 3, 0, 1, 2))


def strip(n: int) -> bytes:
    """One strip of n triangles."""
    points = np.array([[k // 2, k % 2, 0.01 * k] for k in range(n)], "<f4").tobytes()
    row = struct.pack("<i", n) + np.arange(n, dtype="<i4").tobytes()
    head = b"element vertex %d\n" % n + _XYZ + b"element tristrips 1\nproperty list int int vertex_indices\n"
    return _ply(head, points + row)


def _facets(n: int) -> Iterator[bytes]:
    yield from (b"facet normal 0 0 1\nouter loop\nvertex 0 0 %d\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n" % k
                for k in range(n))  # fmt: skip


def solids(n: int) -> bytes:
    """As many solids as facets."""
    return b"".join(b"solid s\n" + facet + b"endsolid s\n" for facet in _facets(n))


def one_line_stl(n: int) -> bytes:
    """A whole STL file on one line."""
    return b" ".join([b"solid s", *_facets(n), b"endsolid"]).replace(b"\n", b" ")


def blank_stl(n: int) -> bytes:
    """Facets that share a line, and as many line ends before the last word."""
    return b"solid s " + b" ".join(_facets(4)).replace(b"\n", b" ") + b"\n" * n + b"endsolid s\n"


def equal_facets(n: int) -> bytes:
    """One facet n times."""
    return bytes(80) + struct.pack("<I", n) + struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0) * n


def swollen(n: int) -> bytes:
    """gzip data that inflate to n bytes."""
    return gzip.compress(_LITTLE + b"#" * n, 9)


PAPER = ("-p", "paper")
FILES = {
    "objects": Hostile("obj", objects, 8_000, ("--regions", "objects"), memory=25_000),
    "convex_polygon": Hostile("obj", convex_polygon, 50_000),
    "star_polygon": Hostile("obj", star_polygon, 20_000),
    "crossed_polygon": Hostile("obj", crossed_polygon, 20_000),
    "comb_polygon": Hostile("obj", comb_polygon, 15_000),
    "fan": Hostile("obj", fan, 20_000, PAPER),
    "book": Hostile("obj", book, 20_000, PAPER, memory=8_000),
    "pinched": Hostile("obj", pinched, 20_000, PAPER, memory=10_000),
    "doubled": Hostile("obj", doubled, 30_000, PAPER),
    "one_place": Hostile("obj", one_place, 20_000, ("--weld", "1e-3")),
    "apart": Hostile("obj", apart, 8_000, memory=16_000),
    "long_comment": Hostile("obj", long_comment, 3_000_000, memory=60),
    "long_name": Hostile("obj", long_name, 1_000_000, ("--regions", "objects"), memory=150),
    "continued": Hostile("obj", continued, 100_000, memory=1_000),
    "unknown": Hostile("obj", unknown, 30_000),
    "blank": Hostile("obj", blank, 100_000, memory=1_000),
    "many_slashes": Hostile("obj", many_slashes, 50_000, memory=1_500),
    "mixed_lists": Hostile("ply", mixed_lists, 40_000),
    "many_elements": Hostile("ply", many_elements, 10_000),
    "many_properties": Hostile("ply", many_properties, 2_000, memory=50_000),
    "strip": Hostile("ply", strip, 100_000),
    "solids": Hostile("stl", solids, 10_000),
    "one_line_stl": Hostile("stl", one_line_stl, 10_000),
    "blank_stl": Hostile("stl", blank_stl, 200_000, memory=500),
    "equal_facets": Hostile("stl", equal_facets, 30_000),
    "swollen": Hostile("obj.gz", swollen, 60_000_000, memory=12),
}
