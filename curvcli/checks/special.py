"""Special surfaces: constant mean curvature, minimal surfaces, the Steiner polynomial of convex bodies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..mesh.counts import classify, count_groups
from ..mesh.enclosed_volume import volumes
from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, LOST, cross, dot
from ..support.arrays import Floats
from ..support.blocks import slices


def constant_mean_curvature(surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> dict[str, Floats]:
    """Distance from constant mean curvature and from a minimal surface, (G,) each.

    `H` = −Σ **H**·**A**/A_p ÷ Σ|**A**|²/A_p, the projection in the area measure, positive on convex bodies.
    Over interior vertices: `residual_max`, the largest |**H**_p + H **A**_p|, and `residual_density_max`, the largest
    of it per A_p. Over all that are not on the boundary, other stars than fans included: `H_vec_max`, the largest
    |**H**_p|, and `H_vec_density_max`, the largest |**H**_p|/A_p.

    Vertices with null **H** are left out. H and its residuals are NaN on groups without an orientation, without an
    interior vertex, and where **A** is rounding only: Σ|**A**|²/A ≤ 1e-24 ΣA.
    """
    vertices, inside, rim = groups.vertices, surface.interior, surface.boundary
    products, squares, areas, sizes, densities = np.full((5, surface.n_vertices), np.nan)
    for block in slices(surface.n_vertices):
        H_vec, A_vec, area = columns["H_vec"][:, block], columns["A_vec"][:, block], columns["star_area"][block]
        product, size = dot(H_vec, A_vec), np.sqrt(dot(H_vec, H_vec))
        known = inside[block] & ~np.isnan(product) & (area > 0)
        for target, values in ((products, product), (squares, dot(A_vec, A_vec))):
            np.divide(values, area, out=target[block], where=known)
        np.copyto(areas[block], area, where=known)
        np.copyto(sizes[block], size, where=~rim[block])
        np.divide(size, area, out=densities[block], where=~rim[block] & (area > 0))
    square = vertices.sum(squares)
    least = np.maximum(LOST * LOST * vertices.sum(areas), np.finfo(np.float64).tiny)
    H = 0.0 - vertices.sum(products) / np.where(square > least, square, np.nan)
    residual, residual_density = squares, areas  # no longer needed
    for block in slices(surface.n_vertices):
        each_H = H[0] if vertices.label is None else np.append(H, np.nan)[vertices.label[block]]
        rest = columns["H_vec"][:, block] + each_H * columns["A_vec"][:, block]
        size = np.sqrt(dot(rest, rest))
        np.copyto(residual[block], size, where=inside[block])
        area = columns["star_area"][block]
        np.divide(size, area, out=residual_density[block], where=inside[block] & (area > 0))
    orientable = count_groups(surface, groups).orientable
    return {
        "H": np.where(orientable, H, np.nan),
        "residual_max": np.where(orientable, vertices.max(residual), np.nan),
        "residual_density_max": np.where(orientable, vertices.max(residual_density), np.nan),
        "H_vec_max": vertices.max(sizes),
        "H_vec_density_max": vertices.max(densities),
    }


def steiner(surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> dict[str, Floats]:
    """Steiner's polynomial Vol + t·Area + t²/2·ΣH_theta + t³/3·ΣK, (G, 4), and flags (G,) of convex bodies.

    For a convex body it is the volume of the parallel body at distance t, also with inside-out winding. NaN where the
    volume is NaN.
    Convex: closed, connected, χ = 2 and ΣK⁻ ≤ 16 ε (F + V).
    """
    counts = count_groups(surface, groups)
    integrals = [
        volumes(surface, groups),
        groups.faces.sum(columns["face_area"]),
        groups.edges(surface).sum(columns["H_theta"]) / 2,
        groups.vertices.sum(columns["K"]) / 3,
    ]
    sphere = counts.closed & counts.manifold & (counts.euler_characteristic == 2)
    single = classify(surface, groups).components == 1
    bent = groups.vertices.sum(columns["K_minus"]) > 16 * EPSILON * (counts.faces + counts.vertices)
    convex = sphere & single & ~bent
    for odd in (0, 2):  # under reversal
        integrals[odd] = np.where(convex, np.abs(integrals[odd]), integrals[odd])
    shown = [surface.in_file_unit(value, 3 - power) for power, value in enumerate(integrals)]
    coefficients = np.where(np.isnan(integrals[0])[:, None], np.nan, np.stack(shown, axis=1))
    return {"coefficients": coefficients, "convex": convex}


def competing_normals(surface: Surface, groups: Groups, columns: Mapping[str, Any]) -> dict[str, Floats]:
    """The angle between the lines of **H**_p and **A**_p over interior vertices: (G,) largest and mean, in radians.

    Both are normals at p: moving p along **H**_p decreases area fastest, along **A**_p increases volume fastest.
    """
    angle = np.full(surface.n_vertices, np.nan)
    for block in slices(surface.n_vertices):
        H_vec, A_vec = columns["H_vec"][:, block], columns["star_vector"][:, block]
        across, length = cross(H_vec, A_vec), np.sqrt(dot(A_vec, A_vec))
        known = surface.interior[block] & (dot(H_vec, H_vec) > 0) & (length > LOST * columns["star_area"][block])
        np.arctan2(np.sqrt(dot(across, across)), np.abs(dot(H_vec, A_vec)), where=known, out=angle[block])
    with np.errstate(invalid="ignore"):
        mean = groups.vertices.sum(angle) / groups.vertices.count_true(~np.isnan(angle))
    return {"angle_max": groups.vertices.max(angle), "angle_mean": mean}
