"""The three standard streams, also where the parent closed one of them or nothing more goes into it."""

from __future__ import annotations

import io
import os
import sys

from ..errors import OutputError
from ..support.sinks import Sink, StderrSink, text_sink


def complete() -> None:
    """Open what the parent closed, so that no other file becomes stdout by taking its number, and have all written.

    stdin is empty then, stderr forgets; stdout refuses, so that nobody believes to have written what is lost. From here
    on every byte that goes to stdout or stderr passes through `curvcli.support.sinks`.
    """
    for number, name, flags in ((0, "stdin", os.O_RDONLY), (1, "stdout", os.O_RDONLY), (2, "stderr", os.O_WRONLY)):
        if getattr(sys, name) is None:
            found = os.open(os.devnull, flags)
            if found != number:
                os.dup2(found, number)
                os.close(found)
            setattr(sys, name, open(number, "w" if number else "r", closefd=False))  # noqa: SIM115
        stream = getattr(sys, name)
        if number and os.name == "posix":
            setattr(sys, name, text_sink(stream, StderrSink if number == 2 else Sink))
        elif number and isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def settle(interrupted: bool) -> OutputError | None:
    """Write what stdout still holds; its refusal where it has refused anything.

    Of an interrupted program it is forgotten: nobody may be there to read it, and nothing interrupts the end.
    """
    raw = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    if interrupted and isinstance(raw, Sink):
        raw.forget()
    try:
        sys.stdout.flush()
    except OutputError as error:
        return error
    return raw.failure if isinstance(raw, Sink) else None
