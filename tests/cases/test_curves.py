"""Curves and maps of shared/cases through the command line."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path

import numpy as np
import pytest

from tests.helpers.cli.program import curvcli
from tests.helpers.shared import SHARED, needs_shared

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


def cap(folder: Path) -> tuple[Path, np.ndarray, np.ndarray]:
    """The cap without its texture, its texture coordinates and its faces."""
    rows = [line.split() for line in Path(case("cap_uv.obj")).read_text().splitlines()]
    path = folder / "cap.obj"
    faces = np.array([[int(word.partition("/")[0]) for word in row[1:]] for row in rows if row[:1] == ["f"]])
    points = [" ".join(row) for row in rows if row[:1] == ["v"]]
    path.write_text("\n".join([*points, *(f"f {a} {b} {c}" for a, b, c in faces.tolist()), ""]))
    return path, np.array([row[1:] for row in rows if row[:1] == ["vt"]], float), faces - 1


def signed_areas(at: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (at[faces[:, k]] for k in range(3))
    return ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def test_a_texture_is_a_map(tmp_path: Path) -> None:
    path, uv, faces = cap(tmp_path)
    ended = curvcli("compare", case("cap_uv.obj"), "--map", "uv", "--json")
    report = json.loads(ended.out)
    assert (ended.code, report["seams"]) == (0, 0)
    assert report["totals"]["image_area"] == pytest.approx(3.46536, abs=5e-6)
    assert report["totals"]["image_area"] == pytest.approx(np.abs(signed_areas(uv, faces)).sum(), rel=1e-12)
    flat = tmp_path / "cap_flat.obj"
    rest = [line for line in path.read_text().splitlines() if line.startswith("f")]
    flat.write_text("\n".join([*(f"v {u!r} {v!r} 0" for u, v in uv.tolist()), *rest, ""]))
    other = json.loads(curvcli("compare", path, flat, "--map", "--json").out)
    for key in ("totals", "sigma_1", "sigma_2", "nonconformality", "area_distortion", "orientation", "harmonic"):
        assert report[key] == other[key]


def test_a_folded_flattening(tmp_path: Path) -> None:
    path, _, faces = cap(tmp_path)
    rows = [line.split() for line in Path(case("cap_flat_folded.obj")).read_text().splitlines()]
    at = np.array([row[1:] for row in rows if row[:1] == ["v"]], float)
    expected = np.flatnonzero(signed_areas(at, faces) < 0)
    assert 0 < len(expected) < 10
    ended = curvcli("compare", path, case("cap_flat_folded.obj"), "--map", "--json")
    report = json.loads(ended.out)
    assert report["orientation"]["turned_over"] == len(expected)
    (warning,) = report["warnings"]
    assert (warning["code"], warning["examples"]) == ("turned_over_faces", expected[:5].tolist())
