"""What several ask of one object, worked out for the first of them and kept with the object."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

_Found = TypeVar("_Found")


def once(owner: object, name: str, find: Callable[[], _Found]) -> _Found:
    """What was found of the owner under this name: kept in it, so that it goes with it and never outlives it."""
    kept: dict[str, _Found] = vars(owner).setdefault("_once", {})
    if name not in kept:
        kept[name] = find()
    return kept[name]
