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
    from .api import Analysis, Surface, analyze, load
    from .curvatures.registry import passes

__all__ = ["Analysis", "Surface", "__version__", "analyze", "errors", "load", "passes"]

_HOME = {"Surface": "mesh.surface", "load": "loading.load"}


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name == "passes":
        return import_module(".curvatures.catalogue", __name__).loaded()
    if name == "errors":
        return import_module(".errors", __name__)
    if name in __all__:
        return getattr(import_module(f".{_HOME.get(name, 'api')}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
