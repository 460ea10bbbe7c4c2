"""Normals of analytic surfaces: of unit length, on the side that the faces say, and across the surface."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.samples import get, names
from tests.helpers.cli.program import curvcli as run

WITH_NORMALS = [name for name in names() if "normal_x" in get(name)().exact]


@pytest.mark.parametrize("name", WITH_NORMALS)
def test_normals_of_the_smooth_surface(name: str) -> None:
    made = get(name)(size=3000)
    normal = np.stack([made.exact[f"normal_{axis}"] for axis in "xyz"], axis=1)
    known = np.isfinite(normal).all(axis=1)
    assert np.array_equal(known, np.isfinite(made.exact["kappa_1"]))
    np.testing.assert_allclose(np.linalg.norm(normal[known], axis=1), 1, rtol=0, atol=1e-15)
    star = curvcli.analyze((made.points, made.faces), ["A_vec"], checks=[]).vertices["A_vec"]
    cosine = (star * normal).sum(axis=1) / np.linalg.norm(star, axis=1)
    inner = known & ~curvcli.Surface(made.points, made.faces).boundary
    assert cosine[inner].min() > 0.93
    assert np.median(cosine[inner]) > 0.998


def test_a_ply_file_has_them_under_their_usual_names(tmp_path: Path) -> None:
    path = tmp_path / "torus.ply"
    assert run("sample", "torus", "--size", "200", "-o", path).code == 0
    head = path.read_bytes().split(b"end_header")[0].decode()
    assert "property double nx\nproperty double ny\nproperty double nz\n" in head
    with_normals = run("analyze", path, "-p", "K_corrected", "--normals", "file", "--get", "conventions.normals")
    assert with_normals.out.strip() == "file"
