"""Integrals over the whole surface and its groups."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .blocks import dot, signed_volumes
from .census import census
from .declare import Quantity, passes
from .groups import Groups
from .surface import Surface

Floats = NDArray[np.float64]


def volumes(surface: Surface, groups: Groups) -> Floats:
    """(G,) enclosed volume; NaN unless closed, orientable and the oriented faces cancel at every edge."""
    counts = census(surface, groups)
    valid = counts.closed & counts.orientable & counts.balanced
    if not valid.any():
        return np.full(groups.count, np.nan)
    volume = signed_volumes(surface, surface.components.face)
    if surface.orientation.face_sign is not None:
        volume *= surface.orientation.face_sign
    return np.where(valid, groups.faces.sum(volume), np.nan)


def totals(surface: Surface, groups: Groups, columns: Mapping[str, Any], mean: str = "sum") -> dict[str, Floats]:
    """Every total that the given columns provide, (G,) or (G, 3), in the file's unit and the chosen convention for H.

    What is odd under reversal of the orientation is NaN on groups that have none; nulls in a column are left out.
    """
    found: dict[str, Floats] = {}
    orientable = census(surface, groups).orientable
    for quantity in passes.quantities(public=False):
        if quantity.total is None or quantity.name not in columns:
            continue
        total = _sum(groups, quantity, columns[quantity.name])
        if quantity.parity == "odd":
            total = np.where(orientable if total.ndim == 1 else orientable[:, None], total, np.nan)
        total = surface.in_file_unit(total, quantity.length_exponent)
        found[quantity.total] = total * 0.5**quantity.mean_degree if mean == "average" else total
        if quantity.total == "area":
            found["volume"] = surface.in_file_unit(volumes(surface, groups), 3)
    return found


def _sum(groups: Groups, quantity: Quantity, column: Any) -> Floats:
    segments = groups.of(quantity.on)
    return np.stack([segments.sum(x) for x in column], axis=1) if quantity.vector else segments.sum(column)


def constant_mean_curvature(surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> dict[str, Floats]:
    """How close to constant mean curvature, over interior vertices: H = −Σ **H**·**A** / Σ|**A**|², positive on convex
    bodies, `residual_max` = max |**H**_p + H **A**_p|, and `H_vec_max` = max |**H**_p|, 0 on minimal surfaces.

    H and its residual are NaN on groups without an orientation and where no vertex is inside.
    """
    H_vec, A_vec = (np.where(surface.interior, columns[name], np.nan) for name in ("H_vec", "A_vec"))
    vertices = groups.vertices
    with np.errstate(invalid="ignore", divide="ignore"):
        H = -vertices.sum(dot(H_vec, A_vec)) / vertices.sum(dot(A_vec, A_vec))
    each = H[0] if vertices.label is None else np.append(H, np.nan)[vertices.label]
    residual = H_vec + each * A_vec
    orientable = census(surface, groups).orientable
    return {
        "H": np.where(orientable, H, np.nan),
        "residual_max": np.where(orientable, vertices.max(np.sqrt(dot(residual, residual))), np.nan),
        "H_vec_max": vertices.max(np.sqrt(dot(H_vec, H_vec))),
    }
