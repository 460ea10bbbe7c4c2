"""States of an open file, and the errors for a file that changes or cannot be read."""

from __future__ import annotations

import errno
import os
import stat
import time
from typing import NamedTuple

from ..errors import InputError


class Stamp(NamedTuple):
    """State of a regular file, different after a change: the times are those of its content and of its inode."""

    device: int
    inode: int
    size: int
    written: int
    recorded: int


def stamp(descriptor: int) -> Stamp | None:
    """The state of an open file, for comparison after reading; None unless it is a regular file.

    File times have ticks: a second change within the tick of the last one is invisible, so the end of the tick is
    waited for.
    """
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        return None
    if hasattr(time, "CLOCK_REALTIME_COARSE"):
        tick = time.clock_getres(time.CLOCK_REALTIME_COARSE)
        while -tick < (old := time.clock_gettime(time.CLOCK_REALTIME_COARSE) - status.st_ctime_ns / 1e9) < tick:
            time.sleep(tick - old)
    return Stamp(status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)


def changed(expected: int, read: int) -> InputError:
    """The error for a file whose size has changed."""
    return InputError(f"{expected} bytes expected, {read} read: the file changed while it was read")


def rewritten() -> InputError:
    """The error for a file that was replaced during reading."""
    return InputError("the file changed while it was read", hint="read it again once its writer is done")


def unreadable(error: OSError | ValueError) -> InputError:
    """The error for an operating-system error."""
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
