"""The header of a PLY file: its elements and their properties."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass

import numpy as np

from ....errors import InputError
from ...text import decode

_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "float32": "f4",
    "float64": "f8",
}
_ORDER = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
HEADER_END = re.compile(rb"[\r\n]end_header[ \t]*(\r\n|\n|\r)")
_MAGIC = re.compile(rb"ply[ \t]*(\r\n|\n|\r)")
CORNERS = ("vertex_indices", "vertex_index")
"""Names of the list of corners of a face."""
TOO_SMALL = "if a count in the header is too small, elements are missing"


@dataclass(frozen=True)
class PlyProperty:
    """A property of an element. length: type of the count of a list, None for a scalar."""

    name: str
    type: np.dtype[np.generic]
    length: np.dtype[np.generic] | None = None

    @property
    def native(self) -> np.dtype[np.generic]:
        """The type in the byte order of this machine."""
        return self.type.newbyteorder("=")


@dataclass(frozen=True)
class PlyElement:
    """A number of rows with the same properties."""

    name: str
    count: int
    properties: tuple[PlyProperty, ...]

    @property
    def least_bytes(self) -> int:
        """Least number of bytes of a binary row."""
        return sum((p.length or p.type).itemsize for p in self.properties)


@dataclass(frozen=True)
class Header:
    """Elements in file order, kind and start of the body, number of header lines, and unknown lines."""

    elements: tuple[PlyElement, ...]
    ascii: bool
    body: int
    lines: int
    unknown: tuple[int, ...] = ()


def parse_header(data: bytes) -> Header:
    """Parse the header of a PLY file.

    Lines with an unknown keyword before the first element, such as a comment without `comment`, are ignored: they have
    no data, and a misspelled element leaves properties without an element, which is an error.
    Errors: InputError with the line of a malformed statement.
    """
    start = 3 if data.startswith(b"\xef\xbb\xbf") else 0
    magic = _MAGIC.match(data, start)
    if not magic:
        raise InputError("no PLY header found; a first line `ply` expected", place="line 1")
    newline = magic[1]
    end = HEADER_END.search(data, magic.end() - 1)
    if not end:
        raise InputError("no `end_header` found, expected at the end of the PLY header")
    # Bytes, since str.split would also split at bytes inside multi-byte characters.
    lines = data[magic.end() : end.start() + 1].replace(newline, b"\n").split(b"\n")[:-1]
    order: str | None = None
    elements: list[tuple[str, int, list[PlyProperty]]] = []
    unknown: list[int] = []
    for number, line in enumerate(lines, 2):
        tokens = [decode(word) for word in line.split()]
        place = f"line {number}"
        match tokens:
            case [] | ["comment" | "obj_info", *_]:
                continue
            case ["format", *_] if order:
                raise InputError("a second `format` found, one expected", place=place)
            case ["format", str(name), *_]:
                if name not in _ORDER:
                    raise InputError(f"format `{name[:40]}` found, one of {', '.join(_ORDER)} expected", place=place)
                order = name
            case ["element", str(name), str(count)]:
                elements.append((name, _count(count, place), []))
            case ["property", "list", str(length), str(kind), str(name)] if elements and order:
                length_type = _type(length, order, place)
                if length_type.kind == "f":
                    raise InputError(
                        f"list length of type `{length[:40]}` found, an integer type expected", place=place
                    )
                elements[-1][2].append(PlyProperty(name, _type(kind, order, place), length_type))
            case ["property", str(kind), str(name)] if elements and order:
                elements[-1][2].append(PlyProperty(name, _type(kind, order, place)))
            case [str(keyword), *_] if not elements and keyword not in ("format", "element", "property", "end_header"):
                unknown.append(number)
            case _:
                raise InputError(f"`{' '.join(tokens)[:60]}` found, a PLY header statement expected", place=place)
    if order is None:
        raise InputError("no `format` found in the PLY header")
    _once("element", [name for name, _, _ in elements])
    for name, _, properties in elements:
        _once(f"element `{name[:40]}`: property", [p.name for p in properties])
    # Old Mac line ends: a line feed after the last one belongs to the data.
    body = end.end() - (newline == b"\r" and end[1] == b"\r\n")
    return Header(
        tuple(PlyElement(name, count, tuple(properties)) for name, count, properties in elements),
        order == "ascii",
        body,
        len(lines) + 2,
        tuple(unknown),
    )


def _once(what: str, names: list[str]) -> None:
    name, times = max(Counter(names).items(), key=lambda count: count[1], default=("", 1))
    if times > 1:
        raise InputError(f"{what} `{name[:40]}` announced {times} times, once expected", place="header")


def _count(text: str, place: str) -> int:
    if not re.fullmatch(r"\+?\d{1,18}", text, re.ASCII):
        raise InputError(f"element count `{text[:40]}` found, a whole number expected", place=place)
    return int(text)


def _type(name: str, order: str, place: str) -> np.dtype[np.generic]:
    if name not in _TYPES:
        raise InputError(f"type `{name[:40]}` found, one of {', '.join(_TYPES)} expected", place=place)
    return np.dtype(_ORDER[order] + _TYPES[name])
