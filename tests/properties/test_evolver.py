"""The same numbers from another program: K. Brakke's Surface Evolver, which has most of these energies built in.

This tier is optional. Where the Evolver is installed it runs with the other tests, else each test is skipped and says
so. On Debian and Ubuntu:

    apt install evolver-nox
    python -m pytest tests/properties/test_evolver.py -v

A closed mesh is written as a datafile of numbered vertices, edges and oriented faces, with one named quantity for each
method below; the Evolver runs in a process of its own, is asked for totals and for the share of every vertex, and its
printed numbers are compared. Its H is the average of the principal curvatures: its H² energies are a quarter of ours.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from tests.helpers.meshes import Mesh, mesh, of_sample

Floats = NDArray[np.float64]

PROGRAM = next(filter(None, map(shutil.which, ("evolver-nox-d", "evolver", "evolver-nox-q", "evolver-ogl-d"))), None)
pytestmark = pytest.mark.skipif(
    PROGRAM is None, reason="the Surface Evolver is not installed; Debian's package is evolver-nox"
)

# Method of the Evolver: total of ours, and what ours is multiplied with.
TOTALS = {
    "star_eff_area_sq_mean_curvature": ("willmore", 0.25),
    "star_sq_mean_curvature": ("willmore_hks", 0.25),
    "star_perp_sq_mean_curvature": ("willmore_perp", 0.25),
    "star_normal_sq_mean_curvature": ("willmore_normal", 0.25),
    "mean_curvature_integral": ("H_theta", 0.5),
    "circle_willmore": ("willmore_conformal", 1.0),
    "facet_area": ("area", 1.0),
    "facet_volume": ("volume", 1.0),
}
SHARES = tuple(method for method in TOTALS if method.startswith("star_"))
SQUARE = "sq_gauss_curvature"


class Answer(NamedTuple):
    """Totals by method, and by method the shares of the vertices (V,)."""

    totals: dict[str, float]
    shares: dict[str, Floats]


def datafile(given: Mesh) -> str:
    """Vertices, edges and faces numbered from 1; a face is three edges, negative where it runs along one backwards."""
    half = given.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges, number = np.unique(np.sort(half, axis=1), axis=0, return_inverse=True)
    signed = np.where(half[:, 0] < half[:, 1], number + 1, -number - 1).reshape(-1, 3)
    lines = [f"quantity q_{method} info_only method {method} global" for method in (*TOTALS, SQUARE)]
    lines += ["", "vertices", *(f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(given.points.tolist(), 1))]
    lines += ["", "edges", *(f"{k} {a} {b}" for k, (a, b) in enumerate((edges + 1).tolist(), 1))]
    lines += ["", "faces", *(f"{k} {a} {b} {c}" for k, (a, b, c) in enumerate(signed.tolist(), 1)), ""]
    return "\n".join(lines)


def commands() -> str:
    """Print every total, then the shares of each vertex; lines of answers begin with @."""
    lines = [f'printf "@{method} %.17g\\n", q_{method}.value' for method in TOTALS]
    for method in (*SHARES, SQUARE):
        lines.append(f'foreach vertex vv do printf "@@{method} %d %.17g\\n", vv.id, vv.q_{method}')
    return ";\n".join(lines) + ";\nquit 0\n"


def ask(given: Mesh, folder: Path, header: str = "") -> Answer:
    assert PROGRAM is not None
    (folder / "mesh.fe").write_text(header + datafile(given))
    done = subprocess.run(
        [PROGRAM, "-x", "mesh.fe"], input=commands(), capture_output=True, text=True, cwd=folder, timeout=120
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    totals = {name: float(value.strip("()")) for name, value in re.findall(r"^@(\w+) (\S+)$", done.stdout, re.M)}
    shares: dict[str, Floats] = {method: np.full(len(given.points), np.nan) for method in (*SHARES, SQUARE)}
    for name, vertex, value in re.findall(r"^@@(\w+) (\d+) (\S+)$", done.stdout, re.M):
        shares[name][int(vertex) - 1] = float(value.strip("()"))
    assert totals.keys() == TOTALS.keys(), done.stdout[-2000:]
    return Answer(totals, shares)


# ---------------------------------------------------------------------------- bodies


def jittered(given: Mesh, amount: float) -> Mesh:
    rng = np.random.default_rng(4)
    return given.moved(given.points + amount * rng.uniform(-1, 1, given.points.shape))


def irregular_ellipsoid() -> Mesh:
    """Triangles of every shape; off the sphere, where the conformal energy would be rounding alone."""
    return of_sample("irregular_ellipsoid", size=300)


def monkey() -> Mesh:
    """A lens about the monkey saddle: the sheet twice, apart inside and joined at the rim, the lower one reversed."""
    sheet = of_sample("monkey_saddle", size=200)
    gap = 0.2 * (1 - (sheet.points[:, :2] ** 2).sum(axis=1))
    rim = gap < 1e-12
    lower = np.where(rim, np.arange(len(rim)), len(rim) + np.cumsum(~rim) - 1)
    shift = np.stack([0 * gap, 0 * gap, gap], axis=1)
    points = np.vstack([sheet.points + shift, (sheet.points - shift)[~rim]])
    return mesh(points, np.vstack([sheet.faces, lower[sheet.faces][:, ::-1]]))


BODIES: dict[str, Callable[[], Mesh]] = {
    "torus": lambda: of_sample("torus", size=300),
    "irregular_torus": lambda: of_sample("irregular_torus", size=300),
    "irregular_sphere": lambda: of_sample("irregular_sphere", size=300),
    "irregular_ellipsoid": irregular_ellipsoid,
    "jittered_sphere": lambda: jittered(of_sample("icosphere", size=300), 0.03),
    "genus_2": lambda: of_sample("genus_2", size=400),
    "jittered_genus_2": lambda: jittered(of_sample("genus_2", size=400), 0.06),
    "monkey": monkey,
}


# Two triangles of one circle: the Evolver's cosine of the angle may come out above 1, and it says so by a NaN.
COCIRCULAR = {"torus", "genus_2"}


@cache
def ours(name: str) -> Analysis:
    return curvcli.analyze(tuple(BODIES[name]()), "all")


@pytest.fixture(scope="module")
def theirs(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Answer]:
    """The Evolver's answer for a body, asked for once."""
    return cache(lambda name: ask(BODIES[name](), tmp_path_factory.mktemp(name)))


