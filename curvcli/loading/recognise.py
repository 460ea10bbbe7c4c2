"""Recognition of the format of a file, by its name and by its content."""

from __future__ import annotations

import re
from collections.abc import Collection

from ..errors import InputError, Notice
from .hints import known_suffix, of_suffix, suffix_of
from .pieces import Pieces
from .registry import InputFormat, by_sign, input_formats, suffixes

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
_OPTION = "--input-format"
_WIDE_TEXT = re.compile(
    rb"\xff\xfe|\xfe\xff|(?:[\t\n\r -~]\0){4}|(?:\0[\t\n\r -~]){4}|(?:[\t\n\r -~]\0{3}){2}|(?:\0{3}[\t\n\r -~]){2}"
)


def format_of_file(path: str, pieces: Pieces) -> str:
    """The format of the suffix; else that of the content, if files of that format often have no suffix.

    Errors: InputError for neither.
    """
    try:
        return format_of_name(path)
    except InputError:
        for format in by_sign():
            if format.starts and format.has_sign(pieces):
                return format.name
        raise


def format_of_name(path: str) -> str:
    """The format of the suffix.

    Errors: InputError for a suffix of no format.
    """
    if known := known_suffix(path):
        return known
    suffix = suffix_of(path)
    expected = f"{', '.join(f'.{ending}' for ending in suffixes())} expected (each also with .gz)"
    suffix_text = f"suffix `.{suffix}` found" if suffix else "no suffix found"
    raise InputError(f"{suffix_text}, {expected}", hint=of_suffix(path))


def recognise(pieces: Pieces, wanted: str | None, by_name: bool = True) -> tuple[InputFormat, tuple[Notice, ...]]:
    """The format of the content, and a notice if it differs from the wanted one.

    wanted: the format by the name, or `--input-format` if not by_name; None for no expectation.
    Errors: InputError for unrecognised content.
    """
    start, formats = pieces.ahead(), input_formats()
    if not free_start(start, pieces.size, () if wanted is None else (wanted,)):
        _refuse_what_is_known(start)
    promised = None if wanted is None else formats[wanted]
    if promised is not None and not promised.weak_sign and promised.has_sign(pieces):
        return promised, ()
    recognised = next((other for other in by_sign() if other is not promised and other.has_sign(pieces)), None)
    if promised is None:
        if recognised is None:
            raise InputError("content not recognised", hint=f"--input-format {'|'.join(formats)} names the format")
        return recognised, ()
    if recognised is None or (recognised.weak_sign and promised.weak_sign and promised.has_sign(pieces)):
        return promised, ()
    said, way_out = (
        ("its name", f"rename it to .{recognised.endings[0]}") if by_name else (_OPTION, f"{_OPTION} {recognised.name}")
    )
    message = f"file whose content is {recognised.title}, not {promised.title} as {said} says, and read as such"
    return recognised, (Notice("wrong_suffix", 1, message, way_out),)


def free_start(start: bytes, size: int, promised: Collection[str]) -> bool:
    """Test for a format whose files may begin like an archive or a web page.

    promised: names of the formats that the file name allows.
    """
    tests = ((format.name in promised, format.any_start) for format in input_formats().values())
    return any(test is not None and test(start, size, named) for named, test in tests)


def _refuse_what_is_known(data: bytes) -> None:
    """Refuse content of other known kinds, a part of which might be read as a mesh."""
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
