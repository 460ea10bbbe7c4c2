"""Volumes of bodies with integer corners: the rational number that they are, rounded once."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
import pytest

import curvcli
from curvcli.samples import get
from tests.helpers.meshes import Mesh, joined, mesh, reversed_faces

SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def box(lengths: tuple[int, int, int], corner: tuple[int, int, int] = (0, 0, 0), diagonals: int = 0) -> Mesh:
    """A box, counterclockwise seen from outside; a bit for each side says which of its diagonals cuts it."""
    points = np.array(list(product((0, 1), repeat=3))) * lengths + corner
    faces = []
    for number, side in enumerate(SIDES):
        a, b, c, d = np.roll(side, diagonals >> number & 1)
        faces += [[a, b, c], [a, c, d]]
    return mesh(points, faces)


def exact_volume(body: Mesh) -> Fraction:
    rows = [[int(x) for x in row] for row in body.points]
    total = 0
    for a, b, c in body.faces.tolist():
        (p, q, r), (s, t, u), (v, w, x) = rows[a], rows[b], rows[c]
        total += p * (t * x - u * w) + q * (u * v - s * x) + r * (s * w - t * v)
    return Fraction(total, 6)


def volume(body: Mesh) -> float:
    found: float = curvcli.analyze((body.points, body.faces), "core", checks=[]).totals["volume"]
    return found


@pytest.mark.parametrize("diagonals", range(64))
def test_the_unit_cube_has_volume_one(diagonals: int) -> None:
    assert volume(box((1, 1, 1), diagonals=diagonals)) == 1.0
    assert volume(reversed_faces(box((1, 1, 1), diagonals=diagonals))) == -1.0


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("power", [0, -30, 40, 300])
def test_boxes_with_integer_corners(seed: int, power: int) -> None:
    random = np.random.default_rng(seed)
    a, b, c = (int(x) for x in random.integers(1, 1000, 3))
    body = box((a, b, c), tuple(random.integers(-(10**6), 10**6, 3)), int(random.integers(64)))
    assert volume(body.moved(np.ldexp(body.points, power))) == np.ldexp(float(a * b * c), 3 * power)


@pytest.mark.parametrize("name", ["irregular_torus", "irregular_ellipsoid", "icosphere", "genus_2"])
def test_integer_corners_of_any_body(name: str) -> None:
    made = get(name)(size=400)
    body = Mesh(np.round(100 * made.points / abs(made.points).max()), made.faces)
    exact = exact_volume(body)
    assert volume(body) == float(exact)
    assert volume(reversed_faces(body)) == -float(exact)


def test_components_regions_and_what_follows() -> None:
    body = joined(box((1, 1, 1)), box((2, 3, 4), (10, 11, 12), 21))
    result = curvcli.analyze((body.points, body.faces), "paper", regions=np.arange(24) // 12)
    report = result.report()
    assert report["totals"]["volume"] == 25.0
    assert [piece["totals"]["volume"] for piece in report["components"]] == [1.0, 24.0]
    assert [piece["totals"]["volume"] for piece in report["regions"]] == [1.0, 24.0]
    assert [piece["steiner"]["coefficients"][0] for piece in report["components"]] == [1.0, 24.0]
    assert next(check.expected for check in result.checks if check.name == "volume") == 75.0
