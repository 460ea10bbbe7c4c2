"""Triangle strips as triangles."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def strip_triangles(indices: NDArray[Any], lengths: NDArray[np.int64]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """The triangles (n, 3) of strips, and the row (n,) of each: every three successive indices, every second turned.

    indices: of all strips, concatenated. lengths: indices of each row. A strip ends where its row ends and at each -1.
    """
    ends = np.cumsum(lengths)
    row_start = np.zeros(len(indices) + 1, np.bool_)
    row_start[ends - lengths] = True
    cut = indices == -1
    begins = row_start[:-1].copy()
    begins[1:] |= cut[:-1]
    begin = np.maximum.accumulate(np.where(begins, np.arange(len(indices)), 0))
    third = np.arange(2, len(indices))
    third = third[(begin[2:] <= third - 2) & ~cut[2:]]
    odd = (third - begin[third]) % 2 == 1
    a, b = third - 2, third - 1
    triangles = np.stack([indices[np.where(odd, b, a)], indices[np.where(odd, a, b)], indices[third]], axis=1)
    return triangles.astype(np.int32), np.searchsorted(ends, third, side="right")
