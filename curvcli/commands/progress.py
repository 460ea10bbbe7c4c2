"""Progress of the work and its time, on stderr."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass
class Phase:
    """Phase of the work and the seconds it took."""

    seconds: float = 0.0


@contextmanager
def phase(name: str, quiet: bool) -> Iterator[Phase]:
    """Time a phase; show it with a spinner where stderr is a terminal."""
    timed = Phase()
    start = time.perf_counter()
    try:
        if quiet or not sys.stderr.isatty():
            yield timed
        else:
            from ..report.terminal.console import Console, escape

            with Console(stderr=True).status(escape(name)):
                yield timed
    finally:
        timed.seconds = time.perf_counter() - start
