"""Signals that ask for the end unwind the program, so that it leaves nothing half-written behind."""

from __future__ import annotations

import os
import signal
import time
from types import FrameType

# Ctrl-C, `kill` and `timeout`, a terminal that is closed; not all of them exist everywhere.
_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")

# The same wish is often told twice at once: by a terminal to the whole group and by a parent to its child.
_ONE_WISH = 1.0


class Ending:
    """The wish to end: raised as KeyboardInterrupt wherever the program is, and remembered here.

    A library may catch what is raised within a callback and raise something of its own; `number` still tells.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self._process, self._at = os.getpid(), 0.0

    @property
    def code(self) -> int:
        """The exit code that shells give a process which a signal ended."""
        return 128 + (self.number or signal.SIGINT)

    def expect(self) -> None:
        """Listen, except to signals that the parent chose to have ignored, as nohup does."""
        for number in _numbers():
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                signal.signal(number, self._unwind)

    def too_late(self) -> None:
        """The work is done: nothing can be interrupted any more, and Python may end in peace."""
        for number in _numbers():
            signal.signal(number, signal.SIG_IGN)

    def _unwind(self, number: int, frame: FrameType | None) -> None:
        if os.getpid() != self._process:  # a child that was forked and is not ours to unwind
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
            return
        now = time.monotonic()
        again = self.number is not None and now - self._at < _ONE_WISH
        self.number = self.number or number
        if not again:
            self._at = now
            raise KeyboardInterrupt


def _numbers() -> list[signal.Signals]:
    return [signal.Signals[name] for name in _NAMES if hasattr(signal, name)]
