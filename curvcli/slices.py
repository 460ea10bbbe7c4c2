"""Long arrays in pieces whose temporaries stay in the second-level cache."""

from __future__ import annotations

from collections.abc import Iterator

ENTRIES = 16384


def slices(count: int, size: int = ENTRIES) -> Iterator[slice]:
    """Slices that cover 0 … count."""
    return (slice(start, min(start + size, count)) for start in range(0, count, size))
