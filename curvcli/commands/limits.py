"""Limits of time and memory for a command: a parent process watches a child that does the work."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from functools import wraps
from typing import Any, NoReturn

import click

from ..errors import INTERNAL, InputError, UsageError
from ..loading.libraries import import_libraries, start_polars
from ..support.memory import limit_address_space
from ..support.sinks import wait_for
from . import options, signals
from .talk import say

# Seconds for a child that got the signal to end to remove unfinished files.
_GRACE = 3.0


def bounded(command: Callable[..., Any]) -> Callable[..., Any]:
    """A command with --timeout and --max-memory."""

    @options.timeout
    @options.max_memory
    @wraps(command)
    def run(*arguments: Any, timeout: float | None, max_memory: int | None, **settings: Any) -> Any:
        if timeout is not None or max_memory is not None:
            guard(timeout, max_memory)
        return command(*arguments, **settings)

    return run


def guard(timeout: float | None, max_memory: int | None) -> None:
    """Continue in a child, limited to so many seconds and MB beyond the program's own memory; the parent waits.

    The parent does not return: it ends with the child's exit code. Errors: UsageError where the system cannot keep a
    bound; in the parent, InputError where the child has reached one.
    """
    if not hasattr(os, "fork"):
        raise UsageError("--timeout, --max-memory: only a system that forks keeps bounds")
    if max_memory is not None and not sys.platform.startswith("linux"):
        raise UsageError("--max-memory: only Linux bounds the memory of a process")
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    ends, held = os.pipe()  # held open by the child until it ends
    child = os.fork()
    if child:
        os.close(held)
        _watch(child, ends, timeout, max_memory)
    os.close(ends)
    signals.adopt()
    if max_memory is not None:
        # Before the limit is set: it does not count these modules.
        import_libraries()
        start_polars()
        limit_address_space(max_memory << 20)


def _watch(child: int, ends: int, timeout: float | None, max_memory: int | None) -> NoReturn:
    """Wait for the child and exit with its code."""
    try:
        late = not wait_for(ends, "read", timeout)
    except BaseException:
        _end(child, ends)
        raise
    if late:
        _end(child, ends)
        raise InputError(f"takes longer than the {timeout:g} s allowed", hint="--timeout sets the limit")
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if code >= 0:
        raise click.exceptions.Exit(code)
    if max_memory is not None and -code in (signal.SIGKILL, signal.SIGABRT, signal.SIGSEGV, signal.SIGBUS):
        raise InputError("needs more memory than --max-memory allows", hint="raise the limit")
    say(f"internal error: the process at work was ended by {signal.Signals(-code).name}")
    raise click.exceptions.Exit(INTERNAL)


def _end(child: int, ends: int) -> None:
    os.kill(child, signal.SIGTERM)
    if not wait_for(ends, "read", _GRACE):
        os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
