"""Notices of stars at the wrong scale: estimates beside them, rough meshes and creased meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..curvatures.engine import evaluate
from ..curvatures.quantity import AT_SCALE, Quantity
from ..curvatures.registry import passes
from ..errors import Notice
from ..mesh.precision import is_single, last_place
from ..mesh.scale import Scale
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, dot
from ..support.words import format_rounded
from .distortion import FACTOR, distorted_stars

_SCALED = ("willmore_ring", "willmore_corrected", "willmore_fit")
_ENERGIES = ("willmore", "willmore_hks", "willmore_perp", "willmore_normal", "helfrich")
STARS = (
    *("h", "h_signed", "h_hks", "h_perp", "h_normal", "K_density", "kappa_1", "kappa_2", "kappa_max"),
    *("shape_index", "curvedness", *_ENERGIES),
)
# Faces and vertices that are sampled, at equal steps.
_SAMPLE = 1 << 14
# An edge that bends more than the angular step of a coarse export is sharp; one that bends a twentieth of it is flat.
SHARP = np.pi / 6
_FLAT = 1 / 20

# Names of columns of stars start with the quantity; names of estimates, with the curvature alone.
_STAR_ALONE = ("_density", "_signed")


def counterparts(quantity: Quantity) -> list[str]:
    """Estimates at a scale of the curvature that a column of stars has: `h_ring`, `h_corrected`, … for `h_signed`."""
    if passes.depends_on_scale(quantity.name) or quantity.on != "vertex":
        return []
    stem = quantity.name
    for ending in _STAR_ALONE:
        stem = stem.removesuffix(ending)
    alike = quantity.kind, quantity.length_exponent, quantity.vector
    return [
        other.name
        for other in passes.quantities("vertex")
        if other.name.startswith(f"{stem}_")
        and passes.depends_on_scale(other.name)
        and (other.kind, other.length_exponent, other.vector) == alike
    ]


def not_at_scale(chosen: Iterable[str], scales: tuple[Scale, ...]) -> Iterator[Notice]:
    """Notice of chosen columns that ignore the given scale although estimates of the same curvature have one.

    A column is left out if one of its estimates is chosen too.
    """
    base_names = {name.partition(AT_SCALE)[0] for name in chosen}
    alternatives = {name: counterparts(passes.quantity(name)) for name in sorted(base_names)} if scales else {}
    missed = {name: others for name, others in alternatives.items() if others and base_names.isdisjoint(others)}
    if missed:
        best = [
            next((other for other in others if other.endswith("_corrected")), others[0]) for others in missed.values()
        ]
        at = ", ".join(str(scale) for scale in scales)
        yield Notice.of(
            "not_at_scale",
            [],
            f"[column|columns] of single stars, not at the scale asked for ({at}): {', '.join(missed)}",
            f"-p {','.join(best)} [is|are] at that scale",
            len(missed),
        )


def needs_of_stars(chosen: Iterable[str]) -> tuple[str, ...]:
    """Columns that `star_notices` needs to judge the chosen ones."""
    base_names = {name.partition(AT_SCALE)[0] for name in chosen}
    return () if base_names.isdisjoint(STARS) else ("h_signed",)


def star_notices(
    surface: Surface, columns: Mapping[str, Any], chosen: Iterable[str], totals: Mapping[str, Any], asked: bool
) -> Iterator[Notice]:
    """Notices of densities and energies of stars: on a creased mesh, and of energies on a rough one.

    chosen: the columns shown. totals: by the report's keys. asked: whether a scale is given.
    """
    if "h_signed" not in columns or not needs_of_stars(chosen):
        return
    sharp = creases(surface, columns)
    if len(sharp):
        yield Notice.at(
            "creased",
            sharp,
            f"[edge|edges] that [bends|bend] more than {np.degrees(SHARP):.0f}° and [carries|carry] most of the bend; "
            "most other edges are flat: the density of a star divides the bend of an edge by whatever triangles are "
            "next to it",
            "read theta, and kappa_across for fillets (--table edges=PATH, --color-by theta); the sums of K and "
            "H_vec stay exact",
        )
        return
    vertices, part = distorted_stars(surface, columns)
    if len(vertices):
        yield Notice.at(
            "distorted_stars",
            vertices,
            "[vertex|vertices] whose triangles are so thin or obtuse that h and K_density of [its star|their stars] "
            f"would be wrong by more than a factor of {FACTOR} on a sphere; [it carries|they carry] {part:.0%} of Σ|K|",
            "read *_corrected or *_fit there, or remesh where angle_max is large (--table faces=PATH); the sums of K, "
            "H_vec and A stay exact",
        )
    shown = {key: totals[key] for key in _ENERGIES if totals.get(key) is not None}
    if not shown:
        return
    noise = roughness(surface, columns)
    corrected = "helfrich_corrected" if set(shown) == {"helfrich"} else "willmore_corrected"
    scaled = {passes.quantity(name).total or "": name for name in chosen if name.partition(AT_SCALE)[0] in _SCALED}
    at_scale = {key: totals[key] for key in scaled if totals.get(key) is not None}
    if noise is None and asked:
        yield from _apart(columns, {key: scaled[key] for key in at_scale}, shown | at_scale)
    elif noise is not None:
        values = ", ".join(
            f"{key} = {format_rounded(value, 4)}" for key, value in (shown | at_scale).items() if value is not None
        )
        yield Notice.of(
            "rough_energy",
            [],
            f"[energy|energies] of stars, of which {noise:.0%} is at the scale of single edges: noise, steps or uneven "
            f"triangles, not the surface ({values})",
            "compare the totals at a scale; where they agree, trust them"
            if at_scale
            else f"-p {corrected} at a --radius or --rings above the steps is that of the surface behind them",
            len(shown),
        )


def _apart(columns: Mapping[str, Any], scaled: Mapping[str, str], totals: Mapping[str, Any]) -> Iterator[Notice]:
    """Notice of energies at a scale that differ by more than a factor of 2 from that of stars, where this is no noise.

    Only vertices where both are known are compared, and only where stars resolve the energy: not on minimal surfaces.
    """
    star = columns["h_signed"] ** 2 * columns["star_area"]
    square, bend = np.nan_to_num(star), np.nan_to_num(-2 * columns["K"])
    turned = columns["star_area"] - np.sqrt(dot(columns["star_vector"], columns["star_vector"]))
    known = np.isfinite(star)
    if (
        not square.sum() * columns["star_area"][known].sum()
        > 2 * turned[known].sum() * np.maximum(square + bend, 0.5 * square).sum()
    ):
        return
    differing = []
    for key, name in scaled.items():
        both = known & np.isfinite(columns[name])
        energy, scaled_energy = float(star[both].sum()), float(columns[name][both].sum())
        if not energy <= 2 * scaled_energy <= 4 * energy:
            differing.append(key)
    if differing:
        values = ", ".join(f"{key} = {format_rounded(value, 4)}" for key, value in totals.items())
        yield Notice.of(
            "energy_at_scale",
            [],
            "[energy|energies] at a scale that [differs|differ] by more than a factor of 2 from that of stars, "
            f"which is coherent from vertex to vertex: {', '.join(differing)} ({values})",
            "the scale is wide against the shape, or sheets that lie near each other meet in it: take a smaller one",
            len(differing),
        )


def roughness(surface: Surface, columns: Mapping[str, Any]) -> float | None:
    """Share of the Willmore energy of stars that is noise from vertex to vertex; None where the surface explains it.

    Averaging H over the corners of each face leaves a third of independent noise, and of a smooth H all but what is
    proportional to the squared edge: with the ratio r of the energies the noise is 3(1 − r)/2. It is reported where it
    is more than half, and more of ∫κ₁² + κ₂² than the normals turn within a star, 2(1 − |**A**_p|/A_p): errors of the
    discretisation are smaller than that on a mesh which resolves its surface.
    """
    faces = slice(None, None, max(surface.n_faces // _SAMPLE, 1))
    H, area = columns["h_signed"][surface.faces[faces]], columns["face_area"][faces]
    known = np.isfinite(H).all(axis=1)
    H, area = H[known], area[known]
    energy = float(area @ (H * H).mean(axis=1))
    if not energy > 0:
        return None
    noise = 1.5 * (1 - float(area @ H.mean(axis=1) ** 2) / energy)
    vertices = slice(None, None, max(surface.n_vertices // _SAMPLE, 1))
    h, K, star, vector = (columns[key][..., vertices] for key in ("h_signed", "K", "star_area", "star_vector"))
    known = np.isfinite(h) & np.isfinite(K) & (star > 0)
    h, K, star, vector = h[known], K[known], star[known], vector[:, known]
    if not len(star):
        return None
    square = h * h * star
    bend = float(np.maximum(square - 2 * K, 0.5 * square).sum())
    turned = 2 * float((star - np.sqrt(dot(vector, vector))).sum()) / float(star.sum())
    place = last_place(surface, np.float32 if is_single(surface.xyz_given) else np.float64)
    rounding = max(16 * float((place * place / star).mean()), 64 * EPSILON)
    with np.errstate(over="ignore"):
        unresolved = noise * float(square.sum()) > max(turned, rounding) * bend and turned > rounding
    return min(noise, 1.0) if noise > 0.5 and unresolved else None


def creases(surface: Surface, columns: Mapping[str, Any]) -> NDArray[np.intp]:
    """Sharp edges of a creased mesh; empty for other meshes.

    They are fewer than half of its edges and carry more than half of Σ|θ||e|, and at least half of all edges are flat
    beside them; the other edges may bend by at most two steps of a coarse tessellation on average.
    """
    none = np.empty(0, np.intp)
    if not _bent_at_few(columns):
        return none
    columns_of_edges = evaluate(passes, surface, ["theta", "edge_length"], known=columns)
    theta, length = np.abs(columns_of_edges["theta"]), columns_of_edges["edge_length"]
    known = np.isfinite(theta)
    sharp = known & (theta > SHARP)
    count, edges = int(np.count_nonzero(sharp)), int(np.count_nonzero(known))
    if not 0 < 2 * count < edges:
        return none
    bend = np.where(known, theta * length, 0.0)
    mean = float(theta[sharp].mean())
    flat = int(np.count_nonzero(theta < _FLAT * mean))
    beside = edges if mean < 2 * SHARP else edges - count
    return np.flatnonzero(sharp) if 2 * bend[sharp].sum() > bend.sum() and 2 * flat >= beside else none


def _bent_at_few(columns: Mapping[str, Any]) -> bool:
    """True if more than half of Σ|**H**_p| may lie at stars that a sharp edge crosses; computed without the edges.

    If an edge of angle φ splits a star into equal halves, |**A**_p| = A_p cos(φ/2); a quarter of 1 − |**A**_p|/A_p
    allows for uneven parts.
    """
    vector, area = columns["star_vector"], columns["star_area"]
    size = np.sqrt(dot(vector, vector))
    pull = np.nan_to_num(np.abs(columns["h_signed"]) * size)
    bent = size < area * (1 - (1 - np.cos(SHARP / 2)) / 4)
    return bool(2 * pull[bent].sum() > pull.sum())
