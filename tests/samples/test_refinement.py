"""Every sample against what it says of itself: facts of the very mesh, and the totals its refinements approach."""

from __future__ import annotations

from functools import cache

import pytest

import curvcli
from curvcli.samples import get, names
from curvcli.samples.model import Sample

# Four times finer edges: what the passes below are asked for costs a tenth of a second.
COARSE, FINE = 2_000, 32_000
PASSES = ("K", "kappa_g", "A", "A_vec", "H_vec", "H_theta", "willmore")

# Its normals do not tend to those of the cylinder; only what is intrinsic or counted does.
LANTERN = {"area", "H_theta", "willmore"}
# Thirds of the faces do not tend to Voronoi's cells where triangles have every shape, so h² over them stays too large.
IRREGULAR = {"irregular_sphere", "irregular_torus"}


@cache
def limits_of(name: str) -> dict[str, float]:
    return get(name)(size=FINE).limit


@cache
def totals(name: str, size: int) -> dict[str, float]:
    """Totals of a refinement, and nothing else of it, so that it can be forgotten."""
    made = get(name)(size=size)
    found = curvcli.analyze((made.points, made.faces), PASSES).totals
    return {key: value for key, value in found.items() if isinstance(value, float)}


def fact(made: Sample, report: dict[str, dict[str, object]], key: str) -> object:
    if key == "convex":
        return report["steiner"]["convex"]
    return report["topology"][key] if key in report["topology"] else report["totals"][key]


@pytest.mark.parametrize("name", names())
def test_the_facts_of_a_sample_hold(name: str) -> None:
    made = get(name)()
    report = curvcli.analyze((made.points, made.faces), "all").report()
    assert len(made.facts) >= 12
    for key, known in made.facts.items():
        found = fact(made, report, key)
        if isinstance(known, float):
            assert found == pytest.approx(known, rel=1e-12, abs=1e-11 if key == "K" else 0), key
        else:
            assert (type(found), found) == (type(known), known), key


@cache
def limits() -> list[tuple[str, str]]:
    return [(name, key) for name in names() for key in get(name)().limit]


def test_there_are_limits() -> None:
    assert len(limits()) > 100


def converges(name: str, key: str) -> bool:
    return not (name == "schwarz_lantern" and key in LANTERN) and not (name in IRREGULAR and key == "willmore")


@pytest.mark.parametrize(("name", "key"), [pair for pair in limits() if converges(*pair)])
def test_totals_approach_their_limits(name: str, key: str) -> None:
    """Errors fall at first order in the edges (curvature is missing along the boundary) or faster, or are rounding."""
    far, near = (totals(name, size)[key] for size in (COARSE, FINE))
    limit = limits_of(name)[key]
    size = max(abs(limit), 1.0)
    assert abs(near - limit) < 1e-10 * size or abs(near - limit) < 0.35 * abs(far - limit)
    assert abs(near - limit) < 0.25 * size


@pytest.mark.parametrize(("name", "key"), [pair for pair in limits() if not converges(*pair)])
def test_totals_that_stay_too_large(name: str, key: str) -> None:
    far, near = (totals(name, size)[key] for size in (COARSE, FINE))
    limit = limits_of(name)[key]
    assert near > 1.05 * limit
    assert near == pytest.approx(far, rel=0.03)
