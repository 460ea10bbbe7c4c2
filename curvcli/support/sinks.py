"""Output streams that write all bytes they are given or report an error."""

from __future__ import annotations

import io
import os
from typing import Any, BinaryIO, TextIO

from ..errors import OutputError

# Seconds that a run waits in total for a full stderr; the exit code reports an error as well.
_PATIENCE = 1.0


class Sink(io.RawIOBase):
    """A file descriptor written to the last byte: short writes are continued, a full pipe is waited for.

    Data for a closed pipe are discarded, so that the run keeps its exit code and its other outputs. name: the stream in
    error messages. failure: the first error.
    Errors: OutputError at the first failed write; data written after it are discarded.
    """

    def __init__(self, descriptor: int, name: str) -> None:
        self._descriptor, self.name = descriptor, name
        self.failure: OutputError | None = None
        self._forgets = False

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._descriptor

    def isatty(self) -> bool:
        return os.isatty(self._descriptor)

    def write(self, data: Any, /) -> int:
        """Write all bytes and return their number."""
        rest = memoryview(data).cast("B")
        count = len(rest)
        while rest and not self._forgets:
            try:
                written = os.write(self._descriptor, rest)
            except BlockingIOError:
                written = 0
            except (BrokenPipeError, ConnectionResetError):
                self._forgets = True
                break
            except OSError as error:
                self._refuse(error)
                break
            rest = rest[written:]
            if not written and not self._wait():
                break
        return count

    def forget(self) -> None:
        """Discard all data from now on."""
        self._forgets = True

    def _refuse(self, error: OSError) -> None:
        self._forgets = True
        self.failure = OutputError(f"{self.name}: cannot be written: {error.strerror or error}")
        raise self.failure from error

    def _wait(self) -> bool:
        """Wait until more can be written."""
        wait_for(self._descriptor, "write")
        return True


class StderrSink(Sink):
    """stderr: a failed write is ignored, since a message must not end the run."""

    _left = _PATIENCE

    def _refuse(self, error: OSError) -> None:
        """Ignore the error; the next line is tried again."""

    def _wait(self) -> bool:
        begin = _now()
        ready = self._left > 0 and wait_for(self._descriptor, "write", self._left)
        self._left -= _now() - begin
        return ready


def wait_for(descriptor: int, to: str, seconds: float | None = None) -> bool:
    """Wait until a descriptor can be read or written without blocking; False after a timeout of so many seconds.

    to: `read` or `write`.
    """
    import select

    poll = select.poll()
    poll.register(descriptor, select.POLLIN if to == "read" else select.POLLOUT)
    return bool(poll.poll(None if seconds is None else 1000 * seconds))


def _now() -> float:
    import time

    return time.monotonic()


def text_sink(stream: TextIO, kind: type[Sink] = Sink) -> TextIO:
    """Wrap a text stream in a `Sink` on its descriptor; a stream without a descriptor is returned as it is.

    Characters that its encoding lacks are escaped, so that an ASCII terminal shows the summary too.
    """
    try:
        stream.flush()
        descriptor = stream.fileno()
    except (OSError, ValueError):
        return stream
    return io.TextIOWrapper(
        io.BufferedWriter(kind(descriptor, "stdout"), 1 << 16),
        encoding=stream.encoding,
        errors="backslashreplace",
        line_buffering=getattr(stream, "line_buffering", False),
    )


def binary_sink(stream: TextIO) -> BinaryIO:
    """The binary stream below a text stream, as a `Sink` where it has a descriptor."""
    stream.flush()
    buffer = stream.buffer
    if isinstance(getattr(buffer, "raw", None), Sink):
        return buffer
    try:
        return io.BufferedWriter(Sink(stream.fileno(), "stdout"))
    except (OSError, ValueError):  # a stream in memory
        return buffer
