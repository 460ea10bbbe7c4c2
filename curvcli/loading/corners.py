"""Corner indices of polygons: whole numbers within the range of the vertices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError


def checked_corners(
    indices: NDArray[Any], sizes: NDArray[np.integer[Any]] | int, name: str, vertices: int, lowest: int = 0
) -> NDArray[np.int32]:
    """Check that all indices are whole numbers in range, and return them as int32.

    indices: (n,) concatenated. sizes: corners of each polygon, or of every polygon. name: of a polygon in messages.
    lowest: smallest index allowed.
    Errors: InputError with the polygon of the first wrong index.
    """
    if indices.dtype.kind == "f":
        fraction = np.flatnonzero((indices != np.floor(indices)) | np.isinf(indices))
        if len(fraction):
            problem = f"vertex index {indices[fraction[0]]:g} found, a whole number expected"
            raise InputError(problem, place=f"{name} {_polygon(int(fraction[0]), sizes)}")
    if len(indices) and (int(indices.min()) < lowest or int(indices.max()) >= vertices):
        wrong = int(np.flatnonzero((indices < lowest) | (indices >= vertices))[0])
        expected = f"0 to {vertices - 1} expected" if vertices else "but no vertex"
        problem = f"vertex index {int(indices[wrong])} found, {expected}"
        raise InputError(problem, place=f"{name} {_polygon(wrong, sizes)}")
    return np.ascontiguousarray(indices, np.int32)


def _polygon(corner: int, sizes: NDArray[np.integer[Any]] | int) -> int:
    """The polygon of a corner."""
    if isinstance(sizes, int):
        return corner // sizes
    return int(np.searchsorted(np.cumsum(sizes), corner, side="right"))
