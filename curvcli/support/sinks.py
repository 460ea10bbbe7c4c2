"""Where bytes go out: a stream takes everything it is given, or says that it cannot."""

from __future__ import annotations

import io
import os
from typing import Any, BinaryIO, TextIO

from ..errors import OutputError

# Seconds in all that a run waits for a stderr that takes no more: an error is told by the exit code too.
_PATIENCE = 1.0


class Sink(io.RawIOBase):
    """A descriptor that is written to the last byte: short writes are continued, a full pipe is waited for.

    A pipe that nobody reads any more takes everything from then on, so that its writer keeps its verdict and its other
    outputs. name: what a refusal calls it; `failure` is the first one.
    Errors: OutputError where the system refuses to write; once, and what follows is forgotten.
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
        """Write all of it; the number of bytes given."""
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
        """Take what comes from now on and write none of it."""
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
    """stderr: what cannot be told is forgotten, for it must not end the work."""

    _left = _PATIENCE

    def _refuse(self, error: OSError) -> None:
        """The next line may be told again."""

    def _wait(self) -> bool:
        begin = _now()
        ready = self._left > 0 and wait_for(self._descriptor, "write", self._left)
        self._left -= _now() - begin
        return ready


def wait_for(descriptor: int, to: str, seconds: float | None = None) -> bool:
    """Wait until a descriptor can be read or written without blocking; whether it can, after so many seconds at most.

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
    """A stream of text on the same descriptor that writes all; the same stream where it has none.

    Letters that its encoding lacks are escaped: a terminal of ASCII gets its summary too.
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
    """The bytes of a stream of text, written whole whoever made it."""
    stream.flush()
    buffer = stream.buffer
    if isinstance(getattr(buffer, "raw", None), Sink):
        return buffer
    try:
        return io.BufferedWriter(Sink(stream.fileno(), "stdout"))
    except (OSError, ValueError):  # a stream in memory
        return buffer
