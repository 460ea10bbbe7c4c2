"""Modules that are imported on the way and never looked into: found, but not run until somebody does."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType

# scipy asks numpy for everything that it has, and trimesh imports what rotates, filters and minimises.
NEVER_USED = (
    *("numpy.f2py", "numpy.polynomial", "numpy.testing"),
    *("scipy.ndimage", "scipy.optimize", "scipy.spatial.transform"),
    *("trimesh.nsphere", "trimesh.path.simplify"),  # which take functions out of scipy.optimize
)


class Deferred:
    """A finder of these modules; see `importlib.util.LazyLoader`."""

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        """Where the module is, to be run when an attribute of it is asked for; None for all other modules."""
        if name not in NEVER_USED:
            return None
        from importlib.util import LazyLoader

        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = LazyLoader(spec.loader)
        return spec


def defer_imports() -> None:
    """Defer them in this process; a library must not decide this for its program."""
    if not any(finder is Deferred for finder in sys.meta_path):
        sys.meta_path.insert(0, Deferred)
