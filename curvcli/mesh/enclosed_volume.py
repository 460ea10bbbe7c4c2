"""Enclosed volume per group of faces."""

from __future__ import annotations

import numpy as np

from ..support.arrays import Floats
from .counts import count_groups
from .groups import Groups
from .surface import Surface


def volumes(surface: Surface, groups: Groups) -> Floats:
    """(G,) enclosed volume; NaN unless closed, orientable and the oriented faces cancel at every edge."""
    counts = count_groups(surface, groups)
    valid = counts.closed & counts.orientable & counts.balanced
    if not valid.any():
        return np.full(groups.count, np.nan)
    sign = surface.orientation.face_sign
    sixfold = surface.triple_products if sign is None else surface.triple_products * sign
    # One division after the sum: the sum is exact for integer corners.
    return np.where(valid, groups.faces.sum(sixfold) / 6, np.nan)
