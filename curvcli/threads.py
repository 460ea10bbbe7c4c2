"""Work on blocks in two threads: array arithmetic lets go of the interpreter, and each block has a place of its own."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from itertools import chain, islice
from typing import TypeVar

_Piece = TypeVar("_Piece")

# More wait for memory and for each other.
_THREADS = 2


def for_each(pieces: Iterable[_Piece], work: Callable[[_Piece], None]) -> None:
    """Do the work for every piece; pieces must not share what they write, so that the order does not matter.

    Pieces are taken from an iterator as they are needed, so that few are there at a time.
    """
    todo = iter(pieces)
    first = list(islice(todo, 2))
    if len(first) < 2:  # not worth a thread
        for piece in first:
            work(piece)
        return
    todo = chain(first, todo)
    # The variable that numerical libraries obey; a batch sets it for its workers, each of which has one core.
    if (os.cpu_count() or 1) < _THREADS or os.environ.get("OMP_NUM_THREADS") == "1":
        for piece in todo:
            work(piece)
        return
    with ThreadPoolExecutor(_THREADS) as pool:
        while batch := list(islice(todo, 4 * _THREADS)):
            list(pool.map(work, batch))
