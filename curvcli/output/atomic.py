"""Atomic outputs: checked before any work, written to temporaries, renamed at the end."""

from __future__ import annotations

import contextlib
import errno
import io
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from threading import Lock
from types import TracebackType
from typing import BinaryIO

from ..errors import OutputError
from ..support.sinks import Sink, binary_sink
from ..support.words import escape_text
from .destinations import STDOUT, Place, beside, probe, resolve, same_file, stream_number

# Errors of link() where hard links are unknown or not allowed; every other error is a failure.
_NO_HARD_LINKS = {errno.EPERM, errno.EACCES, errno.EOPNOTSUPP, errno.ENOTSUP, errno.ENOSYS, errno.EMLINK, errno.EXDEV}


@dataclass
class _Target:
    """One output: its name, the file behind it, and its temporary while there is one."""

    path: str
    place: Place
    temporary: str | None = None
    complete: bool = False


class Outputs:
    """All outputs of one run: `with Outputs(paths, force=False) as outputs, outputs.open(path) as stream: ...`.

    Entering checks every path before any work is done. Each regular file is written to a temporary in its own folder;
    only when all are complete are they renamed, one after the other. An error or an interruption before that removes
    the temporaries and leaves older files unchanged. `-` is stdout; devices and FIFOs are written directly, links are
    followed.

    Files left by a killed program, an interruption or a full disk are whole. With `durable`, contents are on the disk
    before the files get their names, so that a record of them is right after a power cut too.

    Output to a pipe that its reader closed is discarded, and the other outputs are still written.
    Errors: OutputError for a path that exists (without `force`), cannot be written, or is named twice.
    """

    def __init__(self, paths: Iterable[str | os.PathLike[str]], force: bool = False, durable: bool = False):
        self._paths = [os.fspath(path) for path in paths]
        self._force, self._durable = force, durable
        self._targets: dict[str, _Target] = {}
        # A thread that was never joined writes no file after the end.
        self._begin, self._ended = Lock(), False

    def __enter__(self) -> Outputs:
        for path in self._paths:
            with _explained(path):
                self._add(path)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        try:
            if error is None:
                self.commit()
        finally:
            with self._begin:
                self._ended = True
            for target in self._targets.values():
                if target.temporary is not None:
                    with contextlib.suppress(OSError):
                        os.unlink(target.temporary)
                    target.temporary = None

    @contextlib.contextmanager
    def open(self, path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
        """Binary stream of one of the outputs; leaving the block without an error completes it."""
        target = self._targets[os.fspath(path)]
        if target.temporary is not None:
            raise ValueError(f"{target.path}: written already")
        with _explained(target.path):
            if not target.place.direct:
                yield from self._write_beside(target)
            elif stream_number(target.place.final) == 1:
                yield from _write_stdout()
            else:
                yield from _write_directly(target)
        target.complete = True

    def commit(self) -> None:
        """Rename every complete output to its name; a file that appeared meanwhile is replaced only with `force`."""
        for target in self._targets.values():
            if target.complete and target.temporary is not None:
                with _explained(target.path):
                    self._name(target.temporary, target)
                target.temporary = None

    def _add(self, path: str) -> None:
        place = resolve(path)
        for other in self._targets.values():
            if same_file(place, other.place):
                both = escape_text(path) if path == other.path else f"{escape_text(other.path)} and {escape_text(path)}"
                raise OutputError(f"{both}: two outputs on one file; give each a name of its own")
        if not place.direct:
            if os.path.lexists(place.final) and not self._force:
                raise OutputError(f"{escape_text(path)}: exists already; --force overwrites it")
            folder = os.path.dirname(place.final)
            if not os.path.isdir(folder):
                raise OutputError(f"{escape_text(path)}: there is no folder {escape_text(folder)}; make it first")
            probe(folder)
        self._targets[path] = _Target(path, place)

    def _write_beside(self, target: _Target) -> Iterator[BinaryIO]:
        with self._begin:
            if self._ended:
                raise InterruptedError("the outputs are closed")
            # Recorded before it is created, so that an interruption in between cannot leave it behind.
            target.temporary = beside(target.place.final)
            flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
            descriptor = os.open(target.temporary, flags, 0o666)
        with open(descriptor, "w+b") as stream:
            with contextlib.suppress(OSError):
                os.chmod(target.temporary, stat.S_IMODE(os.stat(target.place.final).st_mode) & 0o777)
            yield stream
            if self._durable:
                stream.flush()
                os.fsync(descriptor)

    def _name(self, temporary: str, target: _Target) -> None:
        if self._force:
            os.replace(temporary, target.place.final)
            return
        try:
            # link() fails where rename() would silently replace a file that another program wrote meanwhile.
            os.link(temporary, target.place.final)
        except FileExistsError:
            raise OutputError(
                f"{escape_text(target.path)}: appeared while it was computed; --force overwrites it"
            ) from None
        except OSError as error:
            if error.errno not in _NO_HARD_LINKS:
                raise
            if os.path.lexists(target.place.final):
                raise OutputError(
                    f"{escape_text(target.path)}: appeared while it was computed; --force overwrites it"
                ) from None
            os.replace(temporary, target.place.final)
        else:
            os.unlink(temporary)


@contextlib.contextmanager
def _explained(path: str) -> Iterator[None]:
    """Turn an error of the system into one line that names the output."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(
            f"{'stdout' if path == STDOUT else escape_text(path)}: cannot be written: {reason}"
        ) from error


def _write_stdout() -> Iterator[BinaryIO]:
    if sys.stdout is None:
        raise OutputError("stdout: is closed")
    stream = binary_sink(sys.stdout)
    yield stream
    # Flushed here, not at the end of the program, where a full disk could no longer be reported.
    stream.flush()


def _write_directly(target: _Target) -> Iterator[BinaryIO]:
    """Write to a device, a FIFO, or a stream that is open already."""
    number = stream_number(target.place.final)
    flags = os.O_WRONLY | os.O_CREAT | os.O_TRUNC | getattr(os, "O_BINARY", 0)
    descriptor = os.open(target.place.final, flags, 0o666) if number is None else os.dup(number)
    try:
        with io.BufferedWriter(Sink(descriptor, escape_text(target.path))) as stream:
            yield stream
    finally:
        os.close(descriptor)
