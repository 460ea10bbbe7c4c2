"""Enough memory, asked for before libraries are called that would abort the process instead of raising MemoryError."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import suppress

# Address space that polars' threads and its allocator reserve before they hold a byte of data: at first, and later.
_FIRST_USE, _LATER_USE, _STACK = 5 << 27, 3 << 26, 1 << 23

# Address space without which importing numpy ends in an abort or in an endless wait of its BLAS.
NUMPY = 1 << 28

# What libraries say when there is none left, in exceptions of many types.
_WORDS = (
    "can't start new thread",
    "cannot allocate memory",
    "failed to map segment",
    "unable to allocate",
    "out of memory",
)


def require(size: int) -> None:
    """Errors: MemoryError unless this many more bytes can be had within the process's own limit and the machine's."""
    free = available()
    if free is not None and free < size:
        raise MemoryError


def require_polars(data: int) -> None:
    """Errors: MemoryError unless polars can work on this many bytes of data."""
    global _used
    require((_LATER_USE if _used else _FIRST_USE + (os.cpu_count() or 1) * _STACK) + 2 * data)
    _used = "polars" in sys.modules


_used = False


def limit_address_space(memory: int) -> None:
    """Bound the address space of this process at its present size and this much more."""
    global _bounded
    with contextlib.suppress(ImportError, OSError):
        import resource

        limit = address_space() + memory
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        _bounded = True


def is_bounded() -> bool:
    """Whether `bound` has done so."""
    return _bounded


_bounded = False


def is_out_of_memory(error: BaseException) -> bool:
    """Whether an exception, or one that led to it, means that there was no memory left.

    Under a limit a thread cannot start, a library cannot be mapped, an import fails, each in its own words; extensions
    that do not look at what they were given leave Python with a SystemError, and its import system stumbles.
    """
    return any(
        isinstance(one, MemoryError)
        or (isinstance(one, OSError) and one.errno == errno.ENOMEM)
        or ((isinstance(one, SystemError) or _within_an_import(one)) and limited())
        or any(words in str(one).lower() for words in _WORDS)
        for one in _causes(error)
    )


def _within_an_import(error: BaseException) -> bool:
    """Whether it was raised by Python's own import system."""
    frames = list(traceback.walk_tb(error.__traceback__))
    return bool(frames) and frames[-1][0].f_code.co_filename.startswith("<frozen importlib")


def _causes(error: BaseException) -> Iterator[BaseException]:
    """The exception and those that it was raised from or while handling."""
    one: BaseException | None = error
    seen: set[int] = set()
    while one is not None and id(one) not in seen:
        seen.add(id(one))
        yield one
        one = one.__cause__ or one.__context__


def limited() -> bool:
    """Whether the address space of this process has a limit."""
    try:
        import resource
    except ImportError:
        return False
    return resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY


def trim_heap() -> None:
    """Return freed memory to the system where the address space is limited, so that other allocators can have it.

    The command keeps freed memory in its heap, where numpy finds it again but polars and the imports do not.
    """
    if limited() and sys.platform.startswith("linux"):
        import ctypes

        with suppress(AttributeError, OSError):  # a C library of another kind
            ctypes.CDLL(None).malloc_trim(0)


def address_space() -> int:
    """Bytes of address space that this process has reserved. Errors: OSError where the system does not tell."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")


def available() -> int | None:
    """Bytes that this process can still allocate; None where the system does not tell."""
    try:
        import resource

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        used = address_space()
        with open("/proc/meminfo", encoding="ascii") as stream:
            known = dict(line.split(":") for line in stream)
        free = int(known["MemAvailable"].split()[0]) * 1024 + int(known["SwapFree"].split()[0]) * 1024
    except (ImportError, OSError, KeyError, ValueError):
        return None
    return free if limit == resource.RLIM_INFINITY else min(free, limit - used)
