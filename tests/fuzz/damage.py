"""Damage to files: cut, flipped, spliced, recoded, packed, and lied in."""

from __future__ import annotations

import gzip
import re
from collections.abc import Callable

from hypothesis import strategies as st

_WORDS = (
    b"nan NaN -inf Infinity 1e400 -1e400 -0 -0.0 1e-320 1e-400 0x10 1_000 1,5 1e 1e+ . + - -- 1.2.3 \xd9\xa1\xd9\xa2 "
    b"\xef\xbc\x91 0 -1 -2 1 2 255 256 65536 2147483647 2147483648 -2147483648 4294967295 4294967296 "
    b"9223372036854775807 9223372036854775808 99999999999999999999 1e9 1e18 -5 0.5 1.5 -1.5 1/ /1 1// //1 1/2/3/4 "
    b"1/x x \xff\xfe \0 # \\ \" ' , ; f v l end_header"
)
NUMBERS = [*_WORDS.split(b" "), b"1" * 400, b"0." + b"0" * 400 + b"1", b"9" * 5000, b"f" * 3000]
EXTREMES = (
    *(b"\xff" * 4, b"\0" * 4, b"\xff\xff\xff\x7f", b"\0\0\0\x80", b"\xff" * 8, b"\xff", b"\0", b"\x80"),
    *(b"\0\0\x80\x7f", b"\x7f\x80\0\0", b"\0\0\xc0\x7f", b"\x01\0\x80\x7f", b"\0\0\0\0\0\0\xf0\x7f"),
)
LINES = (
    b"f 1 2 3\nf 0 1 2\nf -1 -2 -3\nf 1 2\nf\nf 1 2 3 4 5 6 7 8\nv 1 2\nv 1 2 3 4\nv 0 0 0 1 1 1\nv nan nan nan\nv\n"
    b"l 1 2 3\nl\np 1\ng a b\no \xe4\xff\nusemtl a\nmtllib ../../etc/passwd\ncall x.obj\ncurv 0 1 1 2\ns 1\nvt 0 0\n"
    b"vn 0 0 1\n# c\n\\\nply\nelement face 99999999999\nelement vertex -1\nelement vertex 18446744073709551616\n"
    b"element x 1\nelement face 0\nproperty list uchar int vertex_indices\nproperty list float int vertex_indices\n"
    b"property list uchar float vertex_indices\nproperty list uint double w\nproperty int64 x\nproperty double y\n"
    b"property\nend_header\nformat ascii 1.0\nformat binary_big_endian 1.0\ncomment x\nsolid\nendsolid\nendfacet\n"
    b"facet normal 0 0 1\nouter loop\nvertex 1 2 3\nvertex 1 2\nendloop\nsolid facet normal 0 0 0\n3 0 1 2\n"
    b"4 0 1 2 3\n0\n-1\n3 0 1 99\n3 0 1 -1\n300 1 2 3\n2 0 1"
).split(b"\n")

Damage = Callable[[st.DrawFn, bytes], bytes]


def _at(draw: st.DrawFn, data: bytes) -> int:
    return draw(st.integers(0, len(data)))


def truncate(draw: st.DrawFn, data: bytes) -> bytes:
    """The file ends at any byte."""
    return data[: _at(draw, data)]


def flip(draw: st.DrawFn, data: bytes) -> bytes:
    """Single bytes change."""
    changed = bytearray(data)
    for _ in range(draw(st.integers(1, 6))):
        if changed:
            changed[draw(st.integers(0, len(changed) - 1))] ^= draw(st.sampled_from([1, 2, 4, 8, 16, 32, 64, 128, 255]))
    return bytes(changed)


def overwrite(draw: st.DrawFn, data: bytes) -> bytes:
    """A stretch is replaced by others bytes, longer or shorter."""
    begin = _at(draw, data)
    end = min(len(data), begin + draw(st.integers(0, 40)))
    new = draw(
        st.one_of(st.binary(max_size=12), st.sampled_from(NUMBERS), st.sampled_from([b"\n", b" ", b"\r", b"\0"]))
    )
    return data[:begin] + new + data[end:]


def extremes(draw: st.DrawFn, data: bytes) -> bytes:
    """A stretch of a binary file becomes all ones, zeros, an infinity, a NaN, a large count."""
    begin = _at(draw, data)
    new = draw(st.sampled_from(EXTREMES))
    return data[:begin] + new + data[begin + len(new) :]


def token(draw: st.DrawFn, data: bytes) -> bytes:
    """A word becomes another one."""
    words = list(re.finditer(rb"[^\s/]+", data[: 1 << 14]))
    if not words:
        return data
    word = words[draw(st.integers(0, len(words) - 1))]
    return data[: word.start()] + draw(st.sampled_from(NUMBERS)) + data[word.end() :]


def announce(draw: st.DrawFn, data: bytes) -> bytes:
    """A count lies: that of a PLY element, of an STL file, of a list."""
    counts = list(re.finditer(rb"(?m)^element \w+ (\d+)", data[: 1 << 14]))
    if not counts:
        number = draw(st.one_of(st.integers(0, 40), st.sampled_from([2**31, 2**32 - 1, 85899345])))
        return data[:80] + number.to_bytes(4, "little") + data[84:]
    count = draw(st.sampled_from(counts))
    old = int(count[1])
    new = draw(st.sampled_from([old + 1, old - 1, 0, 2 * old, -old, 10**6, 10**9, 2**31, 2**63, 2**64, 10**30]))
    return data[: count.start(1)] + str(new).encode() + data[count.end(1) :]


