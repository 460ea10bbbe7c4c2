"""Meanings of codes in the comments that curvcli writes into VTK files."""

from __future__ import annotations

import re
from collections.abc import Iterable

_SIGN = "curvcli:"


def of_comments(comments: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Names of the codes of arrays, from lines `array: 0 name, 1 name` of a comment of curvcli."""
    meanings: dict[str, tuple[str, ...]] = {}
    for comment in comments:
        lines = comment.strip().split("\n")
        if not lines[0].startswith(_SIGN):
            continue
        for line in lines[1:]:
            name, _, codes = line.partition(": 0 ")
            if names := _names(codes):
                meanings[name] = names
    return meanings


def _names(codes: str) -> tuple[str, ...]:
    """Names behind the codes 0, 1, 2, …; none for a text that is cut short."""
    names: list[str] = []
    while codes:
        end = re.search(f", (?:{len(names) + 1}|-1) ", codes)
        names.append(codes[: end.start()] if end else codes)
        codes = codes[end.end() :] if end else ""
        if end and end[0] == ", -1 ":
            break
    return () if names and re.fullmatch(r"and \d+ more", names[-1].rpartition(", ")[2]) else tuple(names)
