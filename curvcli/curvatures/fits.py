"""Curvatures of local fits of a polynomial over the tangent plane."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..mesh.scale import Scale
from ..mesh.surface import Surface
from ..mesh.triangles import dot
from ..support.arrays import Column, Flags, Floats, VectorColumn
from ..support.blocks import for_each
from .kernels.jets import QUADRATIC, Jets, fit
from .kernels.moments import Moments, moments
from .kernels.tensor import line
from .quantity import FlagNotice, Quantity
from .registry import curvature_pass
from .star import null_where

_SHARED: dict[str, Any] = {
    "boundary": "same, from one side; null where the neighbourhood does not determine a quadric, or is no graph over "
    "its tangent plane",
    "source": "Cazals and Pouget, Estimating differential quantities using polynomial fitting of osculating jets; "
    "degrees 3 and 4 as far as residuals tell them from noise: curvcli",
}
_DENSITY: dict[str, Any] = {"kind": "density", "signed": True, **_SHARED}
_KAPPA: dict[str, Any] = {
    "length_exponent": -1,
    "parity": "odd",
    "preserves": "κ₁ + κ₂ = h_fit and κ₁ κ₂ = K_fit; κ₁ ≥ κ₂",
    **_DENSITY,
}
_LINE: dict[str, Any] = {
    "kind": "direction",
    "vector": True,
    "line": True,
    "preserves": "dir_1_fit ⊥ dir_2_fit, both tangential to the fitted surface",
    **_SHARED,
}
# Principal curvatures that differ by less than this part of their size, or by rounding, have no directions.
_UMBILIC = 1e-9
# Ratio of the projected area of a half sphere to its area.
_HALF_SPHERE = 0.5


@curvature_pass(
    provides=(
        Quantity(
            "K_fit",
            symbol="K",
            formula="det of the shape operator of the fitted graph at the vertex",
            length_exponent=-2,
            preserves="nothing in sum; exact on planes, of second order and more on smooth surfaces",
            description="Gauss curvature of the local fit, per area: the best estimate at a point of a smooth surface.",
            **_DENSITY,
            after="dir_2_corrected",
        ),
        Quantity(
            "h_fit",
            symbol="H",
            formula="trace of the shape operator of the fitted graph at the vertex",
            length_exponent=-1,
            mean_degree=1,
            parity="odd",
            preserves="nothing in sum; exact on planes, of second order and more on smooth surfaces",
            description="Mean curvature κ₁ + κ₂ of the local fit, positive where convex.",
            **_DENSITY,
            after="K_fit",
        ),
        Quantity(
            "kappa_1_fit",
            symbol="κ₁",
            formula="the larger eigenvalue of the shape operator of the fit",
            partner="kappa_2_fit",
            description="Larger principal curvature of the local fit.",
            **_KAPPA,
            after="h_fit",
        ),
        Quantity(
            "kappa_2_fit",
            symbol="κ₂",
            formula="the smaller eigenvalue of the shape operator of the fit",
            partner="kappa_1_fit",
            description="Smaller principal curvature of the local fit.",
            **_KAPPA,
            after="kappa_1_fit",
        ),
        Quantity(
            "dir_1_fit",
            symbol="**e**₁",
            formula="eigenvector of the shape operator of the fit to κ₁",
            partner="dir_2_fit",
            description="Direction of κ₁ of the local fit, a line: of unit length, its largest component positive.",
            **_LINE,
            after="kappa_2_fit",
        ),
        Quantity(
            "dir_2_fit",
            symbol="**e**₂",
            formula="eigenvector of the shape operator of the fit to κ₂",
            partner="dir_1_fit",
            description="Direction of κ₂ of the local fit, a line: of unit length, its largest component positive.",
            **_LINE,
            after="dir_1_fit",
        ),
        Quantity(
            "condition_fit",
            symbol="κ(Φ)",
            formula="√(tr N tr N⁻¹), N = ΦᵀΦ of degree 2 in units of the neighbourhood; 6 is the least",
            kind="ratio",
            preserves="invariant under scaling",
            description="Condition of the local fit of degree 2: how much it can magnify errors of the positions.",
            **_SHARED,
            after="dir_2_fit",
        ),
        Quantity(
            "no_graph",
            kind="flag",
            public=False,
            notice=FlagNotice(
                "no_graph",
                "[vertex|vertices] whose neighbourhood{scale} folds over or bends more than a graph over its tangent "
                "plane can; local fits are undefined there",
                "*_corrected needs no plane; take a smaller scale or a finer mesh",
                after="h_below_noise",
            ),
        ),
    )
)
def local_fit(surface: Surface, scale: Scale, star_vector: VectorColumn) -> tuple[Column | VectorColumn | Flags, ...]:
    """Curvatures of the polynomial of least squares over the tangent plane of each vertex, at a stated scale.

    Flags say where they are left null because the neighbourhood is no graph over that plane: see `_is_no_graph`.
    """
    folded = np.zeros(surface.n_vertices, bool)
    numbers, lines = np.full((5, surface.n_vertices), np.nan), np.full((2, 3, surface.n_vertices), np.nan)

    def work(made: Callable[[], Moments]) -> None:
        given = made()
        jets = fit(given)
        numbers[:, given.vertex], lines[:, :, given.vertex] = _curvatures(given, jets)
        folded[given.vertex] = np.isfinite(jets.condition) & _is_no_graph(given, jets)

    for_each(moments(surface, scale, star_vector, least=QUADRATIC), work)
    numbers[:-1, folded] = lines[:, :, folded] = np.nan
    without = surface.without_orientation
    gauss, mean, larger, smaller, condition = numbers
    odd = (null_where(without, column) for column in (mean, larger, smaller, lines[0], lines[1]))
    return gauss, *odd, condition, folded


def _is_no_graph(given: Moments, jets: Jets) -> Flags:
    """(m,) mask of the neighbourhoods that are no graph over the tangent plane, by their normals and fits.

    The largest graph on a sphere of radius 1/κ is a half sphere: its projection has half of its area, and its points
    are within √2/κ of the centre. A neighbourhood is no graph if its projected area is less, or if the fit puts its
    points farther away: with its shape operator S, and κ its larger curvature by size, the mean of |S x|² + (κ z)²
    exceeds 2.
    """
    p, q = jets.gradient
    a, b, d = jets.hessian / np.sqrt(1 + p * p + q * q)
    larger = 0.5 * np.abs(a + d) + np.hypot(0.5 * (a - d), b)
    across = (a * a + b * b) * given.of(2, 0) + 2 * b * (a + d) * given.of(1, 1) + (b * b + d * d) * given.of(0, 2)
    far = across + larger * larger * given.squared_height > 2 * given.size
    return np.asarray((given.shadow < _HALF_SPHERE) | far)


def _curvatures(given: Moments, jets: Jets) -> tuple[Floats, Floats]:
    """(5, m) K, H, κ₁, κ₂ and condition, and (2, 3, m) principal directions of the graph at the vertex.

    With I = R Rᵀ the first fundamental form, R lower triangular, the shape operator in an orthonormal tangent frame is
    R⁻¹ II R⁻ᵀ.
    """
    p, q = jets.gradient
    # A graph that bends away from its normal is convex.
    a, b, d = -jets.hessian / np.sqrt(1 + p * p + q * q)
    # R = ((first, 0), (skew, second)); a, b, d change from the entries of II to those of the shape operator.
    first = np.sqrt(1 + p * p)
    skew = p * q / first
    second = np.sqrt(1 + p * p + q * q) / first  # √(1 + q² − skew²) without its cancellation
    a, b = a / (first * first), b / first
    b = (b - skew * a) / second
    # (d − 2 skew b₀ + skew² a)/second², where b₀ = second · b + skew · a is b before the last step.
    d = (d - 2 * skew * second * b - skew * skew * a) / (second * second)
    half, gap = 0.5 * (a + d), np.hypot(0.5 * (a - d), b)
    turn = 0.5 * np.arctan2(b, 0.5 * (a - d))
    lines = np.empty((2, 3, len(p)))
    for target, (s, t) in zip(lines, ((np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))), strict=True):
        # R⁻ᵀ takes the orthonormal frame to the parameters.
        y = t / second
        x = (s - skew * y) / first
        vector = x * given.frame[0] + y * given.frame[1] + (p * x + q * y) * given.frame[2]
        target[:] = line(vector / np.sqrt(dot(vector, vector)))
    lines[:, :, ~(gap > np.maximum(_UMBILIC * (np.abs(half) + gap + jets.size), jets.rounding))] = np.nan
    return np.array([a * d - b * b, a + d, half + gap, half - gap, jets.condition]), lines
