"""Signals that ask for the end unwind the program, so that it leaves nothing half-written behind."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from types import FrameType

Handler = Callable[[int, FrameType | None], None]

# Ctrl-C, `kill` and `timeout`, a terminal that is closed; not all of them exist everywhere.
_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")

# The same wish is often told twice at once: by a terminal to the whole group and by a parent to its child.
_ONE_WISH = 1.0

# Imports are waited for, looked at so often, and not longer than this; all in seconds.
_SOON, _PATIENCE = 0.01, 5.0


_endings: list[Ending] = []


def adopt() -> None:
    """Listen in a child that was forked to do the work; its parent says what is to be said of a signal."""
    for ending in _endings:
        ending.adopted, ending._process = True, os.getpid()


class Ending:
    """The wish to end: raised as KeyboardInterrupt wherever the program is, and remembered here.

    A library may catch what is raised within a callback and raise something of its own; `number` still tells.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self.adopted = False
        self._process, self._at, self._delayed = os.getpid(), 0.0, False
        _endings.append(self)

    @property
    def code(self) -> int:
        """The exit code that shells give a process which a signal ended."""
        return 128 + (self.number or signal.SIGINT)

    def expect(self, early: Handler | None = None) -> None:
        """Listen, in the place of an earlier handler, but not to signals that the parent has ignored, as nohup does."""
        for number in _numbers():
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler, early or signal.SIG_DFL):
                signal.signal(number, self._hear)

    def too_late(self) -> None:
        """The work is done: nothing can be interrupted any more, and Python may end in peace."""
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
        if os.getpid() != self._process:  # a child that was forked and is not ours to unwind
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
            return
        now = time.monotonic()
        if self.number is None or now - self._at >= _ONE_WISH:
            self.number, self._at = self.number or number, now
            self._unwind(number, frame)

    def _unwind(self, number: int, frame: FrameType | None) -> None:
        # An exception amid an import can leave its lock held, and a thread that needs that module would wait for ever.
        if _imports(frame) and hasattr(signal, "setitimer") and time.monotonic() - self._at < _PATIENCE:
            self._delayed = True
            signal.signal(signal.SIGALRM, self._unwind)
            signal.setitimer(signal.ITIMER_REAL, _SOON)
            return
        raise KeyboardInterrupt


def _imports(frame: FrameType | None) -> bool:
    """Whether what runs there is part of an import."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _numbers() -> list[signal.Signals]:
    return [signal.Signals[name] for name in _NAMES if hasattr(signal, name)]
