"""`python -m benchmarks.validation`: measure, and write docs/validation.md with its pictures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import click
import numpy as np

import curvcli
from curvcli.samples import get

from . import agreement, convergence, plots
from .convergence import ROUNDING, SIZES, Course
from .surfaces import SURFACES

ROOT = Path(__file__).parent.parent.parent

INTRODUCTION = """# Validation

This page compares the columns with the curvatures of smooth surfaces, with 50-digit arithmetic, and with other
programs. It is the output of

```sh title="Not run by the tests: takes minutes"
pip install '.[test,bench]' && python -m benchmarks.validation
```

with curvcli {version}{others}. Identities are not on this page, because every report has them: they hold to rounding on
every mesh.
"""

CONVERGENCE = """## Convergence

Each surface in two triangulations of about {sizes} vertices: a regular one, and a Delaunay triangulation of random
points, uniform by area. It has triangles of every shape, the hardest of the usual cases. *largest* and *mean* are the
largest and the root mean square error over the inner vertices of the finest mesh, as fractions of the largest curvature
of the surface (its square for K). *order* is the slope of the error over the mean edge length between all sizes: 2
means a quarter of the error for half the edge, 0 or less no convergence, – rounding only.

Results:

* On smooth images of a grid (torus, catenoid, unduloid) all values of single stars are of second order. Next to a
  boundary estimates are one-sided and of lower order.
* The sphere and the ellipsoid made of an icosahedron have twelve vertices of degree 5. There a third of the area of the
  star is not the area of the vertex: the largest error of the densities stays, and the mean error falls with the share
  of those vertices. `--area mixed` or `voronoi` corrects it for `K_density`.
* On random triangulations values of single stars do not converge, here or in any other program, except `K_density` by
  Voronoi cells on the sphere: the star shrinks, but does not become rounder. Exactness is unaffected: `K`, `H_vec` and
  `A_vec` preserve their sums, and sums over pieces of fixed size converge, such as `area` and `H_theta` in the second
  tables. The Willmore energies are sums of squares and do not converge. `H_theta` sums inner edges and `willmore` inner
  vertices, so on the catenoid and the unduloid a strip along the rim is missing, and the order is one less.
* Estimates use more than one star: two rings in the first tables, a fixed radius in the third (without the finest mesh,
  which would add little there). At a fixed radius the number of stars grows, and all estimates converge down to the
  blur of the radius. Two rings have a constant number of faces, and only the estimates with fitted or corrected normals
  converge.
* On spheres the corrected measures are exact if the normals are.
"""

EXACT = """## Exact arithmetic

`tests/exact` has twelve small meshes (closed and open, regular and irregular, one-sided, one far from the origin) with
every quantity in 50-digit arithmetic from the coordinates in the file. *error* is the largest difference over all
twelve as a fraction of the largest value of the column, absolute for angles. A double has 16 digits. The table omits
quotients by the mean curvature of the minimal surface, because it is 0 to rounding.

| column of | column | error | digits | worst on |
|---|---|---|---|---|
"""

EVOLVER = """## The Surface Evolver

K. Brakke's program has the same energies. The table has totals on eight bodies of genus 0, 1 and 2, regular, irregular
and jittered. Its mean curvature is the average, hence the factors. `tests/properties/test_evolver.py` compares every
vertex as well.

| method | curvcli | largest relative difference |
|---|---|---|
"""

LIBRARIES = """## libigl and VTK

On an irregular ellipsoid (closed) and a jittered cap (open); differences as fractions of the largest value of the
column.

