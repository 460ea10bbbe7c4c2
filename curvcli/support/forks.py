"""Threads of polars that a fork does not inherit: what needs them would wait for ever in the child."""

from __future__ import annotations

import os
import sys

from ..errors import UsageError

# How the threads are called that work for polars once it has been used; importing it begins none of these.
_WORKERS = ("polars-", "async-exec", "tokio-rt")
_IMPORTED = "polars-ooc"

_begun = _lost = False


def threads_lost() -> bool:
    """Whether this process was forked from one in which polars had begun its threads.

    What a single column does, such as casting it, needs none of them; tables, their files and expressions do.
    """
    return _lost


def require_threads() -> None:
    """Errors: UsageError in a process that lacks them."""
    if _lost:
        raise UsageError(
            "Parquet and stored tables need threads of polars, which a fork does not inherit; start the process by "
            "`spawn` or `forkserver` (multiprocessing.set_start_method), or write .csv, .npz or .json"
        )


def _before_fork() -> None:
    global _begun
    _begun = not _lost and "polars" in sys.modules and _works()


def _works() -> bool:
    """Whether threads of polars are at work; taken for granted where the system does not tell."""
    try:
        threads = os.listdir("/proc/self/task")
    except OSError:
        return True
    names = []
    for thread in threads:
        try:
            with open(f"/proc/self/task/{thread}/comm", encoding="utf-8", errors="replace") as stream:
                names.append(stream.read())
        except OSError:  # it has ended
            continue
    return any(name.startswith(_WORKERS) and not name.startswith(_IMPORTED) for name in names)


def _after_fork() -> None:
    global _lost
    _lost = _lost or _begun


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_before_fork, after_in_child=_after_fork)
