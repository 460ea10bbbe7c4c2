"""Seams: boundary vertices at equal or nearly equal positions, and the boundary edges that welding would close."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..support.arrays import Index
from ..support.cache import cached
from ..support.words import counted
from .surface import Surface
from .topology import faces_at, find_edges
from .triangles import dot
from .welding import weld_exact, weld_within

# Largest gap of a seam, relative to the diagonal of the bounding box.
_WIDEST = 1e-3
# Beyond this gap vertices must be nearer to one another than their edges are long, by this factor.
_FINE, _APART = 1e-6, 10
# Smaller tolerances have no effect: coordinates are rounded, moved and scaled before they are compared.
_LEAST, _ROUNDING = 1e-12, 4e-16
# A tolerance ends before a gap that is wider by this factor; at most so many tolerances are tried.
_JUMP, _TRIED = 4, 6


class Effect(NamedTuple):
    """Effect of welding: boundary edges closed, additional edges with n_e > 2 (crowded), and faces dropped and kept of
    those with a merged corner.

    touched: True if a merged vertex lies on the boundary.
    """

    closed: int
    crowded: int
    dropped: int
    kept: int
    touched: bool


class Seam(NamedTuple):
    """Boundary vertices that nearly coincide, and the tolerance whose welding closes most boundary edges.

    vertices: (n,) indices. tolerance: relative to the diagonal, as `--weld` takes it. effect: of that welding.
    """

    vertices: NDArray[np.intp]
    tolerance: str
    effect: Effect


def effect(surface: Surface, lowest: NDArray[np.integer]) -> Effect:
    """Compute the effect of merging each vertex into (V,) `lowest`, from the faces at merged vertices."""
    old = surface.edges
    merged = np.zeros(surface.n_vertices, bool)
    merged[lowest[surface.referenced & (lowest != np.arange(len(lowest)))]] = True
    touched = merged[lowest]
    # Edges without a merged end are unchanged; the chosen faces contain all faces of the other edges.
    ours = touched[old.a] | touched[old.b]
    open_now, crowded_now = (int(np.count_nonzero(which & ours)) for which in (old.valence == 1, old.valence > 2))
    faces = lowest[surface.faces[faces_at(surface.faces, touched)]].astype(np.int32)
    kept = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    if not len(kept):
        return Effect(open_now, -crowded_now, len(faces), 0, bool(open_now))
    new = find_edges(kept, surface.n_vertices)
    ours = merged[new.a] | merged[new.b]
    open_then, crowded_then = (int(np.count_nonzero(which & ours)) for which in (new.valence == 1, new.valence > 2))
    dropped = len(faces) - len(kept)
    return Effect(open_now - open_then, crowded_then - crowded_now, dropped, len(kept), bool(open_now))


@cached
def exact_effect(surface: Surface) -> Effect:
    """Compute the effect of welding at exactly equal positions."""
    first, number = weld_exact(surface.xyz_given)
    return effect(surface, first[number])


def describe_exact_welding(surface: Surface) -> str:
    """Describe the effect of `--weld exact` on the boundary."""
    way_out = "--weld exact merges them"
    if not len(surface.boundary_half_edges):
        return way_out
    effect = exact_effect(surface)
    if not effect.touched:
        return f"{way_out}; none lies on the boundary"
    if effect.closed <= 0:
        return _with_crowded(way_out, effect)
    all_of = "all " if effect.closed == len(surface.boundary_half_edges) > 1 else ""
    return _with_crowded(f"--weld exact would close {all_of}{counted(effect.closed, 'boundary edge')}", effect)


def describe_closing(surface: Surface, seam: Seam) -> str:
    """Describe the effect of a seam's tolerance on the boundary."""
    boundary, closed = len(surface.boundary_half_edges), seam.effect.closed
    part = f"{closed:,} of " if closed < boundary else "all " if boundary > 1 else ""
    return _with_crowded(f"--weld {seam.tolerance} closes {part}{counted(boundary, 'boundary edge')}", seam.effect)


def _with_crowded(message: str, welded: Effect) -> str:
    if welded.crowded <= 0:
        return message
    return f"{message}, and more than two faces would meet at {counted(welded.crowded, 'edge')}"


def describe_best_welding(surface: Surface) -> str:
    """Describe the welding that closes most boundary edges, by tolerance or exactly; empty if none closes any."""
    seam = near_seam(surface)
    if seam is not None:
        return describe_closing(surface, seam)
    return (
        describe_exact_welding(surface) if len(surface.boundary_half_edges) and exact_effect(surface).closed > 0 else ""
    )


