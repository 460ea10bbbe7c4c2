"""Where an output goes: what its name stands for, whether it can be written, and whether two names are one file."""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
import unicodedata
from dataclasses import dataclass

from ..errors import OutputError
from ..support.words import escape_text

STDOUT = "-"
_STREAM_NAMES = {"/dev/stdout": 1, "/dev/stderr": 2}
_STREAM_FOLDERS = ("/dev/fd/", "/proc/self/fd/")


@dataclass(frozen=True)
class Place:
    """The file behind a name, and whether it is written directly: a stream, a device or a FIFO."""

    final: str
    direct: bool


def resolve(path: str) -> Place:
    """Where an output of this name goes; OutputError where it cannot be a file."""
    if path == STDOUT:
        return Place("/dev/stdout", True)
    if not path or "\0" in path:
        raise OutputError(f"{path!r}: not a file name")
    if stream_number(path) is not None:
        return Place(path, True)
    final = os.path.realpath(path)
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        if path.endswith(("/", os.sep)):
            raise OutputError(f"{escape_text(path)}: names a folder; give a file name") from None
        return Place(final, False)
    if stat.S_ISDIR(mode):
        raise OutputError(f"{escape_text(path)}: is a folder; give a file name in it")
    # A device or FIFO by the name given: what a link to /dev/stdout leads to is often no name at all.
    return Place(final, False) if stat.S_ISREG(mode) else Place(os.path.abspath(path), True)


def stream_number(path: str) -> int | None:
    """The descriptor behind /dev/stdout, /dev/fd/N and their like, which must not be replaced by a file."""
    plain = os.path.normpath(path)
    for folder in _STREAM_FOLDERS:
        if plain.startswith(folder) and plain.removeprefix(folder).isdecimal():
            return int(plain.removeprefix(folder))
    return _STREAM_NAMES.get(plain)


def beside(final: str) -> str:
    """A fresh hidden name in the same folder; short, so that a longest possible file name still has room for it."""
    return os.path.join(os.path.dirname(final), f".curvcli-{secrets.token_hex(8)}.part")


def probe(folder: str) -> bool:
    """Make and remove a file: the one test of writability that holds for every user and file system.

    Returns whether the folder ignores case. Errors: OSError as the system words it.
    """
    name = beside(os.path.join(folder, ""))
    try:
        os.close(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        return os.path.exists(os.path.join(folder, os.path.basename(name).upper()))
    finally:
        with contextlib.suppress(OSError):
            os.unlink(name)


def same_file(one: Place, two: Place) -> bool:
    """Whether two names end at one file: equal, linked, or alike but for case where the file system ignores it."""
    if one.direct or two.direct:
        streams = stream_number(one.final), stream_number(two.final)
        if streams[0] is not None or streams[1] is not None:
            return streams[0] == streams[1]
        # Everything may be poured into /dev/null, which keeps nothing.
        if os.devnull in (one.final, two.final):
            return False
    if one.final == two.final:
        return True
    with contextlib.suppress(OSError):
        if os.path.samefile(one.final, two.final):
            return True
    if one.direct or two.direct:
        return False
    return folded(one.final) == folded(two.final) and probe(os.path.dirname(one.final))


def folded(path: str) -> str:
    """The path as a file system compares it that ignores case."""
    return unicodedata.normalize("NFC", path).casefold()
