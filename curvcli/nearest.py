"""Suggestions for a name that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

# Names less alike than this (of `difflib`) are no suggestion.
_CUTOFF = 0.6
# Lists up to this long are given whole where no name is near.
_SHORT = 8


def nearest(name: str, known: Iterable[str]) -> list[str]:
    """Up to three known names like this one, nearest first, whatever the case; `-` and `_` are the same."""
    folded: dict[str, list[str]] = {}
    for one in known:
        folded.setdefault(_folded(one), []).append(one)
    wanted = _folded(name.strip())
    if wanted in folded:
        return folded[wanted][:3]
    near = get_close_matches(wanted, folded, 3, _CUTOFF)
    begun = [key for key in folded if key.startswith(wanted)] if len(wanted) > 2 else []
    return [one for key in dict.fromkeys([*near, *sorted(begun, key=len)]) for one in folded[key]][:3]


def _folded(name: str) -> str:
    return name.casefold().replace("-", "_")


def suggestion(name: str, known: Iterable[str], listing: str = "") -> str:
    """The end of a message about an unknown name: `; nearest: a, b`, the whole of a short list, or what lists all.

    listing: a sentence such as "`curvcli passes` lists them". Empty where nothing is near, the list long and nothing
    lists it.
    """
    names = list(dict.fromkeys(known))
    near = nearest(name, names)
    if near:
        return f"; nearest: {', '.join(near)}"
    if 0 < len(names) <= _SHORT:
        return f"; known: {', '.join(names)}"
    return f"; {listing}" if listing else ""
