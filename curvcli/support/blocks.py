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

_Piece = TypeVar("_Piece")
_Found = TypeVar("_Found")

# More wait for memory and for each other.
_THREADS = 2


def _alone() -> bool:
    """Whether there is one thread to work with."""
    # The variable that numerical libraries obey; a batch sets it for its workers, each of which has one core.
    return (os.cpu_count() or 1) < _THREADS or os.environ.get("OMP_NUM_THREADS") == "1"


@contextmanager
def background_thread(worth: bool = True) -> Iterator[Callable[[Callable[[], _Found]], Callable[[], _Found]]]:
    """Something that has work begun in another thread, and gives what waits for its result.

    worth: whether there is so much to do that a thread pays; else the work is done when its result is asked for.
    """
    if _alone() or not worth:
        yield lambda work: work
        return
    with ThreadPoolExecutor(1) as pool:
        yield lambda work: pool.submit(copy_context().run, work).result


def for_each(pieces: Iterable[_Piece], work: Callable[[_Piece], None]) -> None:
    """Do the work for every piece; pieces must not share what they write, so that the order does not matter."""
    deque(map_pieces(pieces, work), maxlen=0)


def map_pieces(pieces: Iterable[_Piece], work: Callable[[_Piece], _Found]) -> Iterator[_Found]:
    """What the work finds for every piece, in their order; pieces must not share what they write.

    Pieces are taken from an iterator as they are needed, so that few are there at a time.
    """
    todo = iter(pieces)
    first = list(islice(todo, 2))
    todo = chain(first, todo)
    if len(first) < 2 or _alone():  # one piece is not worth a thread
        yield from map(work, todo)
        return
    context = copy_context()  # what numpy is to do about overflows and the like
    with ThreadPoolExecutor(_THREADS) as pool:
        while batch := list(islice(todo, 4 * _THREADS)):
            yield from pool.map(lambda piece: context.copy().run(work, piece), batch)


ENTRIES = 32768


# Where a slice has few temporaries of 32 bits: between two operations a thread waits for the interpreter, which imports
# in another thread let go of a thousand times a second at most.
LONG = 131072


def slices(count: int, size: int = ENTRIES) -> Iterator[slice]:
    """Slices that cover 0 … count."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))