@cached
def near_seam(surface: Surface) -> Seam | None:
    """Find boundary vertices that nearly coincide; None unless welding them closes more edges than exact welding.

    Only boundary vertices are searched. The tolerance is the smallest of those before a jump in the gaps that closes
    the most; it is tried on the whole mesh, so that the counts are those of `--weld`.
    """
    if not len(surface.boundary_half_edges):
        return None
    tolerances = _tolerances(surface)
    if not tolerances:
        return None
    before = exact_effect(surface).closed
    best, most = tolerances[0], before
    for tolerance in tolerances if len(tolerances) > 1 else ():
        seam = _tried(surface, tolerance, surface.boundary)
        if seam is not None and seam.effect.closed > most:
            best, most = tolerance, seam.effect.closed
    whole = _tried(surface, best, None)
    return whole if whole is not None and whole.effect.closed > before else None


def _tried(surface: Surface, tolerance: str, among: NDArray[np.bool_] | None) -> Seam | None:
    """Try a tolerance on all vertices, or on some; None if it merges too much."""
    try:
        lowest = weld_within(surface.xyz_given, float(tolerance), among)
    except InputError:
        return None
    result = effect(surface, lowest)
    # Welding a seam drops no faces; it drops all faces of a thin strip, and a few slivers.
    if result.dropped > (0 if float(tolerance) > _FINE else result.kept / 4):
        return None
    number = np.bincount(lowest[surface.boundary], minlength=surface.n_vertices)
    vertices = np.flatnonzero(surface.boundary & (number[lowest] > 1))
    # Welding a seam closes about one edge per vertex; vertices that meet by chance close few.
    return Seam(vertices, tolerance, result) if 4 * result.closed >= len(vertices) else None


def _tolerances(surface: Surface) -> list[str]:
    """Candidate tolerances, ascending: the gaps before the widest jumps, rounded up to two digits."""
    gaps = np.sort(_gaps(surface))
    if not len(gaps):
        return []
    gaps = np.maximum(gaps + _ROUNDING, _LEAST)
    jump = np.append(gaps[1:] / gaps[:-1], np.inf)
    jumps = np.flatnonzero(jump >= _JUMP)
    widest = jumps[np.argsort(jump[jumps], kind="stable")[::-1][:_TRIED]]
    return [_rounded_up(float(gap)) for gap in np.sort(gaps[widest])]


def _rounded_up(value: float) -> str:
    """Round up to two significant digits, as text."""
    exponent = math.floor(math.log10(value)) - 1
    digits = math.ceil(value / 10.0**exponent * (1 - 1e-15))
    return f"{float(f'{digits}e{exponent}'):g}".replace("e-0", "e-")


def _gaps(surface: Surface) -> NDArray[np.float64]:
    """Distances to the nearest other boundary vertex, relative to the diagonal, that may be those of a seam."""
    from scipy.spatial import cKDTree

    used = surface.xyz_given[:, np.isfinite(surface.xyz_given).all(axis=0)]
    low: NDArray[np.float64] = used.min(axis=1)
    half: NDArray[np.float64] = used.max(axis=1) / 2 - low / 2
    scale = float(half.max())
    if scale == 0:
        return np.zeros(0)
    boundary = np.flatnonzero(surface.boundary)
    first, number = weld_exact(surface.xyz_given[:, boundary])
    if len(first) < 2:
        return np.zeros(0)
    points = (surface.xyz_given[:, boundary[first]] / 2 - low[:, None] / 2) / scale
    nearest = np.asarray(cKDTree(points.T).query(points.T, k=2)[0])[:, 1]
    distance = nearest / np.linalg.norm(half / scale)
    near = distance <= _WIDEST
    if not near.any():
        return np.zeros(0)
    coarse = near & (distance > _FINE)
    if coarse.any():
        shortest = np.full(len(first), np.inf)
        np.minimum.at(shortest, number, _shortest_edges(surface, boundary, low, scale))
        near &= ~coarse | (distance * _APART <= shortest)
    return np.asarray(distance[near], np.float64)


def _shortest_edges(
    surface: Surface, vertices: Index | NDArray[np.intp], low: NDArray[np.float64], scale: float
) -> NDArray[np.float64]:
    """(n,) the shortest edge of a face at each vertex, relative to the diagonal."""
    chosen = np.zeros(surface.n_vertices, bool)
    chosen[vertices] = True
    faces = surface.faces[faces_at(surface.faces, chosen)]
    shortest = np.full(surface.n_vertices, np.inf)
    corners = (surface.xyz_given[:, faces] / 2 - low[:, None, None] / 2) / scale
    for a, b in ((0, 1), (1, 2), (2, 0)):
        along = corners[..., b] - corners[..., a]
        length = np.sqrt(dot(along, along))
        for corner in (a, b):
            np.minimum.at(shortest, faces[:, corner], length)
    return shortest[vertices]
