"""The bytes of a file: regular files only, read once, inflated within limits."""

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

_CHUNK = 1 << 24
_FREE_INFLATION = 1 << 26
_INFLATION = 100


def open_regular(path: str | bytes | os.PathLike[Any], max_bytes: int | None) -> io.FileIO:
    """The file, opened for reading without a buffer, if it is a regular one.

    Errors: InputError for what is missing, unreadable, too large, or no regular file; no FIFO or device is waited for.
    """
    flags = os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            raise _irregular(os.stat(path).st_mode)
        descriptor = os.open(path, flags)
    except (OSError, ValueError) as error:
        raise unreadable(error) from None
    file = io.FileIO(descriptor)
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        file.close()
        raise _irregular(status.st_mode)
    if max_bytes is not None and status.st_size > max_bytes:
        file.close()
        raise _too_large(f"{status.st_size} bytes", max_bytes)
    return file


def read_limited(file: BinaryIO | io.FileIO, max_bytes: int | None) -> bytes:
    """All bytes of a file or stream.

    Errors: InputError if it cannot be read, is empty, holds more than max_bytes, or is a file that changes its size
    meanwhile: a part of a mesh is often a mesh.
    """
    try:
        begin = file.tell() if file.seekable() else 0
        before = _size(file, begin)
        whole = max_bytes is None and before is not None
        data = file.read() if whole else _read_up_to(file, sys.maxsize if max_bytes is None else max_bytes + 1)
        after = _size(file, begin)
    except OSError as error:
        raise unreadable(error) from None
    if max_bytes is not None and len(data) > max_bytes:
        raise _too_large(f"more than {max_bytes} bytes", max_bytes)
    if not data:
        raise InputError("no data found, a mesh expected")
    if before is not None and not before == after == len(data):
        raise changed(before, len(data))
    return data


def _size(file: BinaryIO | io.FileIO, begin: int = 0) -> int | None:
    """How much of a regular file there is from a place on; None for other streams."""
    try:
        status = os.fstat(file.fileno())
    except OSError:
        return None
    return status.st_size - begin if stat.S_ISREG(status.st_mode) else None


def _read_up_to(file: BinaryIO | io.FileIO, limit: int) -> bytes:
    # Piece by piece as they come: only between them does Python hear of a signal before it waits again.
    read = getattr(file, "read1", file.read)
    parts = []
    while limit and (part := read(min(_CHUNK, limit))):
        parts.append(part)
        limit -= len(part)
    return b"".join(parts)


def inflate(data: bytes, max_bytes: int | None) -> bytes:
    """The content of gzip data.

    Errors: InputError if they are damaged, or inflate to more than max_bytes (without it: 64 MiB and 100 times the
    compressed size, more than any mesh needs).
    """
    limit = max_bytes if max_bytes is not None else _FREE_INFLATION + _INFLATION * len(data)
    parts: list[bytes] = []
    total = 0
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            while part := file.read(min(_CHUNK, limit + 1 - total)):
                parts.append(part)
                total += len(part)
                if total > limit:
                    raise _too_large(f"gzip data that inflate to more than {limit} bytes", limit)
    except (OSError, EOFError, zlib.error) as error:
        raise InputError(f"damaged gzip data found ({error})") from None
    return b"".join(parts)


def changed(expected: int, read: int) -> InputError:
    """What is said of a file that is not as long as it was."""
    return InputError(f"{expected} bytes expected, {read} read: the file changed while it was read")


def unreadable(error: OSError | ValueError) -> InputError:
    """What is said of a file that the system does not give."""
    return InputError(_reason(error))


def _reason(error: OSError | ValueError) -> str:
    match getattr(error, "errno", None):
        case errno.ENOENT | errno.ENOTDIR:
            return "no such file"
        case errno.EACCES | errno.EPERM:
            return "the file may not be read (permission denied)"
        case errno.ELOOP:
            return "the link leads in a circle"
        case None:
            return f"not a file name ({error})"
        case _:
            return f"the file cannot be read ({os.strerror(error.errno or 0)})"  # type: ignore[union-attr]


def _irregular(mode: int) -> InputError:
    kinds = ((stat.S_ISDIR, "directory"), (stat.S_ISFIFO, "named pipe"), (stat.S_ISSOCK, "socket"))
    kind = next((name for test, name in kinds if test(mode)), "device")
    return InputError(f"a {kind} found, a regular file expected", hint="`-` reads a stream from standard input")


def _too_large(found: str, limit: int) -> InputError:
    return InputError(f"{found} found, at most {limit} allowed", hint="--max-bytes sets the limit")
