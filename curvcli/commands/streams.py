"""The three standard streams, also where the parent closed one of them or nothing more goes into it."""

from __future__ import annotations

import errno
import io
import os
import sys

# What stdout says of a full or lost disk, or of having been closed by the parent.
_REFUSALS = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF}


def complete() -> None:
    """Open what the parent closed, so that no other file becomes stdout by taking its number.

    stdin is empty then, stderr forgets; stdout refuses, so that nobody believes to have written what is lost. Letters
    that a stream's encoding lacks are escaped: a terminal of ASCII gets its summary too.
    """
    for number, name, flags in ((0, "stdin", os.O_RDONLY), (1, "stdout", os.O_RDONLY), (2, "stderr", os.O_WRONLY)):
        if getattr(sys, name) is None:
            found = os.open(os.devnull, flags)
            if found != number:
                os.dup2(found, number)
                os.close(found)
            setattr(sys, name, open(number, "w" if number else "r", closefd=False))  # noqa: SIM115
        stream = getattr(sys, name)
        if number and isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def refused(error: BaseException) -> bool:
    """Whether an error that nobody explained is stdout's: files explain theirs where they are opened."""
    return isinstance(error, OSError) and error.filename is None and error.errno in _REFUSALS


def settle() -> None:
    """Write what stdout still holds, or forget it, so that Python has nothing to complain about at its exit."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
