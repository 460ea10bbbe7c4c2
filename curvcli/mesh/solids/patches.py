"""Solid patches of a surface (closed and orientable): nesting, and patches that are inside out."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...support.arrays import Mask
from ...support.cache import cached
from ..arrays import frozen
from ..volumes import volume_errors

if TYPE_CHECKING:
    from ..orientation import Orientation
    from .nesting import Nesting


_Value = TypeVar("_Value")


class _CachedOnSurface(Generic[_Value]):
    """A property of the solids of a surface, cached on the surface to avoid a reference cycle."""

    def __init__(self, find: Callable[[Solids], _Value]) -> None:
        self._of = cached(lambda surface: find(surface.solids))

    def __get__(self, solids: Solids, _: type[Solids]) -> _Value:
        return self._of(solids.surface)


class Patched(Protocol):
    """Protocol of a surface with patches; `Surface` describes the members."""

    @property
    def xyz(self) -> Any: ...
    @property
    def faces(self) -> Any: ...
    @property
    def components(self) -> Any: ...
    @property
    def triple_products(self) -> Any: ...
    @property
    def closed_patches(self) -> Any: ...


class Solids:
    """Closed orientable patches, which have an inside.

    surface: their surface. orientation: as the file winds it. mask: (patches,) closed and orientable patches.
    """

    def __init__(self, surface: Patched, orientation: Orientation) -> None:
        self.surface, self._orientation = surface, orientation
        self.mask: Mask = surface.closed_patches & orientation.orientable
        self.mask.setflags(write=False)

    @_CachedOnSurface
    def count(self) -> int:
        """Number of solid patches."""
        return int(np.count_nonzero(self.mask))

    @_CachedOnSurface
    @frozen
    def depth(self) -> NDArray[np.int64]:
        """(patches,) number of other solid patches around each; 0 for patches that cross another: no depth."""
        depth = np.zeros(len(self.mask), np.int64)
        if self.count > 1:
            depth[self.mask] = self._nesting.depth
        return depth

    @_CachedOnSurface
    @frozen
    def crossing(self) -> NDArray[np.int64]:
        """(m, 2) pairs of solid patches that cross or coincide."""
        if self.count < 2:
            return np.zeros((0, 2), np.int64)
        return np.flatnonzero(self.mask)[self._nesting.crossing]

    @_CachedOnSurface
    def _nesting(self) -> Nesting:
        from .nesting import nest  # deferred: a single patch needs no nesting

        number = np.where(self.mask, np.cumsum(self.mask) - 1, -1)[self._orientation.patch]
        sign = np.sign(self._volumes[self.mask]).astype(np.int64)
        return nest(self.surface.xyz, self.surface.faces, number, sign)

    @_CachedOnSurface
    @frozen
    def inside_out(self) -> Mask:
        """(patches,) mask of the patches whose volume has the wrong sign, beyond rounding.

        Bodies have even depth and a positive volume, cavities odd depth and a negative one; patches that cross another
        are left out.
        """
        wrong, volume = self.mask.copy(), self._volumes
        if self.count > 1:
            wrong[self.crossing.ravel()] = False
            volume = volume * (1 - 2 * (self.depth % 2))
        wrong &= volume < 0
        if wrong.any():
            chosen = np.flatnonzero(wrong[self._orientation.patch])
            errors = volume_errors(self.surface.xyz, self.surface.faces, self.surface.components.face, chosen)
            wrong &= volume + self._sum(errors, chosen) < 0
        return wrong

    @_CachedOnSurface
    def _volumes(self) -> NDArray[np.float64]:
        """(patches,) volumes as the patches are oriented."""
        if not self.count:
            return np.zeros(len(self.mask))
        sign = self._orientation.face_sign
        products = self.surface.triple_products
        return self._sum(products if sign is None else products * sign) / 6

    def _sum(self, values: NDArray[np.float64], faces: NDArray[np.integer[Any]] | None = None) -> NDArray[np.float64]:
        patch = self._orientation.patch if faces is None else self._orientation.patch[faces]
        return np.asarray(np.bincount(patch, values, minlength=len(self.mask)), np.float64)

    @_CachedOnSurface
    @frozen
    def first_face(self) -> NDArray[np.int64]:
        """(patches,) the lowest face of each patch of the surface."""
        return np.unique(self._orientation.patch, return_index=True)[1]
