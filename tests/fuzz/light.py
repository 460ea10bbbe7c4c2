"""A second, plain reading of mesh files, line by line: what a report must have counted, silent where it is unsure."""

from __future__ import annotations

import gzip
import re
import struct
from collections import Counter
from collections.abc import Iterable


def content(data: bytes) -> bytes:
    """The bytes of the mesh, unpacked."""
    return gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data


def counts(data: bytes, kind: str) -> tuple[int | None, int | None]:
    """Vertices and polygons of a file that has been accepted; None where this reading cannot tell."""
    if kind == "obj":
        return _obj(data)
    if kind == "ply":
        return _ply(data)
    return None, _stl(data)


def _lines(data: bytes) -> list[bytes]:
    data = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return re.sub(rb"[ \t\v\f\0\x1c-\x1f]+", b" ", data).split(b"\n")


def _obj(data: bytes) -> tuple[int | None, int | None]:
    vertices = polygons = 0
    pending = b""
    for line in _lines(data):
        line = pending + line
        if line.rstrip(b" ").endswith(b"\\"):
            if b"#" in line:
                return None, None
            pending = line.rstrip(b" ")[:-1] + b" "
            continue
        pending = b""
        words = line.partition(b"#")[0].split(b" ")
        words = [word for word in words if word]
        vertices += words[:1] == [b"v"]
        polygons += words[:1] == [b"f"] and len(words) > 3
    return (None, None) if pending else (vertices, polygons)


def _ply(data: bytes) -> tuple[int | None, int | None]:
    header = data[: re.search(rb"[\r\n]end_header", data).start()].decode("latin-1")  # type: ignore[union-attr]
    found = {
        name: int(count)
        for line in re.split(r"\r\n|\r|\n", header)
        for name, count in re.findall(r"^\s*element\s+(\S+)\s+(\S+)\s*$", line)
    }
    faces = found.get("face", 0)
    return found.get("vertex"), None if found.get("tristrips") else faces


def _stl(data: bytes) -> int | None:
    if len(data) >= 84:
        (announced,) = struct.unpack("<I", data[80:84])
        if len(data) == 84 + 50 * announced or not re.match(rb"(?i)(\xef\xbb\xbf)?\s*solid\b", data):
            return int(announced)
    words = [word.lower() for line in _lines(data) for word in line.split(b" ")]
    if b"solid" in words[3:]:  # names and comments may hold any word
        return None
    return words.count(b"vertex") // 3


def topology(faces: Iterable[tuple[int, int, int]]) -> dict[str, int]:
    """Counts of a triangle complex from the corners of its faces, with sets and counters."""
    faces = list(faces)
    edges = Counter(tuple(sorted(pair)) for a, b, c in faces for pair in ((a, b), (b, c), (c, a)))
    corners = {corner for face in faces for corner in face}
    parent = {corner: corner for corner in corners}

    def root(corner: int) -> int:
        while parent[corner] != corner:
            parent[corner] = parent[parent[corner]]
            corner = parent[corner]
        return corner

    for a, b in edges:
        parent[root(a)] = root(b)
    same = Counter(tuple(sorted(face)) for face in faces)
    return {
        "vertices": len(corners),
        "edges": len(edges),
        "faces": len(faces),
        "euler_characteristic": len(corners) - len(edges) + len(faces),
        "boundary_edges": sum(n == 1 for n in edges.values()),
        "nonmanifold_edges": sum(n > 2 for n in edges.values()),
        "duplicate_faces": sum(n - 1 for n in same.values()),
        "components": len({root(corner) for corner in corners}),
    }
