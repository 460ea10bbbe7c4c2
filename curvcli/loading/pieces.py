"""Bytes of a mesh in consecutive pieces, so that a parser needs no memory for the whole file."""

from __future__ import annotations

import hashlib
import io
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType

from .file_state import Stamp, changed, rewritten, stamp, unreadable

_BUFFERS = 3  # one is read or parsed, the others are hashed


class Pieces:
    """The bytes of a regular file, or of data in memory, read once from first to last.

    size: number of bytes. left: number of bytes not yet taken. hashed: compute the hash, in another thread.
    Errors: InputError where the file cannot be read, or changes meanwhile.
    """

    piece = 1 << 21
    """The most bytes to be taken of a file at once: they stay in the cache of a core until parsed and hashed."""
    window = 1 << 16
    """The most bytes to be seen ahead."""

    def __init__(self, source: io.FileIO | bytes, *, hashed: bool = True) -> None:
        self._data, self._at = b"", 0
        self._file: io.FileIO | None = None
        self._stamp: Stamp | None = None
        self._buffers: deque[tuple[bytearray, Future[None] | None]] = deque()
        self._hash = hashlib.sha256()
        self._hashing = ThreadPoolExecutor(1) if hashed else None
        if isinstance(source, bytes):
            self._data, self.size = source, len(source)
            self._add_to_hash(source)
        else:
            self._file, self._stamp = source, _stamp(source)
            self.size = self._stamp.size if self._stamp is not None else 0
        self.left = self.size

    def __enter__(self) -> Pieces:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._hashing is not None:
            self._hashing.shutdown(cancel_futures=True)

    @property
    def longest(self) -> int:
        """Largest number of bytes to take at once: all of data in memory, `piece` of a file."""
        return self.left if self._file is None else self.piece

    def ahead(self) -> bytes:
        """Peek at the next bytes, up to `window`, without taking them."""
        if self._file is None:
            return self._data[self._at : self._at + self.window]
        data = bytearray(min(self.window, self.left))
        at = self._file.tell()
        self._fill(memoryview(data))
        self._file.seek(at)
        return bytes(data)

    def take(self, count: int) -> memoryview:
        """Take exactly so many of the next bytes; they stay valid until two more pieces are taken."""
        self.left -= count
        if self._file is None:
            self._at += count
            return memoryview(self._data)[self._at - count : self._at]
        buffer = self._buffer(count)
        piece = memoryview(buffer)[:count]
        self._fill(piece)
        self._buffers.append((buffer, self._add_to_hash(piece)))
        return piece

    def back(self, piece: memoryview) -> None:
        """Return the last piece, to take it again; the rest of the file is read into memory."""
        if self._file is None:
            self._at -= len(piece)
        else:
            self._data = b"".join((piece, self._read_all(self.left)))
        self.left += len(piece)

    def whole(self) -> bytes:
        """Read the rest into memory without taking it."""
        if self._file is not None:
            self._data = self._read_all(self.left)
        elif self._at:
            self._data, self._at = self._data[self._at :], 0
        return self._data

    def rest(self) -> bytes:
        """Take the rest."""
        data = self.whole()
        self._at, self.left = len(data), 0
        return data

    def check(self) -> None:
        """Raise InputError if the file has changed since it was opened, unless it was read completely."""
        now = None if self._file is None else _stamp(self._file)
        if now is not None and now.size != self.size:
            raise changed(self.size, now.size)
        if now is not None and now != self._stamp:
            raise rewritten()

    def sha256(self) -> str:
        """The hash of all bytes, taken or not; reads a file to its end and checks that it has not changed."""
        if self._file is not None:
            self.whole()
        assert self._hashing is not None
        self._hashing.shutdown()
        return self._hash.hexdigest()

    def _buffer(self, count: int) -> bytearray:
        """A buffer for a piece; buffers rotate, so that earlier pieces can still be parsed and hashed."""
        if len(self._buffers) < _BUFFERS:
            return bytearray(max(count, min(self.piece, self.left)))
        buffer, hashed = self._buffers.popleft()
        if hashed is not None:
            hashed.result()
        return buffer

    def _fill(self, piece: memoryview) -> None:
        assert self._file is not None
        begin = self._file.tell()
        read = 0
        try:
            while read < len(piece):
                more = self._file.readinto(piece[read:])
                if not more:
                    raise changed(self.size, begin + read)
                read += more
        except OSError as error:
            raise unreadable(error) from None

    def _read_all(self, expected: int) -> bytes:
        assert self._file is not None
        try:
            data = self._file.read()
        except OSError as error:
            raise unreadable(error) from None
        if len(data) != expected:
            raise changed(self.size, self.size - expected + len(data))
        self.check()
        self._file = None
        self._add_to_hash(data)
        return data

    def _add_to_hash(self, data: bytes | memoryview) -> Future[None] | None:
        return None if self._hashing is None else self._hashing.submit(self._hash.update, data)


def _stamp(file: io.FileIO) -> Stamp | None:
    try:
        return stamp(file.fileno())
    except OSError as error:
        raise unreadable(error) from None
