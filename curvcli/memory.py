"""Enough memory, asked for before libraries are called that would abort the process instead of raising MemoryError."""

from __future__ import annotations

import os

# Address space that polars' threads reserve before they hold a byte of data.
_THREADS = 1 << 29


def require(size: int) -> None:
    """Errors: MemoryError unless this many more bytes can be had within the process's own limit and the machine's."""
    free = available()
    if free is not None and free < size:
        raise MemoryError


def require_polars(data: int) -> None:
    """Errors: MemoryError unless polars can work on this many bytes of data."""
    require(_THREADS + 2 * data)


def available() -> int | None:
    """Bytes that this process can still allocate; None where the system does not tell."""
    try:
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        with open("/proc/self/statm", encoding="ascii") as stream:
            used = int(stream.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
        with open("/proc/meminfo", encoding="ascii") as stream:
            known = dict(line.split(":") for line in stream)
        free = int(known["MemAvailable"].split()[0]) * 1024 + int(known["SwapFree"].split()[0]) * 1024
    except (ImportError, OSError, KeyError, ValueError):
        return None
    return free if limit == resource.RLIM_INFINITY else min(free, limit - used)
