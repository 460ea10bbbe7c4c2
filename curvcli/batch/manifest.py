"""Manifest: one line of JSON per mesh, on the disk as soon as the mesh ends."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from types import TracebackType

import msgspec

from ..errors import OutputError
from ..support.words import escape_text
from .model import MANIFEST as NAME
from .model import Row


class Manifest:
    """The manifest of a folder, open for one batch: `rows` of earlier runs by path, `append`, and what was `added`.

    resume: keep the rows and overwrite a line torn off by the end of an earlier run. Without it and without
    `force` the folder must be empty or new.
    Errors: OutputError for a folder with other files, that cannot be written, or that another batch uses.
    """

    def __init__(self, folder: str, *, resume: bool = False, force: bool = False):
        self.path = os.path.join(folder, NAME)
        with _explained(folder):
            os.makedirs(folder, exist_ok=True)
            _check(folder, resume, force)
            descriptor = os.open(self.path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666)
            self._stream = os.fdopen(descriptor, "r+b", buffering=0)
            try:
                self._lock()
                whole, self.rows = self._read(0) if resume else (0, {})
                self._begin = whole
                if whole < self._stream.seek(0, os.SEEK_END):
                    self._stream.truncate(whole)
                self._stream.seek(whole)
            except BaseException:
                self._stream.close()
                raise

    def __enter__(self) -> Manifest:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._stream.close()

    def append(self, row: Row) -> None:
        """Write a row to the disk."""
        # One write, so that a line is whole or torn, never mixed; on a full disk a part of it may be written.
        rest = memoryview(msgspec.json.encode(row) + b"\n")
        with _explained(self.path):
            while rest:
                rest = rest[self._stream.write(rest) :]
            os.fsync(self._stream.fileno())

    def added(self) -> dict[str, Row]:
        """Rows of this batch as they are on the disk, unaffected by an interruption."""
        return self._read(self._begin)[1]

    def _read(self, begin: int) -> tuple[int, dict[str, Row]]:
        """End of the last whole line, and the rows from here to there; the last row of each mesh counts."""
        self._stream.seek(begin)
        content = self._stream.read()
        end = content.rfind(b"\n") + 1
        rows = {}
        for line in content[:end].splitlines():
            # A line damaged by a failing disk is skipped, and its mesh is done again.
            with contextlib.suppress(msgspec.MsgspecError, UnicodeDecodeError):
                row = msgspec.json.decode(line, type=Row)
                rows[row.path] = row
        return begin + end, rows

    def _lock(self) -> None:
        with contextlib.suppress(ImportError):
            import fcntl

            try:
                fcntl.flock(self._stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise OutputError(f"{escape_text(self.path)}: another batch is writing it; wait for its end") from None


def _check(folder: str, resume: bool, force: bool) -> None:
    there = os.listdir(folder)
    if resume and there and NAME not in there and not force:
        raise OutputError(f"{escape_text(folder)}: is not empty and has no {NAME} to resume; choose another folder")
    if there and not resume and not force:
        raise OutputError(f"{escape_text(folder)}: is not empty; --resume continues there, --force starts again")


@contextlib.contextmanager
def _explained(path: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OutputError(f"{escape_text(path)}: cannot be written: {error.strerror or error}") from error
