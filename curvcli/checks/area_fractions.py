"""Fractions of the surface by the sign of its curvatures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..mesh.groups import Groups
from ..mesh.precision import is_single, last_place
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from ..support.arrays import Column, Floats

# Rounding of an angle defect, and of a mean curvature vector per extent of its star.
_DEFECT, _BEND = 16 * EPSILON * 2 * np.pi, 16 * EPSILON
# The sum of the cotangents of a star is a tenth of extent²/A for equilateral triangles.
_COTANGENTS = 0.25


def area_fractions(surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> dict[str, Floats]:
    """Fractions (G,) of the area of each group where K, and H where it is computed, is positive, negative and zero.

    The area is that of the vertices that have a value, barycentric; the three fractions add up to 1. NaN without such a
    vertex. Zero is a value that rounding can explain, of the arithmetic and of the coordinates, whose last place δ is
    that of float32 where all of them are such numbers: |H_p| ≤ B = 16ε · extent + ¼δ · extent²/A, the extent of the
    star, and |K_p| ≤ 16ε · 2π + B(h + B/A).
    """
    area = columns["star_area"]
    bend: Column = np.zeros_like(area)
    if "star_extent" in columns:
        place = last_place(surface, np.float32 if is_single(surface.used_coordinates()) else np.float64)
        extent = columns["star_extent"]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            bend = _BEND * extent + _COTANGENTS * place * extent * extent / area
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        density = bend / area
        bound = _DEFECT + bend * (np.nan_to_num(columns["h"]) + density if "h" in columns else density)
    fractions = _fractions("K", groups, columns["K"], bound, area)
    if "h_signed" in columns:
        fractions |= _fractions("H", groups, columns["h_signed"] * area, bend, area)
    return fractions


def _fractions(name: str, groups: Groups, values: Column, bound: Column, area: Column) -> dict[str, Floats]:
    known = ~np.isnan(values)
    positive, negative = (groups.vertices.sum(np.where(mask, area, 0.0)) for mask in (values > bound, values < -bound))
    whole = groups.vertices.sum(np.where(known, area, 0.0))
    whole = np.where(whole > 0, whole, np.nan)
    zero = np.maximum(whole - positive - negative, 0.0)
    near = groups.vertices.any(known & ~(np.abs(values) > bound))
    sums = {"positive": positive, "negative": negative, "zero": np.where(near, zero, 0.0)}
    return {f"{name}_{sign}": part / whole for sign, part in sums.items()}
