"""Gradients of area and volume against central differences."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, cross, dot
from ..support.arrays import Flags, Floats, VectorColumn
from ..support.words import counted
from .base import IdentityValues, check

SAMPLES = 64


@check(
    gap="gradient − central difference, in units of its error bound",
    applies="64 vertices spread over those that no degenerate face touches",
    bound="1, in units of the error of the difference: for area truncation, step² · Σ|e|/height², and rounding, "
    "r/step; for volume r. Here r = (16 + faces)ε · Σ(reach² + reach·|e|), and step = ε^⅓ · the least height at the "
    "vertex",
    failure="a gradient is not the derivative of what it is named after. This is the one identity that moves "
    "vertices: it does not share its formulas with what it tests.",
    after="volume",
)
def first_variation(
    surface: Surface, groups: Groups, area_gradient: VectorColumn, A_vec: VectorColumn, degenerate: Flags
) -> IdentityValues:
    """∇_p area and A_p = ∇_p volume against central differences of area and volume at sampled vertices."""
    usable = np.flatnonzero(surface.referenced & ~degenerate)
    sample = usable[np.unique(np.linspace(0, len(usable) - 1, SAMPLES).astype(np.int64))] if len(usable) else usable
    chosen = np.zeros(surface.n_vertices, bool)
    chosen[sample] = True
    corner = np.flatnonzero(chosen[surface.faces].ravel())
    vertex = surface.faces.reshape(-1)[corner]
    differences = _differences(surface, corner, np.searchsorted(sample, vertex), len(sample))
    strain = np.zeros((2, len(sample)))
    gradients = area_gradient[:, sample], A_vec[:, sample]
    for row, gradient, (difference, bound) in zip(strain, gradients, differences, strict=True):
        gap = difference - gradient
        row[:] = np.sqrt(dot(gap, gap)) / bound
    worst = np.full(surface.n_vertices, np.nan)
    worst[sample] = np.fmax(*strain)  # A_vec is null without an orientation
    residual, moved = groups.vertices.max(worst), groups.vertices.count_true(chosen)
    outcome = IdentityValues(
        residual,
        np.zeros(groups.count),
        np.ones(groups.count),
        detail=lambda g: (
            f"largest deviation over {counted(int(moved[g]), 'vertex', 'vertices')}, in units of the error bound of "
            "the differences"
        ),
    )
    outcome.exclude(np.isnan(residual), "no sampled vertex here has a gradient")
    return outcome


# Powers of lower heights, in the unit of computation, underflow: no differences are formed there.
_LOWEST = 2.0**-240


def _differences(
    surface: Surface, corner: NDArray[np.intp], member: NDArray[np.intp], count: int
) -> list[tuple[VectorColumn, Floats]]:
    """Central differences of area and volume for each of `count` vertices, with bounds on their errors.

    corner: the corners at these vertices. member: the vertex of each corner.
    """
    face, k = corner // 3, corner % 3
    p, q, r = (surface.xyz[:, surface.faces[face, (k + turn) % 3]] for turn in range(3))
    q, r = q - p, r - p
    if surface.corner_sign is not None:
        sign = surface.corner_sign.reshape(-1)[corner].astype(np.float64)
    else:
        sign = np.ones(len(corner))
    opposite = r - q
    normal = np.array(cross(q, r))
    length, twice = np.sqrt(dot(opposite, opposite)), np.sqrt(dot(normal, normal))
    with np.errstate(divide="ignore", invalid="ignore"):
        height = twice / length
    height = np.where(height > _LOWEST, height, 0.0)
    reach = np.sqrt(np.maximum(dot(q, q), dot(r, r)))
    lowest = np.full(count, np.inf)
    np.minimum.at(lowest, member, height)
    # Truncation grows with the square of the step, rounding with its inverse: the cube root of ε balances them.
    step = EPSILON ** (1 / 3) * np.where(lowest > 0, lowest, np.nan)
    area, volume = np.zeros((3, count)), np.zeros((3, count))
    for axis in range(3):
        for way in (1.0, -1.0):
            moved = np.zeros((3, len(corner)))
            moved[axis] = way * step[member]
            swept = np.array(cross(q - moved, r - moved))
            change = way / (2 * step)
            area[axis] += np.bincount(member, np.sqrt(dot(swept, swept)) / 2, minlength=count) * change
            # The change of volume is that of the tetrahedron p, p + moved, q, r.
            volume[axis] += np.bincount(member, sign * dot(moved, swept) / 6, minlength=count) * change
    faces = np.bincount(member, minlength=count)
    square = np.where(height > 0, height * height, np.nan)
    rounding = (16 + faces) * EPSILON * np.bincount(member, reach * reach + length * reach, minlength=count)
    truncation = step * step * np.bincount(member, length / square, minlength=count)
    return [(area, rounding / step + truncation), (volume, rounding)]
