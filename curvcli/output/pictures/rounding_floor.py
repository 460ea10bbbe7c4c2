"""Rounding floor of a column: values that rounding alone can explain, which a picture must not paint as curvature."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ...curvatures.catalogue import UNCERTAINTIES
from ...curvatures.quantity import AT_SCALE, Quantity
from ...mesh.precision import is_single, last_place
from ...mesh.topology import next_corner
from ...mesh.triangles import EPSILON
from ...support.arrays import Floats
from ...support.blocks import slices
from ...support.cache import cached

if TYPE_CHECKING:
    from ...analysis.result import Result


# Rounding of an angle defect of exact coordinates.
_DEFECT = 16 * EPSILON * 2 * np.pi
# Coordinates of a flat star that move by half the last place on either side bend it by κA = 4√3 of it at most.
_LIFTED = 4 * np.sqrt(3)
# A map has 511 colours: a value smaller than this part of its range has the colour of 0.
_UNSEEN = 1 / 1022

_STAR = ("h", "h_signed", "h_hks", "h_perp", "h_normal")
_SIGNED = ("h_signed", "h_normal", "kappa_1", "kappa_2")
_KAPPAS = ("kappa_1", "kappa_2", "kappa_max", "curvedness")
_DEFECTS = ("K", "K_plus", "K_minus", "K_abs")
_ENERGIES = ("willmore", "willmore_hks", "willmore_perp", "willmore_normal")
_OF_STARS = (*_DEFECTS, *_STAR, *_KAPPAS, *_ENERGIES, "K_density", "H_vec", "area_gradient")
_ESTIMATES = ("_ring", "_corrected", "_fit")


def _name(quantity: Quantity) -> tuple[str, str]:
    """The name without its scale, and the ending of an estimate with its scale; "" for other quantities."""
    base, _, scale = quantity.name.partition(AT_SCALE)
    ending = next((ending for ending in _ESTIMATES if base.endswith(ending)), "")
    return base, f"{ending}{AT_SCALE}{scale}" if ending and scale else ending


def floor_needs(quantity: Quantity) -> set[str]:
    """The quantities that `floor` takes from the result beside the star sums."""
    base, at = _name(quantity)
    if at and quantity.kind == "measure":
        return {f"h{at}", "h"}
    if at and quantity.kind == "density":
        return {f"kappa_1{at}", f"kappa_2{at}"} if quantity.length_exponent == -2 else set()
    if base in (*_KAPPAS, *_ENERGIES, "K_density"):
        return {"h", "K", "K_density"}
    return {"h"} if base in _SIGNED else set()


def floor(analysis: Result, quantity: Quantity, values: Floats) -> Floats | None:
    """(V,) bound on each value due to rounding alone, in the file's unit; None where no colour could show it.

    Coordinates are rounded to doubles, or to float32 where they all are such numbers; the bound is the largest of V
    normal deviations, 1 + √(2 ln V) standard deviations as `K_sigma` and `h_sigma` propagate them, and the rounding of
    an angle defect. Estimates at a scale are flat where they lift a star by less than the last place. 0 where a value
    is exact.
    """
    base, at = _name(quantity)
    bound: Callable[[_Rounding], Floats] | None = None
    if at and quantity.kind in ("density", "measure"):
        bound = lambda rounding: rounding.estimate(quantity, at)  # noqa: E731
    elif base in _OF_STARS:
        bound = lambda rounding: rounding.of_star(base)  # noqa: E731
    known = np.abs(values[np.isfinite(values)])
    if bound is None or not len(known):
        return None
    zero = values == 0
    # An H whose sign is rounding is 0 already; its size shows that it is not exactly 0.
    settled = zero & (np.nan_to_num(analysis.computed("h")) != 0) if base in _SIGNED else np.zeros(len(values), bool)
    rounding = _Rounding(analysis)
    bounds = np.zeros(len(values))
    if known.any():
        # If even a coarse bound is exceeded, or a value has the colour of 0 anyway, no finer bound is computed. The
        # coarsest needs no sweep over the faces: at 1,000,000 vertices it saves a sixth of the time of a coloured PLY.
        seen = np.abs(values) > _UNSEEN * np.median(known)
        effects = (rounding.coarse_effects, lambda: _turns(analysis)[1:])
        if all((np.abs(values) <= rounding.reach(quantity, *effect()))[seen].any() for effect in effects):
            bounds = analysis.surface.in_file_unit(bound(rounding), quantity.length_exponent)
            bounds = bounds * (0.5**quantity.mean_degree if analysis.conventions.mean == "average" else 1.0)
    bounds = np.where(zero, np.where(settled, np.finfo(np.float64).tiny, 0.0), bounds)
    return bounds if (np.abs(values) <= bounds)[bounds > 0].any() else None


def edge_floor(analysis: Result, theta: Floats) -> Floats:
    """(E,) 0, and infinity where rounding of the coordinates may turn the two faces at an edge by all of θ."""
    edges = analysis.surface.edges
    place, _, _ = _turns(analysis)
    bounds = np.zeros(len(edges))
    for block in slices(len(edges.pairs[0])):
        inner = edges.inner_edges(block)
        with np.errstate(divide="ignore", invalid="ignore"):
            faces = (inner.half_edge // 3, inner.twin // 3)
            turn = sum(place * _longest(analysis)[face] / analysis.columns["face_area"][face] for face in faces)
            bounds[inner.where] = np.where(
                (theta[inner.where] != 0) & (np.abs(theta[inner.where]) <= 4 * turn + _DEFECT), np.inf, 0.0
            )
    return bounds


class _Rounding:
    """Bounds in the unit of computation, for H = κ₁ + κ₂."""

    def __init__(self, analysis: Result) -> None:
        self.column = analysis.computed
        self.area: Floats = analysis.columns["star_area"]
        self.analysis = analysis

    @property
    def place(self) -> float:
        """Last place of the coordinates."""
        return _turns(self.analysis)[0]

    @property
    def pulled(self) -> Floats:
        """Largest effect of the last place on the centre of each star."""
        return _turns(self.analysis)[2]

    def coarse_effects(self) -> tuple[Floats, Floats]:
        """Bounds of `_turns` from the smallest face: no edge of a star is longer than the star's extent."""
        extent, face_area = self.analysis.columns.get("star_extent"), self.analysis.columns["face_area"]
        smallest = face_area.min()
        if extent is None or not smallest > 0:
            infinite = np.full(len(self.area), np.inf)
            return infinite, infinite
        with np.errstate(over="ignore"):
            turned = 8 * _place(self.analysis) / smallest * extent
            return turned, turned * extent

    def reach(self, quantity: Quantity, turned: Floats, pulled: Floats) -> Floats:
        """Coarse bound in the file's unit: the effect of faces that turn by the last place over their heights."""
        reach = self._reach(quantity, turned, pulled)
        return self.analysis.surface.in_file_unit(reach, quantity.length_exponent)

    def _reach(self, quantity: Quantity, turned: Floats, pulled: Floats) -> Floats:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            K, h = turned + _DEFECT, pulled / self.area
            reach = {0: K, -1: h, -2: K / self.area, 1: pulled}.get(quantity.length_exponent, np.inf + h)
            if quantity.name.partition(AT_SCALE)[0] in _KAPPAS:
                reach = h + np.sqrt(h * (np.abs(self.column("h")) + h) + K / self.area)
            elif quantity.mean_degree == 2:
                reach = h * (2 * np.abs(self.column("h")) + h) * self.area
        return np.asarray(np.nan_to_num(reach, nan=0.0))

    def of_star(self, name: str) -> Floats:
        """Bound for a column of stars."""
        sigma_K, sigma_h = _sigmas(self.analysis)
        if name in _DEFECTS:
            return sigma_K
        if name in _STAR:
            return sigma_h
        if name in ("H_vec", "area_gradient"):
            return np.where(np.isnan(sigma_h), self.pulled, sigma_h * self.area)  # h is null on the boundary
        h, K, density = (self.column(key) for key in ("h", "K", "K_density"))
        if name in _ENERGIES:
            return np.asarray((2 * h + sigma_h) * sigma_h * self.area)
        with np.errstate(divide="ignore", invalid="ignore"):
            sigma = np.where(K == 0, sigma_K / self.area, np.abs(density / K) * sigma_K)
            if name == "K_density":
                return sigma
            radicand = 0.5 * h * sigma_h + 0.25 * sigma_h**2 + sigma
            root = np.sqrt(np.maximum(0.25 * h * h - density, 0.0))
            return np.asarray(0.5 * sigma_h + np.fmin(np.sqrt(radicand), radicand / root))

    def estimate(self, quantity: Quantity, suffix: str) -> Floats:
        """Bound for a density or an energy at a scale."""
        with np.errstate(divide="ignore"):
            lifted = np.where(self.area > 0, _LIFTED * self.place / self.area, 0.0)
            defect = np.where(self.area > 0, _DEFECT / self.area, 0.0)
        if quantity.kind == "measure":
            h = np.abs(self.column(f"h{suffix}"))
            return np.asarray((2 * h + 2 * lifted) * 2 * lifted * self.area)
        if quantity.length_exponent == -2:
            kappa = np.fmax(*(np.abs(self.column(f"kappa_{k}{suffix}")) for k in (1, 2)))
            return np.asarray((2 * kappa + lifted) * lifted + defect)
        return 2 * lifted if quantity.mean_degree else lifted


