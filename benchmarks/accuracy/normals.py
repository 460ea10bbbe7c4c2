"""`python -m benchmarks.accuracy.normals`: what the weights of faces make of vertex normals, and these of K."""

from __future__ import annotations

import click
import numpy as np

import curvcli
from benchmarks.validation.surfaces import SURFACES, Floats, Mesh
from curvcli.mesh.scale import DEFAULT_SCALE
from curvcli.report.compare.exact import error_norms

CHOSEN = ("sphere", "torus", "ellipsoid")


def weighted(mesh: Mesh) -> dict[str, Floats]:
    """Unit normals (3, V) of the vertices, the faces at each weighted by area, by angle, or as Max (1999) does."""
    corners = mesh.points[mesh.faces]
    before, after = np.roll(corners, 1, axis=1) - corners, np.roll(corners, -1, axis=1) - corners
    area = np.cross(after, before)  # the same at all corners of a face: twice its area vector
    size, dots = np.linalg.norm(area, axis=2, keepdims=True), (after * before).sum(axis=2, keepdims=True)
    squares = (after**2).sum(axis=2, keepdims=True) * (before**2).sum(axis=2, keepdims=True)
    shares = {"areas": area, "angles": area / size * np.arctan2(size, dots), "Max": area / squares}
    normals = {}
    for name, share in shares.items():
        total = np.zeros_like(mesh.points)
        np.add.at(total, mesh.faces, share)
        normals[name] = (total / np.linalg.norm(total, axis=1, keepdims=True)).T
    return normals


def errors(surface: str, size: int) -> dict[str, list[float]]:
    """For each weight the errors of the normals (root mean square) and of K (relative L²), as they are and fitted."""
    mesh = SURFACES[surface]["irregular"](size)
    given = curvcli.Surface(mesh.points, mesh.faces)
    area = curvcli.passes["A"](given)
    exact = np.stack([mesh.exact[f"normal_{axis}"] for axis in "xyz"])
    found = {}
    for name, plain in weighted(mesh).items():
        fitted = curvcli.passes["fitted_normal"].compute(given, DEFAULT_SCALE, "mesh", plain)
        row = []
        for normal in (plain, fitted):
            gap = ((normal - exact) ** 2).sum(axis=0)
            gauss = curvcli.passes["K_corrected"].compute(
                curvcli.passes["corrected_measures"].compute(given, DEFAULT_SCALE, normal)[0]
            )
            norms = error_norms("K_corrected", "K_density", gauss, mesh.exact["K_density"], area)
            row += [float(np.sqrt((area * gap).sum() / area.sum())), norms.relative_l2 or 0.0]
        found[name] = row
    return found


@click.command()
@click.option("--size", type=click.IntRange(200), default=10_000, show_default=True, help="Vertices.")
def main(size: int) -> None:
    """Errors on random points of a sphere, a torus and an ellipsoid, over two rings, as Markdown."""
    measured = [errors(surface, size) for surface in CHOSEN]
    click.echo("| weights | error of the normals | error of K | fitted: normals | fitted: K |\n|---|---|---|---|---|")
    for name in measured[0]:
        cells = zip(*(each[name] for each in measured), strict=True)
        click.echo(f"| {name} | " + " | ".join(", ".join(f"{value:.2g}" for value in cell) for cell in cells) + " |")


if __name__ == "__main__":
    main()
