"""Cache a function of objects for as long as the objects live."""

from __future__ import annotations

from collections.abc import Callable, MutableMapping
from functools import wraps
from typing import Any, TypeVar, TypeVarTuple
from weakref import WeakKeyDictionary

_Value = TypeVar("_Value")
_Arguments = TypeVarTuple("_Arguments")


def cached(function: Callable[[*_Arguments], _Value]) -> Callable[[*_Arguments], _Value]:
    """Cache the results of a function by the identity of every argument.

    The cache holds weak references to the arguments and keeps none of them alive; a result must not refer to one.
    """
    cache: MutableMapping[Any, Any] = WeakKeyDictionary()

    @wraps(function)
    def cached_function(*arguments: *_Arguments) -> _Value:
        objects: tuple[Any, ...] = arguments
        level, last = cache, objects[-1]
        for key in objects[:-1]:
            level = level.setdefault(key, WeakKeyDictionary())
        if last not in level:
            level[last] = function(*arguments)
        result: _Value = level[last]
        return result

    return cached_function
