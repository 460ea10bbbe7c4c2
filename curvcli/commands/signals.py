"""Signal handling: on SIGINT, SIGTERM or SIGHUP, unwind so that no output is left half-written."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from types import FrameType

Handler = Callable[[int, FrameType | None], None]

# Ctrl-C, `kill` and `timeout`, a closed terminal; not all of them exist everywhere.
_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")

# Often two signals arrive for one event: from a terminal to the whole group and from a parent to its child.
_ONE_WISH = 1.0

# Interval and limit of the wait for imports, in seconds.
_SOON, _PATIENCE = 0.01, 5.0


_endings: list[Ending] = []


def adopt() -> None:
    """Listen in a forked child that does the work; the parent prints the message about a signal."""
    for ending in _endings:
        ending.adopted, ending._process = True, os.getpid()


class Ending:
    """State of a signal that ends the program: raised as KeyboardInterrupt, and stored here.

    A library may replace an exception raised within a callback by one of its own; `number` stays.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self.adopted = False
        self._process, self._at, self._delayed = os.getpid(), 0.0, False
        _endings.append(self)

    @property
    def code(self) -> int:
        """Exit code that shells give a process ended by this signal."""
        return 128 + (self.number or signal.SIGINT)

    def expect(self, early: Handler | None = None) -> None:
        """Install the handlers in place of an earlier one, but not for signals that the parent ignores (nohup)."""
        for number in _numbers():
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler, early or signal.SIG_DFL):
                signal.signal(number, self._hear)

    def too_late(self) -> None:
        """Ignore signals once the work is done, so that Python can shut down."""
        while True:
            try:
                for number in _numbers():
                    signal.signal(number, signal.SIG_IGN)
                if self._delayed:
                    signal.setitimer(signal.ITIMER_REAL, 0)
                return
            except KeyboardInterrupt:  # just in time
                continue

    def _hear(self, number: int, frame: FrameType | None) -> None:
        if os.getpid() != self._process:  # a forked child, which must not unwind
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
            return
        now = time.monotonic()
        if self.number is None or now - self._at >= _ONE_WISH:
            self.number, self._at = self.number or number, now
            self._unwind(number, frame)

    def _unwind(self, number: int, frame: FrameType | None) -> None:
        # An exception amid an import can leave its lock held, and a thread that needs the module would wait for ever.
        if _imports(frame) and hasattr(signal, "setitimer") and time.monotonic() - self._at < _PATIENCE:
            self._delayed = True
            signal.signal(signal.SIGALRM, self._unwind)
            signal.setitimer(signal.ITIMER_REAL, _SOON)
            return
        raise KeyboardInterrupt


def _imports(frame: FrameType | None) -> bool:
    """True if a frame belongs to an import."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _numbers() -> list[signal.Signals]:
    return [signal.Signals[name] for name in _NAMES if hasattr(signal, name)]
