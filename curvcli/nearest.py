"""Which of the known names somebody may have meant."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def nearest(name: str, known: Iterable[str]) -> list[str]:
    """Up to three known names like this one, nearest first, in whatever case it is written."""
    folded: dict[str, list[str]] = {}
    for one in known:
        folded.setdefault(one.lower(), []).append(one)
    return [one for match in get_close_matches(name.lower(), folded, 3, 0.4) for one in folded[match]][:3]
