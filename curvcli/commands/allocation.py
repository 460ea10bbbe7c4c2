"""Memory allocation of the process of a command; a library must not decide this for its program."""

from __future__ import annotations

import gc
import os
import sys

# More objects than all imports make, so that none of them starts the collector: 8 % of the CPU time of a small mesh,
# 16 % where every extra is installed.
_OBJECTS = 200_000

_M_TRIM_THRESHOLD, _M_MMAP_MAX, _M_ARENA_MAX = -1, -4, -8  # of glibc's mallopt


def keep_memory() -> None:
    """Keep what has been allocated, and do without huge pages; call it before numpy is imported.

    The first touch of memory costs about as much as the arithmetic on it. By default the memory of every large array
    returns to the system, and the next array touches new memory. Of 1,000,000 vertices (PLY to CSV and PLY), without
    the settings of malloc the CPU time is 9 to 19 % longer, with huge pages up to 12 %, as the machine has them.
    """
    gc.set_threshold(_OBJECTS)
    os.environ.setdefault("NUMPY_MADVISE_HUGEPAGE", "0")
    if not sys.platform.startswith("linux"):
        return
    import ctypes

    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError):
        return  # a C library of another kind
    mallopt(_M_MMAP_MAX, 0)
    mallopt(_M_TRIM_THRESHOLD, -1)
    mallopt(_M_ARENA_MAX, 1)  # else the arenas of other threads take 20 % more memory
