"""Memory limits: checks before calls into libraries that abort the process instead of raising MemoryError."""

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

# Messages of libraries that ran out of memory, in exceptions of many types.
_WORDS = (
    "can't start new thread",
    "cannot allocate memory",
    "failed to map segment",
    "unable to allocate",
    "out of memory",
)


def require(size: int) -> None:
    """Raise MemoryError unless this many more bytes fit within the limits of the process and the machine."""
    free = available()
    if free is not None and free < size:
        raise MemoryError


def require_polars(data: int) -> None:
    """Raise MemoryError unless polars can process this many bytes of data."""
    global _used
    require((_LATER_USE if _used else _FIRST_USE + (os.cpu_count() or 1) * _STACK) + 2 * data)
    _used = "polars" in sys.modules


_used = False


def limit_address_space(memory: int) -> None:
    """Limit the address space of this process to its present size plus `memory` bytes."""
    global _bounded
    with contextlib.suppress(ImportError, OSError):
        import resource

        limit = address_space() + memory
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        _bounded = True


def is_bounded() -> bool:
    """Test whether `limit_address_space` has set a limit."""
    return _bounded


_bounded = False


def is_out_of_memory(error: BaseException) -> bool:
    """Test whether an exception, or one of its causes, means out of memory.

    Under a limit threads do not start, libraries cannot be mapped and imports fail, each with another message.
    Extensions that do not check for NULL cause a SystemError, and the import system raises errors of any type.
    """
    return any(
        isinstance(cause, MemoryError)
        or (isinstance(cause, OSError) and cause.errno == errno.ENOMEM)
        or ((isinstance(cause, SystemError) or _within_an_import(cause)) and limited())
        or any(phrase in str(cause).lower() for phrase in _WORDS)
        for cause in _causes(error)
    )


def _within_an_import(error: BaseException) -> bool:
    """Test whether Python's import system raised the exception."""
    frames = list(traceback.walk_tb(error.__traceback__))
    return bool(frames) and frames[-1][0].f_code.co_filename.startswith("<frozen importlib")


def _causes(error: BaseException) -> Iterator[BaseException]:
    """Yield the exception and its chain of causes and contexts."""
    cause: BaseException | None = error
    seen: set[int] = set()
    while cause is not None and id(cause) not in seen:
        seen.add(id(cause))
        yield cause
        cause = cause.__cause__ or cause.__context__


def limited() -> bool:
    """Test for a limit on the address space of this process."""
    try:
        import resource
    except ImportError:
        return False
    return resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY


def trim_heap() -> None:
    """Return freed memory to the system where the address space is limited, for use by other allocators.

    The allocator keeps freed memory in its heap; numpy reuses it there, but polars and imports cannot.
    """
    if limited() and sys.platform.startswith("linux"):
        import ctypes

        with suppress(AttributeError, OSError):  # a C library of another kind
            ctypes.CDLL(None).malloc_trim(0)


def address_space() -> int:
    """Bytes of address space that this process has reserved. Errors: OSError without /proc."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")


def available() -> int | None:
    """Bytes that this process can still allocate; None where the system does not report them."""
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