def lines(draw: st.DrawFn, data: bytes) -> bytes:
    """Lines are lost, doubled, swapped, joined, or come from elsewhere."""
    end = b"\r\n" if b"\r\n" in data else b"\r" if b"\r" in data and b"\n" not in data else b"\n"
    parts = data.split(end)
    k, other = (draw(st.integers(0, len(parts) - 1)) for _ in range(2))
    match draw(st.sampled_from(["lose", "double", "swap", "join", "insert", "insert", "indent"])):
        case "lose":
            del parts[k]
        case "double":
            parts[k:k] = [parts[k]] * draw(st.integers(1, 3))
        case "swap":
            parts[k], parts[other] = parts[other], parts[k]
        case "join":
            parts[k : k + 2] = [draw(st.sampled_from([b" ", b"", b" \\ ", b"#"])).join(parts[k : k + 2])]
        case "insert":
            parts.insert(k, draw(st.sampled_from(LINES)))
        case _:
            parts[k] = b" \t" + parts[k] + b"  "
    return end.join(parts)


def recode(draw: st.DrawFn, data: bytes) -> bytes:
    """Another encoding or other line ends."""
    match draw(st.sampled_from(["bom", "crlf", "cr", "nul", "latin", "utf16", "tabs", "upper", "lf+cr"])):
        case "bom":
            return b"\xef\xbb\xbf" + data
        case "crlf":
            return data.replace(b"\n", b"\r\n")
        case "cr":
            return data.replace(b"\n", b"\r")
        case "lf+cr":
            return data.replace(b"\n", b"\n\r")
        case "nul":
            return data.replace(b" ", b"\0")
        case "latin":
            return data.replace(b"e", b"\xe9")
        case "utf16":
            return data.decode("latin-1").encode(draw(st.sampled_from(["utf-16", "utf-16-be", "utf-32"])))
        case "tabs":
            return data.replace(b" ", b"\t\v\f")
        case _:
            return data.upper()


def order(draw: st.DrawFn, data: bytes) -> bytes:
    """A PLY file claims another byte order, or to be text, or other types."""
    names = [b"binary_little_endian", b"binary_big_endian", b"ascii"]
    types = b"char uchar short ushort int uint float double int8 uint16 float64 uint64 int64 half".split()
    if draw(st.booleans()):
        old = next((name for name in names if name in data[:200]), None)
        return data if old is None else data.replace(old, draw(st.sampled_from(names)), 1)
    found = list(re.finditer(rb"(?m)^property (?:list )?(\w+)", data[:2000]))
    if not found:
        return data
    at = draw(st.sampled_from(found))
    return data[: at.start(1)] + draw(st.sampled_from(types)) + data[at.end(1) :]


def lengthen(draw: st.DrawFn, data: bytes) -> bytes:
    """Very much of something: a long line, many lines, many words, trailing bytes."""
    many = draw(st.sampled_from([100, 2000, 20000]))
    what = draw(
        st.sampled_from([b" ", b"x", b"\n", b"# ", b"\\\n", b" 1", b"o a\n", b"\0", b"v 0 0 0\n", b"\n\r", b"//"])
    )
    at = draw(st.sampled_from([0, len(data), _at(draw, data)]))
    return data[:at] + what * (many // len(what)) + data[at:]


def pack(draw: st.DrawFn, data: bytes) -> bytes:
    """gzip: whole, cut, damaged, twice, in two parts, or far larger than it looks."""
    packed = gzip.compress(data, mtime=0)
    match draw(st.sampled_from(["whole", "whole", "cut", "flip", "twice", "parts", "tail", "swell"])):
        case "cut":
            return truncate(draw, packed)
        case "flip":
            return flip(draw, packed)
        case "twice":
            return gzip.compress(packed, mtime=0)
        case "parts":
            return gzip.compress(data[: len(data) // 2], mtime=0) + gzip.compress(data[len(data) // 2 :], mtime=0)
        case "tail":
            return packed + draw(st.binary(max_size=9))
        case "swell":
            return gzip.compress(data + b"\n" * (1 << draw(st.integers(10, 20))), mtime=0)
        case _:
            return packed


DAMAGES: tuple[Damage, ...] = (truncate, flip, overwrite, extremes, token, token, announce, lines, lines, recode, order)
RARE: tuple[Damage, ...] = (lengthen, pack)


@st.composite
def damaged(draw: st.DrawFn, data: bytes, other: bytes) -> bytes:
    """The file after one to three accidents; `other` is what it may be spliced with."""
    for _ in range(draw(st.sampled_from([1, 1, 1, 1, 2, 3]))):
        match draw(st.integers(0, 14)):
            case 0:
                data = data[: _at(draw, data)] + other[_at(draw, other) :]
            case 1:
                data = draw(st.sampled_from(RARE))(draw, data)
            case _:
                data = draw(st.sampled_from(DAMAGES))(draw, data)
    return data
