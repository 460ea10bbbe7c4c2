"""Rounding has the colour of 0: flat plates have one colour, and no curvature that is there is hidden."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.output.appearance import Appearance
from curvcli.output.html.columns import columns
from curvcli.output.pictures.legend import range_text
from tests.helpers import meshes
from tests.helpers.meshes import Mesh
from tests.output.coloring import colored
from tests.output.html.pages import page_of
from tests.output.html.parsed import Page

STARS = ("K_density", "h_signed", "kappa_1", "kappa_2", "kappa_max", "curvedness", "willmore", "H_vec_x", "K")
ESTIMATES = tuple(
    f"{name}_{suffix}" for name in ("K", "h", "kappa_1", "curvedness") for suffix in ("ring", "corrected")
)


def plate(seed: int, fold: float = 0.0) -> Mesh:
    """A square of irregular triangles, folded along its middle by an angle and turned."""
    random = np.random.default_rng(seed)
    x, y = (each.ravel() for each in np.meshgrid(np.arange(21.0), np.arange(21.0), indexing="ij"))
    moved = random.uniform(-0.3, 0.3, (2, 441)) * ((x != 10) & (x > 0) & (x < 20) & (y > 0) & (y < 20))
    x, y = x - 10 + moved[0], y + moved[1]
    points = np.column_stack([np.where(x > 0, x * np.cos(fold), x), y, np.where(x > 0, x * np.sin(fold), 0.0)])
    corner = (21 * np.arange(20)[:, None] + np.arange(20)).ravel()
    quads = np.stack([corner, corner + 21, corner + 22, corner + 1], 1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return meshes.mesh(points @ np.linalg.qr(random.standard_normal((3, 3)))[0], faces)


def of(mesh: Mesh, scale: float = 1.0, shift: float = 0.0, single: bool = False) -> Analysis:
    points = mesh.points * scale + shift
    points = points.astype(np.float32).astype(np.float64) if single else points
    return curvcli.analyze((points, mesh.faces), [*{name.removesuffix("_x") for name in STARS}, "estimates", "A"])


def colors_of(analysis: Analysis, name: str) -> tuple[int, str]:
    """Number of colours of the defined values, and the text of the legend."""
    scale = colored(analysis, name).scale
    known = np.isfinite(analysis.vertices[name])
    return len(np.unique(scale.rgb[known], axis=0)), range_text(scale, None)


@pytest.mark.parametrize("name", [*STARS, *ESTIMATES])
@pytest.mark.parametrize("single", [False, True])
def test_a_flat_plate_has_one_colour(name: str, single: bool) -> None:
    for seed, scale, shift in ((0, 1.0, 0.0), (1, 1e-9, 0.0), (2, 1e9, 0.0), (3, 1.0, 1e3), (4, 1.0, 1e5)):
        analysis = of(plate(seed), scale, shift, single and shift < 1e5)
        count, words = colors_of(analysis, name)
        assert count == 1, (seed, scale, shift)
        assert words in ("0 within rounding wherever defined", "0 wherever defined"), (seed, scale, shift)


@pytest.mark.parametrize("name", ["K_density", "K", "K_ring"])
def test_a_fold_has_no_gauss_curvature(name: str) -> None:
    for seed in range(3):
        assert colors_of(of(plate(seed, fold=-0.7)), name) == (1, "0 within rounding wherever defined")


def test_a_fold_has_the_mean_curvature_of_its_ridge_alone() -> None:
    analysis = of(plate(0, fold=0.7))
    scale = colored(analysis, "h_signed").scale
    ridge = np.zeros(441, bool)
    ridge[210:231] = True
    known = np.isfinite(analysis.vertices["h_signed"])
    assert scale.rounded is not None
    rounding = analysis.column("h")
    np.testing.assert_array_equal(scale.rounded[known], ~ridge[known] & (rounding[known] != 0))
    assert f"{int(scale.rounded.sum())} are 0 within rounding" in range_text(scale, None)
    assert len(np.unique(scale.rgb[known & ~ridge], axis=0)) == 1


@pytest.mark.parametrize(
    "name", ["K_density", "h_signed", "K", "kappa_2", "willmore", "K_corrected", "h_fit", "K_ring"]
)
@pytest.mark.parametrize(("sample", "size"), [("icosphere", 40962), ("irregular_torus", 3000), ("ellipsoid", 5000)])
def test_no_curvature_is_hidden(name: str, sample: str, size: int) -> None:
    """Of float32 coordinates too, whose rounding moves K by a tenth of its value where the mesh is that fine."""
    mesh = meshes.of_sample(sample, size=size)
    points = mesh.points.astype(np.float32).astype(np.float64)
    analysis = curvcli.analyze((points, mesh.faces), [name])
    scale = colored(analysis, name).scale
    hidden = 0 if scale.rounded is None else int(scale.rounded.sum())
    largest = np.nanmax(np.abs(analysis.vertices[name]))
    assert hidden < 0.002 * len(points)
    assert hidden == 0 or np.abs(analysis.vertices[name][scale.rounded]).max() < 0.02 * largest


def test_what_is_exactly_0_is_not_said_to_be_rounding() -> None:
    flat = meshes.grid(4).points * [1, 1, 0]
    assert colors_of(curvcli.analyze((flat, meshes.grid(4).faces), "core"), "h_signed")[0] == 1
    lattice = np.round(flat)
    assert colors_of(curvcli.analyze((lattice, meshes.grid(4).faces), "core"), "h_signed")[1] == "0 wherever defined"


def test_meshes_and_pages_have_the_same_colour(tmp_path: Path) -> None:
    analysis = of(plate(0))
    analysis.write(tmp_path / "plate.ply")
    written = curvcli.load(tmp_path / "plate.ply").file
    assert written is not None
    rgb = np.column_stack([np.asarray(written.vertex_properties[key]) for key in ("red", "green", "blue")])
    assert len(np.unique(rgb[np.isfinite(analysis.vertices["K_density"])], axis=0)) == 1
    for column in columns(analysis, Appearance(), ()):
        if column.name in ("K_density", "h_signed", "kappa_1", "h_corrected"):
            assert len(column.bars) == 1
            np.testing.assert_array_equal(column.values, analysis.vertices[column.name])
    page = Page(page_of(analysis))
    (place,) = (k for k, column in enumerate(page.json()["columns"]) if column["name"] == "h_signed")
    assert page.json()["columns"][place]["rounded"]
    assert "Within rounding of 0" in page.root.one("figure", id=f"scale-{place}").text
    stored = page.block(f"column-{place}", "<f4", 1)[:, 0]
    rounded = page.block(f"rounded-{place}", "u1", 1)[:, 0].astype(bool)
    assert rounded[np.nan_to_num(stored) != 0].all()
