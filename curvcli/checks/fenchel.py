"""Closed curves turn at least once round."""

from __future__ import annotations

import numpy as np

from ..blocks import EPSILON
from ..curves.loops import boundary_of
from ..curves.turning import Turning
from ..groups import Groups
from ..surface import Surface
from .base import Outcome, check


@check(
    gap="2π − Σψ",
    applies="where there is a closed boundary curve; the loop that turns least is tested",
    bound="16ε · vertices of the loop",
    failure="a turning angle of a boundary loop is wrong, or the loop is not walked as it runs.",
)
def fenchel(surface: Surface, groups: Groups) -> Outcome:
    """Every closed boundary curve has total curvature Σψ ≥ 2π, with equality if it is plane and convex."""
    least, vertices = np.full(groups.count, np.inf), np.ones(groups.count)
    number = np.full(groups.count, -1)
    if surface.boundary.any():
        boundary = boundary_of(surface)
        turning = Turning(boundary.curves.distinct()[0])
        curves = turning.curves
        # Of the curves of each group the one that turns least; curves that are a single point do not turn at all.
        group = groups.face[boundary.half_edge[boundary.start[:-1]] // 3]
        usable = np.flatnonzero(curves.closed & (curves.edges > 0) & (group >= 0))
        usable = usable[np.argsort(turning.total[usable], kind="stable")[::-1]]
        number[group[usable]] = usable
        some = number >= 0
        least[some], vertices[some] = turning.total[number[some]], curves.sizes[number[some]]
    expected = np.full(groups.count, 2 * np.pi)
    outcome = Outcome(
        least,
        expected,
        16 * EPSILON * vertices,
        detail=lambda g: f"total curvature is at least 2π; loop {number[g]} turns least",
        residual=np.maximum(expected - least, 0.0),
    )
    outcome.exclude(number < 0, "there is no closed boundary curve")
    return outcome
