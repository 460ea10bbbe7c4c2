"""Points and faces as callers hand them in, made into what a surface keeps."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputError
from .topology import Index


def as_components(points: ArrayLike) -> NDArray[np.float64]:
    """(V, 3) numbers as frozen (3, V) float64, one contiguous row per coordinate.

    Errors: InputError for another shape or type.
    """
    given = np.asarray(points)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "fiu":
        raise InputError(f"points have shape {given.shape} and type {given.dtype}, expected numbers of shape (V, 3)")
    xyz = np.array(given.T, np.float64, order="C", copy=_copy(given))
    xyz = xyz.view()  # so that freezing ours leaves the caller's array as it is
    xyz.setflags(write=False)
    return xyz


def _copy(given: NDArray[Any]) -> bool | None:
    """Copy what its owner may still change, and the rest only where type or layout ask for it."""
    return True if given.flags.writeable else None


def as_triangles(faces: ArrayLike, vertices: int) -> Index:
    """(F, 3) indices as int32, in range and at least one.

    Errors: InputError for another shape or type, no face, or a corner that does not exist.
    """
    given = np.asarray(faces)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu":
        raise InputError(f"faces have shape {given.shape} and type {given.dtype}, expected indices of shape (F, 3)")
    if not len(given):
        raise InputError("no faces: there is no surface to measure", hint="expected at least one face")
    if given.min() < 0 or given.max() >= vertices:
        face, corner = (int(i) for i in np.argwhere((given < 0) | (given >= vertices))[0])
        raise InputError(
            f"corner {given[face, corner]} does not exist, expected a vertex index from 0 to {vertices - 1}",
            place=f"face {face}",
        )
    return np.array(given, np.int32, order="C", copy=_copy(given)).view()