| other program | curvcli | inside | boundary | reason |
|---|---|---|---|---|
"""

VTK = """
VTK's mean curvature is, at each edge, three times the dihedral angle times its length over the area of its two faces,
and at each vertex half the mean of that over its edges. On a regular triangulation that is the mean curvature.
Elsewhere short and long edges have the same weight, and the tables above have the errors.
"""


def number(value: float) -> str:
    """An error for a table."""
    return f"{value:.1e}" if value >= ROUNDING else "rounding"


def slope(course: Course, errors: list[float]) -> str:
    """An order for a table."""
    order = course.order(errors)
    return "–" if np.isnan(order) else f"{order + 0.0:.1f}"


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [f"| {' | '.join(header)} |", "|---" * len(header) + "|"]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)]) + "\n"


def one_surface(name: str, folder: Path, sizes: tuple[int, ...]) -> str:
    """The part of one surface, and its picture."""
    courses = {kind: convergence.converge(name, kind, sizes) for kind in SURFACES[name]}
    plots.draw(folder / "validation" / f"{name}.png", name, courses)
    header = ["density", *(f"{kind}: {what}" for kind in courses for what in ("largest", "order", "mean", "order"))]
    rows = []
    for row in next(iter(courses.values())):
        cells = [(row if " " in row else f"`{row}`").replace("|", r"\|")]
        for each in courses.values():
            course = each[row]
            for errors in (course.largest, course.mean):
                cells += [number(errors[-1]), slope(course, errors)]
        rows.append(cells)
    known = get({"sphere": "icosphere"}.get(name, name))(**({"periods": 1} if name == "unduloid" else {})).limit
    sums = {kind: convergence.integrals(name, kind, known, sizes) for kind in courses}
    totals = []
    for total in next(iter(sums.values())):
        cells = [f"`{total}`"]
        for each in sums.values():
            course = each[total]
            cells += [number(course.mean[-1]), slope(course, course.mean)]
        totals.append(cells)
    return "\n".join(
        [
            f"### {name.capitalize()}\n",
            f"![Errors on the {name}](validation/{name}.png)\n",
            table(header, rows),
            table(["total", *(f"{kind}: {what}" for kind in sums for what in ("error", "order"))], totals),
            at_radius(name, sizes),
        ]
    )


def at_radius(name: str, sizes: tuple[int, ...]) -> str:
    """The table of the estimates at a fixed radius."""
    found = {kind: convergence.fixed_radius(name, kind, sizes) for kind in SURFACES[name]}
    radii = ", ".join(f"{radius:.2g} ({kind})" for kind, (radius, _) in found.items())
    rows = []
    for row in next(iter(found.values()))[1]:
        cells = [f"`{row}`"]
        for _, courses in found.values():
            cells += [number(courses[row].mean[-1]), slope(courses[row], courses[row].mean)]
        rows.append(cells)
    header = [f"within {radii}", *(f"{kind}: {what}" for kind in found for what in ("mean", "order"))]
    return table(header, rows)


def page(folder: Path, sizes: tuple[int, ...] = SIZES) -> str:
    """The whole page; pictures go to `validation` in the folder."""
    others = []
    for distribution, title in (("libigl", "libigl"), ("vtk", "VTK")):
        try:
            others.append(f"{title} {version(distribution)}")
        except PackageNotFoundError:
            click.echo(f"{title} is not installed and left out", err=True)
    parts = [INTRODUCTION.format(version=curvcli.__version__, others="".join(f", {other}" for other in others))]
    parts.append(CONVERGENCE.format(sizes=", ".join(f"{size:,}" for size in sizes)))
    for name in SURFACES:
        click.echo(name, err=True)
        parts.append(one_surface(name, folder, sizes))
    rows = [
        (element, f"`{column}`", f"{error:.0e}", agreement.digits(error), worst)
        for element, column, error, worst in agreement.exact()
    ]
    parts.append(EXACT + "\n".join(f"| {' | '.join(row)} |" for row in rows) + "\n")
    answers = agreement.evolver()
    if answers is None:
        click.echo("the Surface Evolver is not installed and left out", err=True)
    else:
        lines = [f"| `{method}` | {ours} | {error:.0e} |" for method, ours, error in answers]
        parts.append(EVOLVER + "\n".join(lines) + "\n")
    if found := agreement.libraries():
        lines = [f"| {row.theirs} | {row.ours} | {row.inside} | {row.boundary} | {row.why} |" for row in found]
        parts.append(LIBRARIES + "\n".join(lines) + "\n" + VTK)
    return "\n".join(parts)


@click.command()
@click.option("--folder", type=click.Path(path_type=Path), default=ROOT / "docs", help="Folder of the page.")
@click.option("--quick", is_flag=True, help="Small meshes only, to try it.")
def main(folder: Path, quick: bool) -> None:
    """Measure, and write validation.md with its pictures."""
    folder.mkdir(parents=True, exist_ok=True)
    text = page(folder, SIZES[:2] if quick else SIZES)
    (folder / "validation.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
