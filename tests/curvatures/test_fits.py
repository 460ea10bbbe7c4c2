"""Local fits: exact where the surface is a polynomial, close where it is smooth, calm where it is noisy."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.samples import get
from curvcli.samples.model import Sample
from tests.helpers import meshes


def relative(found: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.linalg.norm(found - wanted) / np.linalg.norm(wanted))


def error(sample: Sample, column: str, exact: str, **scale: object) -> float:
    found = curvcli.analyze((sample.points, sample.faces), [column], **scale).vertices[column]  # type: ignore[arg-type]
    return relative(found, sample.exact[exact])


@pytest.mark.parametrize(("name", "bound"), [("sphere", 2e-3), ("torus", 2e-2), ("ellipsoid", 1e-2)])
def test_irregular_meshes_of_smooth_surfaces(name: str, bound: float) -> None:
    sample = get(f"irregular_{name}")(size=4000)
    for rings in (2, 3):
        assert error(sample, "K_fit", "K_density", rings=rings) < bound
        assert error(sample, "h_fit", "h_signed", rings=rings) < bound


@pytest.mark.parametrize("name", ["icosphere", "ellipsoid", "torus"])
def test_no_bias_on_regular_meshes(name: str) -> None:
    sample = get(name)(size=10000)
    found = curvcli.analyze((sample.points, sample.faces), ["K_fit", "h_fit"]).vertices
    for column, exact in (("K_fit", "K_density"), ("h_fit", "h_signed")):
        wanted = sample.exact[exact]
        assert abs((found[column] - wanted).sum()) < 2e-3 * np.abs(wanted).sum()


@pytest.mark.parametrize("name", ["irregular_sphere", "irregular_torus", "catenoid"])
def test_finer_meshes_are_closer(name: str) -> None:
    errors = [error(get(name)(size=size), "K_fit", "K_density", rings=3) for size in (1000, 4000)]
    # Twice as fine is four times the vertices: the order is the binary logarithm.
    assert np.log2(errors[0] / errors[1]) > 1


def test_a_paraboloid_is_fitted_exactly_up_to_its_frame() -> None:
    """At the top of z = −x²/2 − 2y² + xy the frame is not exactly upright, so nothing is exact but to third order."""
    plane = get("plane")(size=900, width=0.2, jitter=0.3)
    x, y, _ = plane.points.T
    points = np.stack([x, y, -0.5 * x**2 - 2 * y**2 + x * y], axis=1)
    top = int(np.argmin(x**2 + y**2))
    found = curvcli.analyze((points, plane.faces), ["K_fit", "h_fit", "dir_1_fit"], rings=3).vertices
    q = 1 + (y[top] - x[top]) ** 2 + (x[top] - 4 * y[top]) ** 2
    assert found["K_fit"][top] == pytest.approx((4 - 1) / q**2, rel=1e-5)
    assert found["h_fit"][top] == pytest.approx(5, rel=1e-3)
    _, vectors = np.linalg.eigh([[1.0, -1.0], [-1.0, 4.0]])
    assert abs(found["dir_1_fit"][top, :2] @ vectors[:, 1]) == pytest.approx(1, abs=1e-4)


def test_noise_is_averaged_out() -> None:
    """With noise of a twentieth of an edge, the fit beats the measure per area by far, and three rings beat two."""
    sample = get("icosphere")(size=4000)
    edge = np.sqrt(4 * np.pi / len(sample.faces) * 4 / np.sqrt(3))
    points = sample.points + np.random.default_rng(3).normal(scale=0.05 * edge, size=sample.points.shape)
    noisy = Sample(points, sample.faces, sample.exact)
    two, three = (error(noisy, "h_fit", "h_signed", rings=rings) for rings in (2, 3))
    assert three < two < 0.5 * error(noisy, "h_signed", "h_signed")
    assert three < 0.15


def test_long_faces_of_a_torus_keep_the_fit_close() -> None:
    sample = get("torus")(size=6000, aspect=8.0)
    assert error(sample, "K_fit", "K_density", rings=3) < 0.02


def test_what_a_neighbourhood_does_not_determine_is_null() -> None:
    corner = meshes.tetrahedron()  # four points
    found = curvcli.analyze((corner.points, corner.faces), ["K_fit", "condition_fit"], rings=3).vertices
    assert np.isnan(found["K_fit"]).all()
    assert np.isnan(found["condition_fit"]).all()
    flat = get("disk")(size=300)
    found = curvcli.analyze((flat.points, flat.faces), ["K_fit", "kappa_1_fit", "dir_1_fit", "condition_fit"]).vertices
    assert np.abs(found["K_fit"]).max() < 1e-12
    assert np.isnan(found["dir_1_fit"]).all()
    assert np.nanmin(found["condition_fit"]) >= 6


def test_a_patch_without_orientation_keeps_what_is_even() -> None:
    strip = get("mobius")(size=2000)
    found = curvcli.analyze((strip.points, strip.faces), ["K_fit", "h_fit"], rings=3).vertices
    inner = ~curvcli.Surface(strip.points, strip.faces).boundary
    assert relative(found["K_fit"][inner], strip.exact["K_density"][inner]) < 0.05
    assert np.isnan(found["h_fit"]).all()


def test_a_radius_and_several_scales() -> None:
    sample = get("irregular_sphere")(size=1000, radius=3.0)
    found = curvcli.analyze((sample.points, sample.faces), ["K_fit"], radius="3e,1.0").vertices
    for column in ("K_fit_3e", "K_fit_r1"):
        known = np.isfinite(found[column])
        assert known.mean() > 0.95
        assert np.median(np.abs(found[column][known] - 1 / 9)) < 3e-3 / 9
