"""Agreement in digits with 50-digit arithmetic, the Surface Evolver, libigl and VTK."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from tests.helpers import exact_values, meshes

from .. import peers

Floats = NDArray[np.float64]

# Quotients that mean nothing where |H| is rounding, or 0 by symmetry.
ILL_POSED = {
    "catenoid_minimal": (
        "h_normal",
        "willmore_normal",
        "h",
        "h_signed",
        "h_hks",
        "h_perp",
        "H_vec",
        "willmore",
        "willmore_hks",
        "willmore_perp",
        "H_rectified",
        "folding_index",
    ),
    "monkey_saddle": ("h_normal", "willmore_normal"),
}


def digits(error: float) -> str:
    """Decimal digits that agree; those of a double are 16."""
    return "all" if error == 0 else f"{min(16.0, -np.log10(error)):.1f}"


def gap(found: Any, wanted: Any, size: float) -> float:
    """The largest difference as a part of a size; NaN must stand in the same places."""
    found, wanted = np.asarray(found, np.float64), np.asarray(wanted, np.float64)
    if not np.array_equal(np.isnan(found), np.isnan(wanted)):
        return float("inf")
    known = ~np.isnan(wanted)
    return float(abs(found - wanted)[known].max() / size) if known.any() else 0.0


def exact() -> list[tuple[str, str, float, str]]:
    """For each column its element, its name, the worst difference as a part of its largest value, and the mesh."""
    worst: dict[tuple[str, str], tuple[float, str]] = {}
    for name, path in exact_values.MESHES.items():
        analysis = curvcli.analyze(path, "all")
        tables = {
            "vertex": (analysis.vertices, exact_values.Vertices(name).columns()),
            "edge": (analysis.edges, exact_values.edges(name)),
        }
        referenced = analysis.surface.referenced
        for element, (ours, theirs) in tables.items():
            for column in ours.keys() & theirs.keys():
                if column in ILL_POSED.get(name, ()) or column == "degree":
                    continue
                found, wanted = np.array(ours[column], np.float64), theirs[column].copy()
                if element == "vertex":
                    found, wanted = found[referenced], wanted[referenced]
                known = abs(wanted[~np.isnan(wanted)])
                # Angles are compared absolutely: a sum of them may be 0 everywhere.
                size = 1.0 if column in ANGLES else float(known.max()) if known.size and known.max() > 0 else 1.0
                error = gap(found, wanted, size)
                key = (element, column)
                worst[key] = max(worst.get(key, (0.0, name)), (error, name))
    return [(element, column, *worst[element, column]) for element, column in sorted(worst, reverse=True)]


ANGLES = {"K", "kappa_g", "K_comb", "K_plus", "K_minus", "K_abs", "willmore_conformal", "theta", "beta"}
ANGLES |= {"K_positive", "K_negative", "K_rectified", "intrinsic_index"}


@dataclass(frozen=True)
class Row:
    """One comparison: what of them, what of ours, the differences inside and on the boundary, and why."""

    theirs: str
    ours: str
    inside: str
    boundary: str
    why: str


def evolver() -> list[tuple[str, str, float]] | None:
    """Named method, our total, worst relative difference over the bodies; None where the Evolver is not installed."""
    from tests.properties import test_evolver as tier

    if tier.PROGRAM is None:
        return None
    worst: dict[str, float] = {}
    for make in tier.BODIES.values():
        body = make()
        totals = curvcli.analyze((body.points, body.faces), "all").totals
        with tempfile.TemporaryDirectory() as folder:
            answer = tier.ask(body, Path(folder)).totals
        for method, (key, factor) in tier.TOTALS.items():
            value = totals[key]
            if not isinstance(value, float) or np.isnan(answer[method]):
                continue
            # The conformal energy is the rest of sums of angles that cancel.
            size = np.pi * len(body.points) if key == "willmore_conformal" else abs(factor * value)
            worst[method] = max(worst.get(method, 0.0), abs(answer[method] - factor * value) / size)
    return [(method, f"{factor:g} totals.{key}", worst[method]) for method, (key, factor) in tier.TOTALS.items()]


def _bodies() -> dict[str, Analysis]:
    """A closed and an open mesh with triangles of every shape."""
    closed, disc = meshes.of_sample("irregular_ellipsoid", size=1000), meshes.cap()
    return {"closed": curvcli.analyze(tuple(closed), "paper"), "open": curvcli.analyze(tuple(disc), "paper")}


def _row(
    theirs: str, ours: str, found: dict[str, Floats], wanted: dict[str, Floats], bodies: dict[str, Analysis], why: str
) -> Row:
    inner, outer = [], []
    for name, body in bodies.items():
        size = float(np.nanmax(abs(wanted[name])))
        error = abs(found[name] - wanted[name]) / size
        error = error.max(axis=1) if error.ndim == 2 else error
        inner.append(float(error[body.surface.interior].max()))
        if body.surface.boundary.any():
            outer.append(float(error[body.surface.boundary].max()))
    rim = "null in curvcli" if np.isnan(outer).any() else f"{max(outer):.1g}"
    return Row(theirs, ours, f"{max(inner):.1g}", rim, why)


def libraries() -> list[Row]:
    """libigl and VTK against the columns that mean the same; those not installed are left out."""
    bodies = _bodies()
    faces = {name: body.surface.faces.astype(np.int64) for name, body in bodies.items()}
    points = {name: np.ascontiguousarray(body.surface.points) for name, body in bodies.items()}
    column = {
        key: {name: np.asarray(body.vertices[key], np.float64) for name, body in bodies.items()}
        for key in ("K", "A", "A_mixed", "H_vec", "area_gradient", "K_density", "h_signed")
    }
    rows: list[Row] = []
    try:
        import igl
    except ImportError:
        igl = None
    if igl is not None:
        found = {name: peers.libigl(points[name], faces[name]) for name in bodies}
        flat = {
            name: igl.massmatrix(points[name], faces[name], igl.MASSMATRIX_TYPE_BARYCENTRIC).diagonal()
            for name in bodies
        }
        cot = {name: np.asarray(igl.cotmatrix(points[name], faces[name]) @ points[name]) for name in bodies}
        fitted = {name: igl.principal_curvature(points[name], faces[name]) for name in bodies}
        rows += [
            _row(
                "libigl `gaussian_curvature`",
                "`K`",
                {n: f["K"] for n, f in found.items()},
                column["K"],
                bodies,
                "the same inside; 2π − Σθ on the boundary, where the turning is π − Σθ: the sum is not 2πχ",
            ),
            _row("libigl `massmatrix`, barycentric", "`A`", flat, column["A"], bodies, "the same"),
            _row(
                "libigl `massmatrix`, voronoi",
                "`A_mixed`",
                {n: f["A"] for n, f in found.items()},
                column["A_mixed"],
                bodies,
                "the same: its Voronoi area is the mixed one",
            ),
            _row(
                "libigl `cotmatrix` · V",
                "`H_vec`",
                cot,
                column["H_vec"],
                bodies,
                "the same inside; on the boundary it is −∇area, which includes the pull of the rim, not a curvature",
            ),
            _row(
                "libigl `cotmatrix` · V",
                "−`area_gradient`",
                cot,
                {n: -v for n, v in column["area_gradient"].items()},
                bodies,
                "the same everywhere",
            ),
            _row(
                "libigl `principal_curvature`, κ₁ + κ₂",
                "`h_signed`",
                {n: np.asarray(f[2]) + np.asarray(f[3]) for n, f in fitted.items()},
                column["h_signed"],
                bodies,
                "another estimate: a quadric fitted to five rings; it is smooth, and preserves no sum",
            ),
        ]
    try:
        told = {name: peers.vtk(points[name], faces[name]) for name in bodies}
    except ImportError:
        return rows
    rows += [
        _row(
            "VTK Gauss",
            "`K_density`",
            {n: f["pointwise"] for n, f in told.items()},
            column["K_density"],
            bodies,
            "the same inside; (2π − Σθ) / A on the boundary, where the surface has no angle defect",
        ),
        _row(
            "VTK mean, twice",
            "`h_signed`",
            {n: 2 * f["H"] for n, f in told.items()},
            column["h_signed"],
            bodies,
            "not a mean curvature of the star: see below",
        ),
        _row(
            "VTK mean",
            "mean over the edges of 3 `H_theta` / 2 (their two faces' area)",
            {n: f["H"] for n, f in told.items()},
            {n: edge_mean(body) for n, body in bodies.items()},
            bodies,
            "the same formula; it depends on the degree, because it does not divide by the area of the vertex",
        ),
    ]
    return rows


def edge_mean(body: Analysis) -> Floats:
    """VTK's mean curvature: over the inner edges at a vertex the mean of 3 θ|e| / (2 (area of both faces))."""
    surface, edges = body.surface, body.edges
    inner = surface.edges.valence == 2
    left, right = surface.edges.pairs()
    area = np.asarray(body.faces["area"])
    weight = 1.5 * edges["H_theta"][inner] / (area[left // 3] + area[right // 3])
    count, total = np.zeros(surface.n_vertices), np.zeros(surface.n_vertices)
    for end in (surface.edges.a[inner], surface.edges.b[inner]):
        total += np.bincount(end, weight, surface.n_vertices)
        count += np.bincount(end, minlength=surface.n_vertices)
    with np.errstate(invalid="ignore"):
        return np.asarray(total / count)
