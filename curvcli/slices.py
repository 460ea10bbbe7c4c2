"""Long arrays in pieces whose temporaries stay in the second-level cache."""

from __future__ import annotations

from collections.abc import Iterator

ENTRIES = 32768
# Where a slice has few temporaries of 32 bits: between two operations a thread waits for the interpreter, which imports
# in another thread let go of a thousand times a second at most.
LONG = 131072


def slices(count: int, size: int = ENTRIES) -> Iterator[slice]:
    """Slices that cover 0 … count."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))
