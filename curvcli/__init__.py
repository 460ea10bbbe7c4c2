"""Curvatures of triangle meshes that keep their integral relations exactly.

    >>> import curvcli
    >>> analysis = curvcli.analyze("bunny.ply")          # doctest: +SKIP
    >>> analysis.vertices["K"], analysis.totals["K"]     # doctest: +SKIP

Names are loaded when they are first used, so that importing the package costs nothing.
"""

from __future__ import annotations

from ._version import __version__

# Not typing's: it takes several times as long to import as all that is here, and Ctrl-C is not heard before.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from . import errors
    from .analysis import Analysis, analyze
    from .declare import passes
    from .loading.surfaces import load
    from .surface import Surface

__all__ = ["Analysis", "Surface", "__version__", "analyze", "errors", "load", "passes"]

_HOME = {"Analysis": "analysis", "Surface": "surface", "analyze": "analysis", "load": "loading.surfaces"}


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name == "passes":
        import_module(".pipeline", __name__).load_passes()
        return import_module(".declare", __name__).passes
    if name == "errors":
        return import_module(".errors", __name__)
    if name in _HOME:
        return getattr(import_module(f".{_HOME[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
