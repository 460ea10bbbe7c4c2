"""Outcome of a mesh: the status, the exit code and the one line in its row."""

from __future__ import annotations

import signal

from ..errors import INPUT, INTERNAL, OUTPUT, InputError, OutputError, UsageError, defect
from ..support.memory import is_out_of_memory
from ..support.words import escape_text
from .model import Limits, Row, Status


def explained(path: str, error: BaseException, limits: Limits) -> Row:
    """Row of a mesh whose analysis raised an error; a limit set by the user is an error of the mesh, not of curvcli."""
    if is_out_of_memory(error):
        allowed = limits.memory is not None
        text = (
            f"{path}: needs more memory than --max-memory allows; raise the limit"
            if allowed
            else f"{path}: out of memory; use a machine with more memory or fewer jobs at once (-j)"
        )
        return Row(path=path, status="out_of_memory", exit_code=INPUT if allowed else INTERNAL, error=text)
    match error:
        case InputError() | UsageError():
            text = str(error)
            code = INPUT
        case OutputError():
            text, code = str(error), OUTPUT
        case _:
            text, code = defect(error), INTERNAL
    named = text if text.startswith(f"{path}:") or code == OUTPUT else f"{path}: {text}"
    return Row(path=path, status="error", exit_code=code, error=escape_text(" ".join(named.split("\n"))))


def lost(path: str, returncode: int, limits: Limits, *, late: bool) -> Row:
    """Row of a mesh whose worker was stopped for taking too long, or died."""
    status: Status
    if late:
        status, code = "timeout", INPUT
        text = f"takes longer than the {limits.seconds:g} s allowed; --timeout sets the limit"
    elif returncode < 0:
        status, code = "crashed", INTERNAL
        hint = "; out of memory? try fewer jobs at once (-j)" if -returncode == _KILL else ""
        text = f"the worker was ended by {_signal(-returncode)}{hint}"
    else:
        status, code = "crashed", INTERNAL
        text = f"the worker ended with exit code {returncode}"
    return Row(path=path, status=status, exit_code=code, error=f"{path}: {text}")


_KILL = getattr(signal, "SIGKILL", -1)


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
