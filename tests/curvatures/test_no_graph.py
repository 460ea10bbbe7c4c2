"""Local fits where the neighbourhood is no graph over a plane: null, counted and said; elsewhere they stay."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.samples import get
from tests.helpers.meshes import Mesh, mesh
from tests.helpers.shared import SHARED, needs_shared

FITS = "K_fit,h_fit,kappa_1_fit,kappa_2_fit,dir_1_fit,condition_fit"


def counts(found: Analysis) -> list[int]:
    return [notice.count for notice in found.notices if notice.code == "no_graph"]


def pleats(depth: float, across: int = 60, along: int = 12) -> Mesh:
    """A sheet in steep folds: unit edges along them, and walls of the given height a tenth of an edge apart."""
    s, t = np.meshgrid(np.arange(across), np.arange(along), indexing="ij")
    points = np.stack([0.1 * s, t, depth * (s % 2)], axis=2).reshape(-1, 3)
    number = np.arange(across * along).reshape(across, along)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    return mesh(points, np.hstack([[a, b, c], [a, c, d]]).T)


def tube(around: int, length: int = 12) -> Mesh:
    """A cylinder of radius 1 with edges of one length."""
    turn = 2 * np.pi * np.arange(around) / around
    edge = 2 * np.sin(np.pi / around)
    rows = [np.stack([np.cos(turn), np.sin(turn), np.full(around, k * edge)], axis=1) for k in range(length)]
    first = np.arange(around * (length - 1))
    right = first // around * around + (first + 1) % around
    return mesh(
        np.vstack(rows), np.vstack([np.c_[first, right, right + around], np.c_[first, right + around, first + around]])
    )


def test_steep_folds_have_no_fit() -> None:
    given = pleats(4.0)
    found = curvcli.analyze(given.surface(), FITS, rings=2)
    columns, condition = found.vertices, found.vertices["condition_fit"]
    null = np.isnan(columns["K_fit"]) & np.isfinite(condition)
    middle = (np.abs(given.points[:, 0] - 3) < 2) & (np.abs(given.points[:, 1] - 5.5) < 3)
    assert null[middle].all()
    for name in ("h_fit", "kappa_1_fit", "kappa_2_fit"):
        assert np.isnan(columns[name][null]).all()
    assert counts(found) == [int(null.sum())]
    flat = curvcli.analyze(pleats(0.0).surface(), FITS, rings=2)
    assert counts(flat) == []
    assert np.isfinite(flat.vertices["K_fit"]).all()


@pytest.mark.parametrize(("around", "rings", "whole"), [(8, 3, False), (8, 1, True), (24, 3, True), (24, 2, True)])
def test_tubes_that_a_neighbourhood_wraps_round(around: int, rings: int, whole: bool) -> None:
    """Three rings on eight vertices reach over more than the half of the tube; one ring does not."""
    given = tube(around)
    found = curvcli.analyze(given.surface(), "h_fit", rings=rings)
    middle = slice(around * 5, around * 7)
    assert np.isfinite(found.vertices["h_fit"][middle]).all() == whole
    assert (counts(found) == []) == whole
    if whole and around > 8:
        np.testing.assert_allclose(found.vertices["h_fit"][middle], 1, atol=0.05)


@pytest.mark.parametrize(
    "name", ["icosphere", "irregular_sphere", "irregular_torus", "irregular_ellipsoid", "catenoid"]
)
def test_smooth_surfaces_keep_their_fits(name: str) -> None:
    made = get(name)(size=2000)
    for rings in (1, 2, 3):
        found = curvcli.analyze((made.points, made.faces), FITS, rings=rings)
        assert counts(found) == []


def test_long_thin_triangles_are_judged_across_the_bend() -> None:
    made = get("torus")(size=6000, aspect=8.0)
    found = curvcli.analyze((made.points, made.faces), FITS, rings=3)
    assert counts(found) == []


def test_every_scale_has_its_own_count() -> None:
    given = tube(8).surface()
    found = curvcli.analyze(given, "h_fit", rings="1,3")
    (notice,) = [each for each in found.notices if each.code == "no_graph"]
    assert "(3 rings)" in notice.message
    once, thrice = (np.isnan(found.vertices[f"h_fit_{rings}rings"]) for rings in (1, 3))
    assert notice.count == np.count_nonzero(
        thrice & np.isfinite(curvcli.analyze(given, FITS, rings=3).vertices["condition_fit"])
    )
    assert thrice[40:56].all()
    assert not once[40:56].any()


@needs_shared
@pytest.mark.parametrize("rings", [1, 2, 3])
def test_fits_on_a_cortex_agree_with_other_estimates(rings: int) -> None:
    """Fits that are defined have the size of the other estimates and correlate with them."""
    assert SHARED is not None
    path = SHARED / "meshes" / "fsaverage5_pial_lh.ply"
    found = curvcli.analyze(str(path), "h_fit,h_corrected,h_ring,condition_fit", rings=rings, checks=[])
    names = ("h_fit", "h_corrected", "h_ring", "condition_fit")
    h, other, ring, condition = (np.asarray(found.vertices[name]) for name in names)
    known = np.isfinite(h)
    assert counts(found) == [int(np.count_nonzero(~known & np.isfinite(condition)))]
    assert 0.75 < known.mean() < 1
    assert np.abs(h[known]).max() < 1.25 * np.nanmax(np.abs(other))
    assert np.corrcoef(h[known], other[known])[0, 1] > 0.65
    assert np.corrcoef(h[known], ring[known])[0, 1] > 0.55
