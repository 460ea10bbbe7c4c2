"""Errors of every density against the smooth surface, and the orders with which they fall."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.curvatures.quantity import Quantity

from .. import peers
from .surfaces import SURFACES, Mesh

Floats = NDArray[np.float64]

SIZES = (600, 2400, 9600, 38400)
AREAS = ("barycentric", "mixed", "voronoi")

# Columns that look as far as --rings or --radius say.
SCALED = ("_ring", "_corrected", "_fit")

# A fixed radius, in mean edges of the coarsest mesh; finer meshes have more and more vertices within it.
RADIUS = 2.5

# Errors below this part of the largest curvature are rounding, and have no order.
ROUNDING = 1e-10


@dataclass
class Course:
    """The errors of one density on meshes of growing size, as parts of the largest curvature of the surface.

    edge: mean length of the edges. largest: the largest error. mean: its root mean square by area.
    """

    edge: list[float] = field(default_factory=list)
    largest: list[float] = field(default_factory=list)
    mean: list[float] = field(default_factory=list)

    def add(self, edge: float, largest: float, mean: float) -> None:
        """One more mesh."""
        self.edge.append(edge)
        self.largest.append(largest)
        self.mean.append(mean)

    def order(self, errors: list[float]) -> float:
        """The slope of the error over the edge length, both logarithmic; NaN for one mesh, and for rounding."""
        if len(errors) < 2 or min(errors) < ROUNDING:
            return float("nan")
        return float(np.polyfit(np.log(self.edge), np.log(errors), 1)[0])


def limit(quantity: Quantity) -> str:
    """The exact column that a density tends to: H signed or by its size, K, or a principal curvature."""
    name = quantity.name
    if quantity.length_exponent == -2:
        return "K_density"
    if name.startswith("curvedness"):
        return "curvedness"
    if name.startswith("kappa"):
        return "kappa_1" if "1" in name else "kappa_2"
    return "h_signed" if quantity.parity == "odd" else "h"


def densities() -> list[Quantity]:
    """Every density of a vertex that estimates a curvature; a standard deviation does not."""
    known = curvcli.passes.quantities("vertex")
    return [q for q in known if q.kind == "density" and not q.vector and not q.name.endswith("_sigma")]


def estimates() -> list[Quantity]:
    """Those that look at a neighbourhood whose size can be chosen."""
    return [q for q in densities() if q.name.endswith(SCALED)]


def measured(analysis: Analysis, mesh: Mesh, found: Floats, tends_to: str) -> tuple[float, float]:
    """The largest and the mean error of a column inside, where both it and the exact column are defined."""
    known = dict(mesh.exact)
    known["curvedness"] = np.sqrt((known["kappa_1"] ** 2 + known["kappa_2"] ** 2) / 2)
    bent = float(max(abs(known["kappa_1"]).max(), abs(known["kappa_2"]).max()))
    error = abs(found - known[tends_to]) / (bent**2 if tends_to == "K_density" else bent)
    inside = analysis.surface.interior & ~np.isnan(error)
    error, weight = error[inside], analysis.column("A")[inside]
    return float(error.max()), float(np.sqrt((error**2 * weight).sum() / weight.sum()))


def of_peers(analysis: Analysis) -> dict[str, tuple[Floats, str]]:
    """Columns of the libraries that are installed, in the convention of ours, with what they tend to."""
    points, faces = np.ascontiguousarray(analysis.surface.points), analysis.surface.faces.astype(np.int64)
    found: dict[str, tuple[Floats, str]] = {}
    with suppress(ImportError):
        import igl

        _, _, one, other, _ = igl.principal_curvature(points, faces)
        found["libigl `principal_curvature`, κ₁"] = np.maximum(one, other), "kappa_1"
        found["libigl `principal_curvature`, κ₂"] = np.minimum(one, other), "kappa_2"
        found["libigl, |M⁻¹Lx|"] = 2 * np.linalg.norm(peers.libigl(points, faces)["H"], axis=1), "h"
    with suppress(ImportError):
        found["VTK mean, twice"] = 2 * np.asarray(peers.vtk(points, faces)["H"]), "h_signed"
    return found


def label(quantity: Quantity, area: str) -> str:
    """The name of a row."""
    return quantity.name if area == AREAS[0] else f"{quantity.name}, {area}"


def converge(surface: str, triangulation: str, sizes: tuple[int, ...] = SIZES) -> dict[str, Course]:
    """The course of every density; those that divide by the chosen area once for each area."""
    names = [quantity.name for quantity in densities()]
    courses: dict[str, Course] = {}
    for size in sizes:
        mesh = SURFACES[surface][triangulation](size)
        given = curvcli.Surface(mesh.points, mesh.faces)
        for area in AREAS:
            wanted = names if area == AREAS[0] else ["K_density"]
            analysis = curvcli.analyze(given, [*wanted, "A"], area=area)  # type: ignore[arg-type]
            columns = {
                label(quantity, area): (analysis.column(quantity.name), limit(quantity))
                for quantity in densities()
                if quantity.name in wanted
            }
            if area == AREAS[-1]:
                columns |= of_peers(analysis)
            for name, (found, tends_to) in columns.items():
                largest, mean = measured(analysis, mesh, found, tends_to)
                courses.setdefault(name, Course()).add(float(analysis.edges["length"].mean()), largest, mean)
    return courses


def fixed_radius(surface: str, triangulation: str, sizes: tuple[int, ...]) -> tuple[float, dict[str, Course]]:
    """The radius, and the course of every estimate that looks just so far, on all but the finest mesh."""
    courses: dict[str, Course] = {}
    radius = 0.0
    for size in sizes[:-1] or sizes:
        mesh = SURFACES[surface][triangulation](size)
        given = curvcli.Surface(mesh.points, mesh.faces)
        edge = float(curvcli.analyze(given, ["A"], checks=()).edges["length"].mean())
        radius = radius or RADIUS * edge
        analysis = curvcli.analyze(given, [*(q.name for q in estimates()), "A"], radius=radius, checks=())
        for quantity in estimates():
            found = next(column for name, column in analysis.vertices.items() if name.startswith(quantity.name))
            largest, mean = measured(analysis, mesh, found, limit(quantity))
            courses.setdefault(quantity.name, Course()).add(edge, largest, mean)
    return radius, courses


TOTALS = ("area", "H_theta", "willmore", "willmore_hks")


def integrals(surface: str, triangulation: str, limits: dict[str, float], sizes: tuple[int, ...]) -> dict[str, Course]:
    """The course of the totals whose limits are known, relative to the limit, or to 1 where that is 0."""
    courses = {name: Course() for name in TOTALS if name in limits}
    for size in sizes:
        mesh = SURFACES[surface][triangulation](size)
        analysis = curvcli.analyze((mesh.points, mesh.faces), ["A", "H_vec", "willmore", "willmore_hks"], checks=())
        edges = analysis.edges
        found = dict(analysis.totals) | {"H_theta": float(np.nansum(edges["H_theta"]))}
        for name, course in courses.items():
            error = abs(float(found[name]) - limits[name]) / (abs(limits[name]) or 1.0)  # type: ignore[arg-type]
            course.add(float(edges["length"].mean()), error, error)
    return courses
