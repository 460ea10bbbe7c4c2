"""Which format a file has, by its name and by its content."""

from __future__ import annotations

import re

from ..errors import InputError, Notice
from .elsewhere import FORMATS, known_suffix, of_suffix, suffix_of
from .pieces import Pieces
from .ply_header import PLY_SIGN
from .stl import ASCII_SIGN, has_room, is_binary_stl

_ARCHIVES = {
    b"PK\x03\x04": "a ZIP archive",
    b"BZh": "bzip2 data",
    b"\xfd7zXZ\0": "xz data",
    b"\x28\xb5\x2f\xfd": "Zstandard data",
    b"7z\xbc\xaf\x27\x1c": "a 7z archive",
    b"\x1f\x8b": "gzip data within gzip data",
}
_INSTEAD = (
    (re.compile(rb"version https://git-lfs\."), "a Git LFS pointer", "`git lfs pull` brings the file itself"),
    (
        re.compile(rb"(?:\.\./)*(?:\.git)?/annex/objects/"),
        "a git-annex pointer",
        "`git annex get` brings the file itself",
    ),
    (re.compile(rb"\s*+<(?:!doctype\s+html|html)\b", re.IGNORECASE), "a web page", "download the file itself"),
)
_WIDE_TEXT = re.compile(
    rb"\xff\xfe|\xfe\xff|(?:[\t\n\r -~]\0){4}|(?:\0[\t\n\r -~]){4}|(?:[\t\n\r -~]\0{3}){2}|(?:\0{3}[\t\n\r -~]){2}"
)
_V_LINE = re.compile(rb"(?:^|[\r\n])[ \t]*v[ \t]+[-+.\d]\S*[ \t]+[-+.\d]")


def format_of_name(path: str) -> str:
    """The format that the suffix promises.

    Errors: InputError for a suffix that is not promised.
    """
    if known := known_suffix(path):
        return known
    suffix = suffix_of(path)
    expected = f"{', '.join('.' + name for name in FORMATS)} expected (each also with .gz)"
    found = f"suffix `.{suffix}` found" if suffix else "no suffix found"
    raise InputError(f"{found}, {expected}", hint=of_suffix(path))


def recognise(pieces: Pieces, wanted: str | None, by_name: bool = True) -> tuple[str, tuple[Notice, ...]]:
    """The format of the content, and a notice where it is not the wanted one.

    wanted: what the name says, or `--input-format` if not by_name, None if nothing does.
    Errors: InputError for content that cannot be recognised.
    """
    start = pieces.ahead()
    # The first 80 bytes of binary STL are free.
    if not (is_binary_stl(start, pieces.size) or (wanted == "stl" and has_room(start, pieces.size))):
        _refuse_what_is_known(start)
    if wanted in ("ply", "stl") and _bears_sign(pieces, wanted):
        return wanted, ()
    found = next((kind for kind in ("ply", "stl", "obj") if kind != wanted and _bears_sign(pieces, kind)), None)
    if found is None:
        if wanted is None:
            raise InputError("content not recognised", hint=f"--input-format {'|'.join(FORMATS)} names the format")
        return wanted, ()
    if wanted is None:
        return found, ()
    said, way_out = ("its name", f"rename it to .{found}") if by_name else ("--input-format", f"--input-format {found}")
    message = f"file whose content is {found.upper()}, not {wanted.upper()} as {said} says, and read as such"
    return found, (Notice("wrong_suffix", 1, message, way_out),)


def _refuse_what_is_known(data: bytes) -> None:
    """Refuses content that is known to be something else, of which a part might be read as a mesh."""
    for sign, what in _ARCHIVES.items():
        if data.startswith(sign):
            raise InputError(f"{what} found, a mesh expected", hint="unpack it first")
    for known, what, way_out in _INSTEAD:
        if known.match(data):
            raise InputError(f"{what} found, a mesh expected", hint=way_out)
    if data[257:262] == b"ustar":
        raise InputError("a tar archive found, a mesh expected", hint="unpack it first")
    if _WIDE_TEXT.match(data):
        raise InputError(
            "UTF-16 or UTF-32 text found, ASCII or UTF-8 expected", hint="convert it, for example with iconv"
        )


def _bears_sign(pieces: Pieces, kind: str) -> bool:
    start = pieces.ahead()
    if kind == "ply":
        return bool(PLY_SIGN.match(start))
    if kind == "stl":
        if is_binary_stl(start, pieces.size):
            return True
        return bool(ASCII_SIGN.match(start)) and (b"facet" in start.lower() or has_room(start, pieces.size))
    if not _V_LINE.search(start):
        return False
    data = pieces.whole()
    return b"\nf " in data or b"\rf " in data or b"\nf\t" in data
