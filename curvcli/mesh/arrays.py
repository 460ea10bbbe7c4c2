"""Conversion of given points and faces to the frozen arrays of a surface."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError
from ..support.arrays import Index
from ..support.blocks import LONG, for_each, map_pieces, slices

_Arrays = TypeVar("_Arrays", bound=NDArray[Any])


def as_components(points: ArrayLike) -> NDArray[np.float64]:
    """Convert (V, 3) numbers to frozen (3, V) float64, one contiguous row per coordinate.

    Errors: InputError for another shape or type, or masked entries.
    """
    given = _as_array(points, "points", "numbers of shape (V, 3)")
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "fiu":
        raise InputError(f"points have shape {given.shape} and type {given.dtype}, expected numbers of shape (V, 3)")
    if _kept(given.T, np.float64):
        return given.T
    xyz = np.empty(given.T.shape)

    def convert(block: slice) -> None:
        xyz[:, block] = given[block].T

    for_each(slices(len(given), LONG), convert)
    xyz.setflags(write=False)
    return xyz


def _as_array(given: ArrayLike, what: str, expected: str) -> NDArray[Any]:
    try:
        array = np.asarray(given)
    except ValueError:
        raise InputError(f"{what} have rows of different lengths, expected {expected}") from None
    if np.ma.is_masked(given):
        hint = "fill them in, or leave out what they belong to"
        raise InputError(f"{what} have masked entries, expected {expected} that are all known", hint=hint)
    return array


def _kept(given: NDArray[Any], kind: type[np.generic]) -> bool:
    """Test whether an array needs no copy: it has this type and layout, and it is read-only."""
    owner: Any = given
    while isinstance(owner, np.ndarray):
        if owner.flags.writeable:
            return False
        owner = owner.base
    return (owner is None or isinstance(owner, bytes)) and given.dtype == kind and given.flags.c_contiguous


def frozen(find: Callable[[Any], _Arrays]) -> Callable[[Any], _Arrays]:
    """Make the array that a function returns read-only, for functions with cached results."""

    @wraps(find)
    def read_only(owner: Any) -> _Arrays:
        array = find(owner)
        array.setflags(write=False)
        return array

    return read_only


def freeze(array: NDArray[Any]) -> None:
    """Make an array and the arrays below its view read-only, so that sharing needs no copies."""
    owner: Any = array
    while isinstance(owner, np.ndarray):
        owner.setflags(write=False)
        owner = owner.base


def as_triangles(faces: ArrayLike, vertices: int) -> Index:
    """Convert (F, 3) indices to int32; at least one row, all indices in range.

    Errors: InputError for another shape or type, masked entries, no face, or an index out of range.
    """
    given = _as_array(faces, "faces", "indices of shape (F, 3)")
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu":
        raise InputError(f"faces have shape {given.shape} and type {given.dtype}, expected indices of shape (F, 3)")
    if not len(given):
        raise InputError("no faces: there is no surface to measure", hint="expected at least one face")
    kept = _kept(given, np.int32)
    triangles = given if kept else np.empty(given.shape, np.int32)

    def take_over(block: slice) -> bool:
        """Convert a block of faces; False if an index is out of range."""
        part = given[block]
        exist = bool(part.min() >= 0 and part.max() < vertices)
        if exist and not kept:
            triangles[block] = part
        return exist

    if not all(map_pieces(slices(len(given), LONG), take_over)):
        face, corner = (int(i) for i in np.argwhere((given < 0) | (given >= vertices))[0])
        raise InputError(
            f"corner {given[face, corner]} does not exist, expected a vertex index from 0 to {vertices - 1}",
            place=f"face {face}",
        )
    return triangles


def with_repeated_corner(triangles: Index) -> NDArray[np.intp]:
    """(n,) indices of the triangles with a repeated corner. triangles: (F, 3)."""

    def find(block: slice) -> NDArray[np.intp]:
        a, b, c = triangles[block].T
        result: NDArray[np.intp] = np.flatnonzero((a == b) | (b == c) | (c == a)) + block.start
        return result

    return np.concatenate(list(map_pieces(slices(len(triangles), LONG), find)))
