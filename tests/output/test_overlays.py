"""Overlays: written by curvcli, read by nibabel and by curvcli, to the precision of float32."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.errors import UsageError
from curvcli.loading.label_files.read import read_labels
from curvcli.output.appearance import Appearance
from curvcli.output.overlays import overlay_columns
from curvcli.output.registry import output_formats
from tests.helpers.cli.program import curvcli as program
from tests.helpers.cortex import triangles
from tests.helpers.every_format import sphere

SHAPE = sphere().halved().single()


@pytest.fixture
def surface(tmp_path: Path) -> Path:
    """lh.white: a sphere with an unused vertex, whose values are undefined."""
    (tmp_path / "lh.white").write_bytes(triangles(SHAPE))
    return tmp_path / "lh.white"


def column(surface: Path, name: str) -> Any:
    values = np.asarray(curvcli.analyze(surface).vertices[name])
    assert np.isnan(values).any()
    return values.astype(np.float32)


def test_round_trips(surface: Path) -> None:
    nibabel = pytest.importorskip("nibabel", reason="nibabel reads the files")
    folder = surface.parent
    names = ["lh.K.shape.gii", "lh.white.h_signed.curv", "lh.kappa_1.crv", "lh.both.func.gii"]
    outputs = [word for name in names for word in ("-o", str(folder / name))]
    ended = program("analyze", surface, *outputs, "--color-by", "K_density,H_vec_x")
    assert ended.code == 0, ended.err
    assert "lh.both.func.gii: K_density, H_vec_x\n" in ended.err
    (array,) = nibabel.load(folder / names[0]).darrays
    assert (array.meta["Name"], array.data.dtype) == ("K", np.float32)
    np.testing.assert_array_equal(array.data, column(surface, "K"))
    for name, key in ((names[1], "h_signed"), (names[2], "kappa_1")):
        np.testing.assert_array_equal(nibabel.freesurfer.read_morph_data(str(folder / name)), column(surface, key))
    first, second = nibabel.load(folder / names[3]).darrays
    assert [first.meta["Name"], second.meta["Name"]] == ["K_density", "H_vec_x"]
    np.testing.assert_array_equal(second.data, column(surface, "H_vec_x"))
    for name, key in ((names[0], "K"), (names[1], "h_signed")):
        read = read_labels(str(folder / name))
        assert read.element == "vertex"
        np.testing.assert_array_equal(np.asarray(read.values, np.float32), column(surface, key))


def test_labels_and_counts_are_integers(surface: Path) -> None:
    nibabel = pytest.importorskip("nibabel", reason="nibabel reads the files")
    path = surface.parent / "lh.x.shape.gii"
    assert program("analyze", surface, "-q", "-o", path, "--color-by", "status,degree").code == 0
    status, degree = nibabel.load(path).darrays
    assert status.data.dtype == np.int32
    assert status.data[5] == 4  # unreferenced
    assert np.isnan(degree.data[5])


@pytest.mark.parametrize(
    ("path", "color_by", "expected"),
    [
        ("lh.K.curv", ("h",), ["K"]),
        ("out/LH.K.CURV", (), ["K"]),
        ("lh.white.curv", ("h",), ["h"]),
        ("lh.curv", (), ["K_density"]),
        ("lh.all.shape.gii", ("h", "K"), ["h", "K"]),
        ("lh.all.curv", ("h", "K"), "holds one column"),
        ("lh.K_fit.curv", (), "K_fit is not computed; -p core,K_fit adds it"),
        ("lh.white.curv", ("theta",), "needs a column of vertices"),
    ],
)
def test_the_column_of_an_overlay(path: str, color_by: tuple[str, ...], expected: list[str] | str) -> None:
    format: Any = output_formats()["." + ("shape.gii" if path.endswith("gii") else "curv")]
    chosen = ["K", "h", "K_density"]
    if isinstance(expected, str):
        with pytest.raises(UsageError, match=expected):
            overlay_columns(path, format, Appearance(color_by=color_by), chosen)
    else:
        assert overlay_columns(path, format, Appearance(color_by=color_by), chosen) == expected


def test_what_float32_cannot_hold_is_counted(tmp_path: Path) -> None:
    points = SHAPE.points * 1e-30
    result = curvcli.analyze((points, SHAPE.triangles))
    result.write(tmp_path / "lh.K_density.curv")
    values = np.asarray(read_labels(str(tmp_path / "lh.K_density.curv")).values)
    assert np.isnan(values).all()


def test_without_nibabel_the_extra_is_named(surface: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from curvcli.errors import MissingExtraError
    from curvcli.output.write import check_appearance

    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r"pip install 'curvcli\[cortex\]'"):
        check_appearance(Appearance(), ["K"], [".shape.gii"])
