"""Bytes of a file: regular files only, read once, inflated within limits."""

from __future__ import annotations

import errno
import gzip
import io
import os
import stat
import sys
import zlib
from typing import Any, BinaryIO

from ..errors import InputError
from ..support.sinks import wait_for
from .file_state import changed, rewritten, stamp, unreadable
from .hints import of_folder, of_missing

_CHUNK = 1 << 24
_FREE_INFLATION = 1 << 26
_INFLATION = 100


class DamagedError(InputError):
    """Compressed data that cannot be inflated."""


def open_regular(path: str | bytes | os.PathLike[Any], max_bytes: int | None) -> io.FileIO:
    """Open a regular file for reading without a buffer.

    Errors: InputError for a missing, unreadable, too large or irregular file; FIFOs and devices never block.
    """
    flags = os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)
    try:
        if not stat.S_ISREG(mode := os.stat(path).st_mode):
            raise _irregular(mode, path)
        descriptor = os.open(path, flags)
    except (OSError, ValueError) as error:
        refused = unreadable(error)
        if getattr(error, "errno", None) in (errno.ENOENT, errno.ENOTDIR):
            refused.hint = of_missing(os.fsdecode(path))
        raise refused from None
    file = io.FileIO(descriptor)
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        file.close()
        raise _irregular(status.st_mode, path)
    if max_bytes is not None and status.st_size > max_bytes:
        file.close()
        raise too_large(f"{status.st_size} bytes", max_bytes)
    return file


def read_limited(file: BinaryIO | io.FileIO, max_bytes: int | None, expected: str = "a mesh") -> bytes:
    """Read all bytes of a file or stream. expected: the content, for the error message.

    Errors: InputError if it is empty; those of `read_whole`.
    """
    data = read_whole(file, max_bytes)
    if not data:
        raise InputError(f"no data found, {expected} expected")
    return data


def read_whole(file: BinaryIO | io.FileIO, max_bytes: int | None) -> bytes:
    """Read all bytes of a file or stream.

    Errors: InputError if it cannot be read, has more than max_bytes, or changes meanwhile: a part of a mesh is often a
    valid mesh.
    """
    try:
        descriptor = _descriptor(file)
        before = None if descriptor is None else stamp(descriptor)
        begin = 0 if before is None else file.tell()
        whole = max_bytes is None and before is not None
        data = file.read() if whole else read_stream(file, None if max_bytes is None else max_bytes + 1)
        after = None if descriptor is None else stamp(descriptor)
    except OSError as error:
        raise unreadable(error) from None
    if max_bytes is not None and len(data) > max_bytes:
        raise too_large(f"more than {max_bytes} bytes", max_bytes)
    if before is not None and len(data) != before.size - begin:
        raise changed(before.size - begin, len(data))
    if before != after:
        raise rewritten()
    return data


def _descriptor(file: BinaryIO | io.FileIO) -> int | None:
    """The descriptor below a stream that passes its bytes unchanged; None for other streams."""
    raw = getattr(file, "raw", file)
    return raw.fileno() if isinstance(raw, io.FileIO) or type(raw).__name__ == "SocketIO" else None


def read_stream(file: BinaryIO | io.FileIO, limit: int | None = None) -> bytes:
    """Read a stream to its end, or up to a number of bytes; a non-blocking stream is polled.

    Errors: InputError for a stream without data that cannot be polled.
    """
    # Piece by piece: Python handles signals only between two reads.
    read = getattr(file, "read1", file.read)
    left, pieces = sys.maxsize if limit is None else limit, []
    while left and (part := read(min(_CHUNK, left)) or _late(file, min(_CHUNK, left))):
        pieces.append(part)
        left -= len(part)
    return b"".join(pieces)


def _late(file: BinaryIO | io.FileIO, most: int) -> bytes:
    """The next data of a non-blocking stream without data at present; empty at its end."""
    descriptor = _descriptor(file)
    if descriptor is None:
        if file.read(1) is None:
            raise InputError("a stream that has nothing to give yet, and does not block", hint="let it block")
        return b""
    if os.get_blocking(descriptor) and os.isatty(descriptor):  # on a terminal Ctrl-D ends one read only
        return b""
    while True:
        wait_for(descriptor, "read")
        try:
            return os.read(descriptor, most)
        except BlockingIOError:
            continue


def inflate(data: bytes, max_bytes: int | None) -> bytes:
    """Inflate gzip data.

    Errors: DamagedError if they are damaged, InputError if they inflate to more than max_bytes (without it: 64 MiB and
    100 times the compressed size, more than any mesh needs).
    """
    limit = max_bytes if max_bytes is not None else free_inflation(len(data))
    pieces: list[bytes] = []
    total = 0
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            while part := file.read(min(_CHUNK, limit + 1 - total)):
                pieces.append(part)
                total += len(part)
                if total > limit:
                    raise too_large(f"gzip data that inflate to more than {limit} bytes", limit)
    except (OSError, EOFError, zlib.error) as error:
        raise DamagedError(f"damaged gzip data found ({error})") from None
    return b"".join(pieces)


def free_inflation(size: int) -> int:
    """Default limit in bytes for the inflated size of so many compressed bytes: more than any mesh or table needs."""
    return _FREE_INFLATION + _INFLATION * size


def _irregular(mode: int, path: str | bytes | os.PathLike[Any]) -> InputError:
    kinds = ((stat.S_ISDIR, "directory"), (stat.S_ISFIFO, "named pipe"), (stat.S_ISSOCK, "socket"))
    kind = next((name for test, name in kinds if test(mode)), "device")
    hint = of_folder(os.fsdecode(path)) if kind == "directory" else "`-` reads a stream from standard input"
    return InputError(f"a {kind} found, a regular file expected", hint=hint)


def too_large(what: str, limit: int) -> InputError:
    """The message for an input above a size limit."""
    return InputError(f"{what} found, at most {limit} allowed", hint="--max-bytes sets the limit")
