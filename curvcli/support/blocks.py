"""Blocks of long arrays, and work on them in two threads."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import copy_context
from itertools import chain, islice
from typing import TypeVar

_Block = TypeVar("_Block")
_Return = TypeVar("_Return")

# More threads are no faster: they compete for memory bandwidth and the interpreter lock.
_THREADS = 2


def _alone() -> bool:
    """Test for a single usable thread."""
    # The variable that numerical libraries obey; a batch sets it for its workers, each of which has one core.
    return (os.cpu_count() or 1) < _THREADS or os.environ.get("OMP_NUM_THREADS") == "1"


@contextmanager
def background_thread(worth: bool = True) -> Iterator[Callable[[Callable[[], _Return]], Callable[[], _Return]]]:
    """Provide a function that starts work in another thread and returns a function that waits for the result.

    worth: False for little work, which is then done in this thread on the first request of its result.
    """
    if _alone() or not worth:
        yield lambda work: work
        return
    with ThreadPoolExecutor(1) as pool:
        yield lambda work: pool.submit(copy_context().run, work).result


def for_each(pieces: Iterable[_Block], work: Callable[[_Block], None]) -> None:
    """Do the work for every piece, in any order; no two pieces may write to the same memory."""
    deque(map_pieces(pieces, work), maxlen=0)


def map_pieces(pieces: Iterable[_Block], work: Callable[[_Block], _Return]) -> Iterator[_Return]:
    """Yield the result of the work for every piece, in their order; no two pieces may write to the same memory.

    Pieces are taken from the iterator on demand, so that few of them exist at a time.
    """
    todo = iter(pieces)
    first = list(islice(todo, 2))
    todo = chain(first, todo)
    if len(first) < 2 or _alone():  # one piece is not worth a thread
        yield from map(work, todo)
        return
    context = copy_context()  # numpy's error state (errstate) is part of the context
    with ThreadPoolExecutor(_THREADS) as pool:
        while batch := list(islice(todo, 4 * _THREADS)):
            yield from pool.map(lambda piece: context.copy().run(work, piece), batch)


ENTRIES = 32768


# For slices with few 32-bit temporaries: a thread waits for the interpreter lock between two operations, and imports in
# another thread release it at most a thousand times a second.
LONG = 131072


def slices(count: int, size: int = ENTRIES) -> Iterator[slice]:
    """Slices that cover 0 … count."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))
