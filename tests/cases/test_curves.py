"""Curves and maps of shared/cases through the command line."""

from __future__ import annotations

import csv
import io
import json
import math

import pytest

from tests.cli.program import curvcli
from tests.shared import SHARED, needs_shared

pytestmark = needs_shared


def case(name: str) -> str:
    assert SHARED is not None
    path = SHARED / "cases" / name
    if not path.is_file():
        pytest.skip(f"no {name} in shared/cases")
    return str(path)


def test_edges_as_an_editor_writes_them_are_one_knot() -> None:
    report = json.loads(curvcli("curves", case("trefoil_blender_edges.obj"), "--json").out)
    (row,) = report["curves"]
    assert (row["closed"], row["vertices"]) == (True, 400)
    assert abs(row["writhe"]) == pytest.approx(3.3541, abs=5e-5)
    assert row["total_curvature"] == pytest.approx(13.950, abs=5e-4)
    assert report["warnings"] == []


def test_a_helix_in_millimetres() -> None:
    """Of radius 10 and 3 a radian: 10/109 and 3/109 at every inner vertex."""
    ended = curvcli("curves", case("helix_mm.obj"), "-o", "-", "--format", "csv")
    first, *inner, last = csv.DictReader(io.StringIO(ended.out))
    assert first["curvature"] == last["torsion_density"] == ""
    for row in inner:
        assert round(float(row["curvature"]), 5) == 0.09174
        assert round(float(row["torsion_density"]), 5) == 0.02752
        assert math.isclose(float(row["torsion_density"]), 3 / 109, rel_tol=1e-6)
