"""The standard deviations of K and h against the scatter of noisy copies."""

from __future__ import annotations

import numpy as np
import pytest

import curvcli
from curvcli.errors import UsageError
from curvcli.mesh.precision import precision
from curvcli.mesh.surface import Surface
from curvcli.samples import get

Floats = np.ndarray


def scatter(points: Floats, faces: Floats, noise: float, copies: int = 200) -> tuple[Floats, Floats]:
    """Standard deviations of K and h_signed over noisy copies, all copies side by side as pieces of one surface."""
    random = np.random.default_rng(11)
    n = len(points)
    moved = points + random.normal(scale=noise, size=(copies, n, 3))
    pieces = faces + n * np.arange(copies, dtype=np.int32)[:, None, None]
    found = curvcli.analyze((moved.reshape(-1, 3), pieces.reshape(-1, 3)), ["K", "h_signed"], checks=[]).vertices
    k, h = (np.std(found[name].reshape(copies, n), axis=0, ddof=1) for name in ("K", "h_signed"))
    return k, h


@pytest.mark.parametrize("part", [1e-6, 1e-3])
@pytest.mark.parametrize("name", ["irregular_ellipsoid", "torus"])
def test_against_the_scatter_of_noisy_copies(name: str, part: float) -> None:
    sample = get(name)(size=400)
    noise = part * np.ptp(sample.points, axis=0).max()
    found = curvcli.analyze((sample.points, sample.faces), ["K_sigma", "h_sigma"], noise=noise).vertices
    k, h = scatter(sample.points, sample.faces, noise)
    for column, wanted in (("K_sigma", k), ("h_sigma", h)):
        assert np.median(found[column]) == pytest.approx(np.median(wanted), rel=0.05)
        assert np.median(found[column] / wanted) == pytest.approx(1, abs=0.03)


def test_flat_stars_scatter_to_second_order() -> None:
    """The first derivative of K vanishes there; the second does not."""
    flat = get("plane")(size=400, jitter=0.3)
    noise = 1e-3
    found = curvcli.analyze((flat.points, flat.faces), ["K_sigma", "h_sigma"], noise=noise).vertices
    k, h = scatter(flat.points, flat.faces, noise)
    inner = np.isfinite(found["K_sigma"])
    assert np.median(found["K_sigma"][inner] / k[inner]) == pytest.approx(1, abs=0.05)
    assert np.median(found["h_sigma"][inner] / h[inner]) == pytest.approx(1, abs=0.05)
    assert (found["K_sigma"][inner] > 0).all()


def test_derivatives_against_differences() -> None:
    """One vertex of a sharp body moved along each axis, the neighbours, then the vertex itself."""
    body = get("irregular_ellipsoid")(size=12)
    step = 1e-6
    gradients = np.zeros((2, *body.points.shape))
    for vertex in range(len(body.points)):
        for axis in range(3):
            ends = []
            for sign in (1, -1):
                points = body.points.copy()
                points[vertex, axis] += sign * step
                found = curvcli.analyze((points, body.faces), ["K", "h_signed"]).vertices
                ends.append((found["K"][0], found["h_signed"][0]))
            gradients[:, vertex, axis] = (np.array(ends[0]) - ends[1]) / (2 * step)
    noise = 1e-9  # the second order is nothing beside the first
    found = curvcli.analyze((body.points, body.faces), ["K_sigma", "h_sigma"], noise=noise).vertices
    for column, gradient in zip(("K_sigma", "h_sigma"), gradients, strict=True):
        assert found[column][0] == pytest.approx(noise * np.linalg.norm(gradient), rel=1e-6)


def test_the_summary_counts_what_noise_explains() -> None:
    sample = get("icosphere")(size=1000)
    result = curvcli.analyze((sample.points, sample.faces), ["K", "K_sigma"], noise=0.05)
    below = int(np.count_nonzero(np.abs(result.vertices["K"]) < result.vertices["K_sigma"]))
    counted = [notice.count for notice in result.notices if notice.code == "below_noise"]
    assert counted == [below]
    assert below > 900
    assert result.report()["conventions"]["noise"] == "0.05"


def test_no_noise_and_noise_that_is_none() -> None:
    sample = get("icosphere")(size=100)
    found = curvcli.analyze((sample.points, sample.faces), ["K_sigma"], noise=0).vertices["K_sigma"]
    assert (found == 0).all()
    with pytest.raises(UsageError, match="noise"):
        curvcli.analyze((sample.points, sample.faces), ["K_sigma"], noise=-1.0)


@pytest.mark.parametrize(
    ("values", "step"),
    [
        (lambda p: p.astype(np.float32).astype(np.float64), 2.0**-23),
        (lambda p: np.round(p, 4), 1e-4),
        (lambda p: np.round(1000 * p, 1), 0.1),
        (lambda p: p, 2.0**-52),
        (lambda p: np.round(8 * p), 2.0**-20),
    ],
)
def test_the_precision_of_coordinates(values: object, step: float) -> None:
    """Whole numbers might be written without decimals: the finer reading is taken."""
    sample = get("irregular_sphere")(size=200)
    points = sample.points / np.abs(sample.points).max()
    found = precision(Surface(values(points), sample.faces))  # type: ignore[operator]
    assert found == pytest.approx(step / np.sqrt(12), rel=1e-12)


@pytest.mark.parametrize("size", [1e-300, 1e-150, 1e150, 1e300])
def test_meshes_at_the_ends_of_the_range(size: float) -> None:
    sample = get("irregular_sphere")(size=200)
    plain = curvcli.analyze((sample.points, sample.faces), ["K_sigma"], noise=1e-3).vertices["K_sigma"]
    scaled = curvcli.analyze((sample.points * size, sample.faces), ["K_sigma"], noise=1e-3 * size).vertices["K_sigma"]
    np.testing.assert_allclose(scaled, plain, rtol=1e-9)
    default = curvcli.analyze((sample.points * size, sample.faces), ["K_sigma"]).vertices["K_sigma"]
    assert (default < 1e-11).all()


def test_the_summary_counts_mean_curvatures_that_noise_explains() -> None:
    sample = get("plane")(size=400, jitter=0.2)
    curved = sample.points + np.stack([0 * sample.points[:, 0]] * 2 + [-0.2 * sample.points[:, 0] ** 2], axis=1)
    result = curvcli.analyze((curved, sample.faces), ["h", "h_sigma"], noise=2.3e-4)
    h, sigma = result.vertices["h"], result.vertices["h_sigma"]
    below = int(np.count_nonzero(h < sigma))
    assert 0 < below < np.count_nonzero(np.isfinite(sigma))
    (notice,) = [each for each in result.notices if each.code == "h_below_noise"]
    assert notice.count == below
    assert "h_sigma" in notice.message
    both = curvcli.analyze((curved, sample.faces), ["K_sigma", "h_sigma"], noise=2.3e-4).notices
    assert {"below_noise", "h_below_noise"} <= {each.code for each in both}
