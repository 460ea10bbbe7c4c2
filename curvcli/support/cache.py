"""Cache a function of objects for as long as the objects live."""

from __future__ import annotations

from collections.abc import Callable, MutableMapping
from functools import wraps
from typing import Any, TypeVar, TypeVarTuple
from weakref import WeakKeyDictionary

_Found = TypeVar("_Found")
_Asked = TypeVarTuple("_Asked")


def cached(find: Callable[[*_Asked], _Found]) -> Callable[[*_Asked], _Found]:
    """The function with its results cached by the identity of every argument.

    The arguments are referred to weakly, so that the cache keeps none of them alive; a result must not refer to one.
    """
    kept: MutableMapping[Any, Any] = WeakKeyDictionary()

    @wraps(find)
    def found(*asked: *_Asked) -> _Found:
        objects: tuple[Any, ...] = asked
        level, last = kept, objects[-1]
        for one in objects[:-1]:
            level = level.setdefault(one, WeakKeyDictionary())
        if last not in level:
            level[last] = find(*asked)
        result: _Found = level[last]
        return result

    return found
