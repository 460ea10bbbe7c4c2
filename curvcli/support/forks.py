"""Detection of forked processes without polars' threads, in which polars would wait for ever."""

from __future__ import annotations

import os
import sys

from ..errors import UsageError

# Name prefixes of the threads that polars starts at its first use; importing polars starts none of them.
_WORKERS = ("polars-", "async-exec", "tokio-rt")
_IMPORTED = "polars-ooc"

_begun = _lost = False


def threads_lost() -> bool:
    """Test for a process forked from one in which polars had started its threads.

    Operations on a single column, such as a cast, need no threads; tables, their files and expressions do.
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
    """Test for running threads of polars; True where /proc is missing."""
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