def _place(analysis: Result) -> float:
    """Last place of the coordinates, of float32 where they all are such numbers."""
    surface = analysis.surface
    return last_place(surface, np.float32 if is_single(surface.xyz_given) else np.float64)


@cached
def _turns(analysis: Result) -> tuple[float, Floats, Floats]:
    """Last place of the coordinates, and its largest effect on the faces of each star and on its centre."""
    surface, face_area = analysis.surface, analysis.columns["face_area"]
    place = _place(analysis)
    a, longest = surface.faces.ravel(), _longest(analysis)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        turn = np.nan_to_num(8 * place * longest / face_area)
    turned, pulled = (np.bincount(a, np.repeat(each, 3), surface.n_vertices) for each in (turn, turn * longest))
    return place, turned.astype(np.float64), pulled.astype(np.float64)


@cached
def _longest(analysis: Result) -> Floats:
    """(F,) longest edge of each face."""
    surface = analysis.surface
    a, b = (surface.faces.ravel()[corner] for corner in (slice(None), next_corner(np.arange(3 * surface.n_faces))))
    longest: Floats = np.sqrt(sum((x[a] - x[b]) ** 2 for x in surface.xyz)).reshape(-1, 3).max(axis=1)
    return longest


@cached
def _sigmas(analysis: Result) -> tuple[Floats, Floats]:
    """Bounds of K and h."""
    surface = analysis.surface
    noise = float(np.ldexp(_turns(analysis)[0], surface.unit_exponent)) / np.sqrt(12)
    sigmas = analysis.with_noise(UNCERTAINTIES, noise)
    extreme = 1 + np.sqrt(2 * np.log(max(surface.n_vertices, 2)))
    K, h = (extreme * sigmas[name] for name in UNCERTAINTIES)
    return K + _DEFECT, h
