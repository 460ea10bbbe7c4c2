"""Destinations of outputs: the file behind a name, its writability, and a test for two names of one file."""

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
    """File behind a name, and whether it is written directly: a stream, a device or a FIFO."""

    final: str
    direct: bool


def resolve(path: str) -> Place:
    """Destination of an output of this name; OutputError if it cannot be a file."""
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
    # A device or FIFO by the name given: the target of /dev/stdout is often no name at all.
    return Place(final, False) if stat.S_ISREG(mode) else Place(os.path.abspath(path), True)


def stream_number(path: str) -> int | None:
    """Descriptor behind /dev/stdout, /dev/fd/N and the like, which must not be replaced by a file."""
    normal = os.path.normpath(path)
    for folder in _STREAM_FOLDERS:
        if normal.startswith(folder) and normal.removeprefix(folder).isdecimal():
            return int(normal.removeprefix(folder))
    return _STREAM_NAMES.get(normal)


def beside(final: str) -> str:
    """New hidden name in the same folder; short, so that it fits beside a longest possible file name."""
    return os.path.join(os.path.dirname(final), f".curvcli-{secrets.token_hex(8)}.part")


def probe(folder: str) -> bool:
    """Create and remove a file: the one test of writability that holds for every user and file system.

    Returns true if the folder ignores case. Errors: OSError from the system.
    """
    name = beside(os.path.join(folder, ""))
    try:
        os.close(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        return os.path.exists(os.path.join(folder, os.path.basename(name).upper()))
    finally:
        with contextlib.suppress(OSError):
            os.unlink(name)


def same_file(first: Place, second: Place) -> bool:
    """True if two names lead to one file: equal, linked, or alike but for case where the file system ignores it."""
    if first.direct or second.direct:
        streams = stream_number(first.final), stream_number(second.final)
        if streams[0] is not None or streams[1] is not None:
            return streams[0] == streams[1]
        # Several outputs may go to /dev/null.
        if os.devnull in (first.final, second.final):
            return False
    if first.final == second.final:
        return True
    with contextlib.suppress(OSError):
        if os.path.samefile(first.final, second.final):
            return True
    if first.direct or second.direct:
        return False
    return folded(first.final) == folded(second.final) and probe(os.path.dirname(first.final))


def folded(path: str) -> str:
    """Path in the form that a file system compares if it ignores case."""
    return unicodedata.normalize("NFC", path).casefold()
