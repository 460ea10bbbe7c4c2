"""Standard streams, including ones that the parent closed or that accept no more data."""

from __future__ import annotations

import io
import os
import sys

from ..errors import OutputError
from ..support.sinks import Sink, StderrSink, text_sink


def complete() -> None:
    """Open streams that the parent closed, so that no other file takes the number of stdout, and route all output.

    A closed stdin is then empty, stderr discards, and stdout refuses, so that lost output is an error. From here on
    every byte for stdout or stderr passes through `curvcli.support.sinks`.
    """
    for number, name, flags in ((0, "stdin", os.O_RDONLY), (1, "stdout", os.O_RDONLY), (2, "stderr", os.O_WRONLY)):
        if getattr(sys, name) is None:
            descriptor = os.open(os.devnull, flags)
            if descriptor != number:
                os.dup2(descriptor, number)
                os.close(descriptor)
            setattr(sys, name, open(number, "w" if number else "r", closefd=False))  # noqa: SIM115
        stream = getattr(sys, name)
        if number and os.name == "posix":
            setattr(sys, name, text_sink(stream, StderrSink if number == 2 else Sink))
        elif number and isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def settle(interrupted: bool) -> OutputError | None:
    """Flush stdout; return its error if a write was refused.

    For an interrupted program the rest is dropped: a reader may be gone, and a write must not block the exit.
    """
    raw = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    if interrupted and isinstance(raw, Sink):
        raw.forget()
    try:
        sys.stdout.flush()
    except OutputError as error:
        return error
    return raw.failure if isinstance(raw, Sink) else None
