"""Fenchel's theorem: a closed curve has total curvature of at least 2π."""

from __future__ import annotations

import numpy as np

from ..curves.boundary import boundary_loops
from ..curves.turning import Turning
from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON
from .base import IdentityValues, check


@check(
    gap="2π − Σψ",
    applies="where there is a closed boundary curve; the loop that turns least is tested",
    bound="16ε · vertices of the loop",
    failure="a turning angle of a boundary loop is wrong, or the loop is not walked as it runs.",
    after="gauss_bonnet_combinatorial",
)
def fenchel(surface: Surface, groups: Groups) -> IdentityValues:
    """Every closed boundary curve has total curvature Σψ ≥ 2π, with equality if it is plane and convex."""
    least, vertices = np.full(groups.count, np.inf), np.ones(groups.count)
    number = np.full(groups.count, -1)
    if surface.boundary.any():
        boundary = boundary_loops(surface)
        turning = Turning(boundary.curves.distinct()[0])
        curves = turning.curves
        # The curve of each group with the least total curvature; curves of a single point are left out.
        group = groups.face[boundary.half_edge[boundary.start[:-1]] // 3]
        usable = np.flatnonzero(curves.closed & (curves.edges > 0) & (group >= 0))
        usable = usable[np.argsort(turning.total[usable], kind="stable")[::-1]]
        number[group[usable]] = usable
        some = number >= 0
        least[some], vertices[some] = turning.total[number[some]], curves.sizes[number[some]]
    expected = np.full(groups.count, 2 * np.pi)

    def detail(g: int) -> str:
        # Loops of a region have no numbers in the report, since its border is boundary too.
        least_of = "told of the loop that" if groups.kind == "region" else f"loop {number[g]}"
        return f"total curvature is at least 2π; {least_of} turns least"

    outcome = IdentityValues(
        least,
        expected,
        16 * EPSILON * vertices,
        detail=detail,
        residual=np.maximum(expected - least, 0.0),
    )
    outcome.exclude(number < 0, "there is no closed boundary curve")
    return outcome