@pytest.mark.parametrize("method", TOTALS)
@pytest.mark.parametrize("name", BODIES)
def test_totals_are_those_of_the_surface_evolver(name: str, method: str, theirs: Callable[[str], Answer]) -> None:
    key, factor = TOTALS[method]
    value = ours(name).totals[key]
    assert isinstance(value, float)
    found = theirs(name).totals[method]
    if method == "circle_willmore" and name in COCIRCULAR and np.isnan(found):
        return
    # On a sphere the conformal energy is what Σβ and π for each vertex leave of each other.
    size = np.pi * len(BODIES[name]().points) if key == "willmore_conformal" else 0.0
    assert found == pytest.approx(factor * value, rel=1e-12, abs=1e-14 * size)


@pytest.mark.parametrize("method", SHARES)
@pytest.mark.parametrize("name", BODIES)
def test_shares_of_vertices(name: str, method: str, theirs: Callable[[str], Answer]) -> None:
    key, factor = TOTALS[method]
    values = factor * ours(name).vertices[key]
    # A plane star has no angle between its normals: nothing there, null or zero.
    wanted = np.nan_to_num(values)
    assert np.isnan(values).any() == (name == "genus_2" and method == "star_normal_sq_mean_curvature")
    np.testing.assert_allclose(theirs(name).shares[method], wanted, rtol=0, atol=1e-12 * wanted.max())


@pytest.mark.parametrize("name", BODIES)
def test_squared_gaussian_curvature(name: str, theirs: Callable[[str], Answer]) -> None:
    """K_p² over a third of the star's area."""
    column = ours(name).vertices
    wanted = column["K"] ** 2 / column["A"]
    np.testing.assert_allclose(theirs(name).shares[SQUARE], wanted, rtol=0, atol=1e-12 * wanted.max())


def test_the_datafile_of_a_tetrahedron() -> None:
    """Each edge is named by two faces, once in each direction."""
    text = datafile(of_sample("tetrahedron"))
    rows = [[int(part) for part in line.split()] for line in text.partition("faces\n")[2].splitlines()]
    used = sorted(edge for _, *edges in rows for edge in edges)
    assert used == [-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize("name", ["irregular_ellipsoid", "jittered_sphere", "jittered_genus_2"])
@pytest.mark.parametrize("c0", [0.7, -0.7])
def test_spontaneous_curvature_has_the_sign_and_the_factor_of_the_evolver(name: str, c0: float, tmp_path: Path) -> None:
    """Its `h_zero` is that of the average of κ₁ and κ₂, half of c₀, and its perpendicular H is h_perp.

    helfrich = ½(h_signed − c₀)²A differs from ½(h_perp − c₀)²A by ½(h² − h_perp²)A − c₀(h_signed − h_perp)A.
    """
    theirs = 2 * ask(BODIES[name](), tmp_path, f"parameter h_zero = {c0 / 2}\n").totals["star_perp_sq_mean_curvature"]
    vertices = ours(name).vertices
    area, h, perp = vertices["A"], vertices["h_signed"], vertices["h_perp"]
    assert (0.5 * (perp - c0) ** 2 * area).sum() == pytest.approx(theirs, rel=1e-12)
    helfrich = curvcli.analyze(tuple(BODIES[name]()), "helfrich", settings={"helfrich.c0": c0}).totals["helfrich"]
    between = (0.5 * (h**2 - perp**2) * area - c0 * (h - perp) * area).sum()
    assert helfrich - between == pytest.approx(theirs, rel=1e-12)
