"""Identities of curves: both sides, residual and error bound."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..mesh.triangles import EPSILON
from ..support.arrays import Floats, Mask
from .frames import Bishop, defined_round, shortest
from .plane import PlaneCurves
from .polygon import Curves
from .turning import Turning


@dataclass(frozen=True)
class Identity:
    """One identity on every curve.

    value, expected, residual, tolerance: (m,). excluded: reasons with the curves they exclude; the first one stands.
    detail: the compared quantities.
    """

    name: str
    value: Floats
    expected: Floats
    residual: Floats
    tolerance: Floats
    excluded: list[tuple[Mask, str]]
    detail: str


def identities(turning: Turning, plane: PlaneCurves, bishop: Bishop, writhe: tuple[Floats, Floats]) -> list[Identity]:
    """Evaluate all identities of curves without repeated points. writhe: in turns, and the bound of its error."""
    return list(_identities(turning, plane, bishop, *writhe))


def _identities(
    turning: Turning, plane: PlaneCurves, bishop: Bishop, turns: Floats, error: Floats
) -> Iterator[Identity]:
    curves = turning.curves
    open_, empty = (~curves.closed, "the curve is open"), (curves.edges == 0, "the curve has no edge")
    back = (curves.sum(turning.reversed) > 0, "the curve turns back on itself, where transport is undefined")
    gap, bound = fenchel(turning)
    yield Identity(
        "fenchel",
        turning.total,
        np.full(len(curves), 2 * np.pi),
        gap,
        bound,
        [empty, open_],
        "total curvature is at least 2π",
    )
    value = np.stack([curves.sum(component) for component in turning.vector])
    change = value - turning.tangent_change
    yield Identity(
        "tangent_change",
        _size(value),
        _size(turning.tangent_change),
        _size(change),
        _bound(curves, curves.sizes + curves.sum(turning.sin2)),
        [empty],
        "the curvature vectors add up to T(q) − T(p)",
    )
    signed, straight = plane.signed_total, np.isnan(plane.normal[0])
    whole = 2 * np.pi * np.rint(signed / (2 * np.pi))
    yield Identity(
        "turning_number",
        signed,
        whole,
        np.abs(signed - whole),
        _bound(curves, curves.sizes + turning.total),
        [empty, open_, (~plane.plane, "the curve is not plane"), back, (straight, "the curve is straight")],
        "the signed total curvature of a plane closed curve is a multiple of 2π",
    )
    total = 2 * np.pi * turns
    # The rotation across a vertex has no axis where the curve turns back; its error grows as 1 / cos(ψ/2).
    steep = curves.sum(1 / np.cos(np.minimum(turning.angle, np.pi) / 2))
    yield Identity(
        "holonomy",
        bishop.holonomy,
        total - 2 * np.pi * np.rint((total - bishop.holonomy) / (2 * np.pi)),
        shortest(bishop.holonomy - total),
        _bound(curves, steep + curves.sizes) + 2 * np.pi * error,
        [
            empty,
            open_,
            (~defined_round(turning), back[1]),
            (np.isnan(error), "the writhe was not computed"),
            (np.isnan(turns), "the writhe is undefined: the bound of its error exceeds a quarter of a turn"),
        ],
        "the holonomy of the parallel frame is 2π · writhe up to whole turns",
    )


def fenchel(turning: Turning) -> tuple[Floats, Floats]:
    """(m,) twice: the shortfall of the total curvature of a closed curve from 2π, and its rounding error bound."""
    curves = turning.curves
    return np.maximum(2 * np.pi - turning.total, 0.0), 16 * EPSILON * np.maximum(curves.sizes, 1)


def _bound(curves: Curves, absolute: Floats) -> Floats:
    """(16 + log₂ n) ε times the sum of the absolute terms."""
    return (16 + np.log2(np.maximum(curves.sizes, 1))) * EPSILON * absolute


def _size(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt((vectors * vectors).sum(axis=0)))
