"""Signs of STL: the counter of binary files, and the first word of text."""

from __future__ import annotations

import re

HEADER = 84
"""Bytes of a binary file before its facets: 80 that are free, and their number."""
ASCII_SIGN = re.compile(rb"(?:\xef\xbb\xbf)?(?:\s*+#[^\r\n]*+[\r\n])*+\s*+solid\b", re.IGNORECASE)


def is_binary_stl(start: bytes, size: int) -> bool:
    """Test whether the size is the one that the counter of binary STL gives.

    The size decides, independently of the header; other content may be truncated, or text (`ASCII_SIGN`).
    """
    return size >= HEADER and announced_size(start) == size


def has_room(start: bytes, size: int) -> bool:
    """Test whether the size has room for the facets that the counter of binary STL announces, at least one.

    Such content is binary STL, possibly with bytes after the last facet.
    """
    return size >= HEADER and HEADER < announced_size(start) <= size


def announced_size(start: bytes | memoryview) -> int:
    """The size of a binary STL file with the number of facets in the counter."""
    return HEADER + 50 * int.from_bytes(start[80:HEADER], "little")
