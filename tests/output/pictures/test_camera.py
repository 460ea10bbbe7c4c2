"""The options of pictures: what they accept, and where a picture is taken from."""

from __future__ import annotations

import importlib.util
import math

import numpy as np
import pytest

from curvcli.errors import MissingExtraError, UsageError
from curvcli.output.pictures.camera import frame, screen
from curvcli.output.pictures.options import PictureOptions, arrange, check_picture_options, parse_size, parse_view
from tests.helpers.meshes import of_sample


@pytest.mark.parametrize(
    ("view", "angles"),
    [
        ("iso", (-45, math.degrees(math.asin(1 / math.sqrt(3))))),
        ("front", (-90, 0)),
        ("top", (-90, 90)),
        (" FIT ", None),
        ("30,-20", (30, -20)),
        ("-360,90", (-360, 90)),
        ("1.5,2", (1.5, 2)),
    ],
)
def test_a_view_is_two_angles(view: str, angles: tuple[float, float] | None) -> None:
    assert parse_view(view) == angles


@pytest.mark.parametrize("view", ["", "side", "30", "30,91", "1e3,0", "nan,0", "1,2,3", "3 0,2"])
def test_a_view_that_is_none(view: str) -> None:
    with pytest.raises(UsageError, match=r"^--view .*expected iso, front, top, fit"):
        parse_view(view)


def test_a_size_is_width_by_height() -> None:
    assert parse_size(None) is None
    assert parse_size("640x480") == parse_size(" 640 X 480 ") == (640, 480)


@pytest.mark.parametrize("size", ["640", "640x", "0x100", "100x100", "9000x600", "-640x480", "640x480x3", "640*480"])
def test_a_size_that_is_none(size: str) -> None:
    with pytest.raises(UsageError, match=r"^--size .*expected WxH"):
        parse_size(size)


def test_a_background_that_is_none() -> None:
    with pytest.raises(UsageError, match=r"^--background blau: no such colour"):
        check_picture_options(PictureOptions(background="blau"))


def test_what_is_not_installed_is_named_with_the_way_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r"^pictures need pyvista and matplotlib: `pip install 'curvcli\[pict"):
        check_picture_options(PictureOptions())


@pytest.mark.parametrize(
    ("angles", "right", "up", "towards"),
    [
        ((-90.0, 0.0), (1, 0, 0), (0, 0, 1), (0, -1, 0)),
        ((-90.0, 90.0), (1, 0, 0), (0, 1, 0), (0, 0, 1)),
        ((0.0, 0.0), (0, 1, 0), (0, 0, 1), (1, 0, 0)),
    ],
)
def test_a_frame_has_the_known_axes(angles: tuple[float, float], right: object, up: object, towards: object) -> None:
    np.testing.assert_allclose(frame(*angles), [right, up, towards], atol=1e-15)


def test_every_frame_is_a_rotation() -> None:
    for azimuth, elevation in ((-45, 35.26), (200, -80), (13, 90)):
        axes = frame(azimuth, elevation)
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
        assert np.linalg.det(axes) == pytest.approx(1)


@pytest.mark.parametrize("view", ["iso", "fit", "70,10"])
def test_the_surface_is_seen_alike_at_every_scale_and_offset(view: str) -> None:
    mesh = of_sample("saddle", size=200)
    seen = screen(mesh.surface(), view)
    for moved in (mesh.points * 1e-9, mesh.points * 1e200, mesh.points + 1e6):
        np.testing.assert_allclose(screen(mesh.moved(moved).surface(), view), seen, atol=1e-8)
    assert np.abs(seen).max() <= np.sqrt(3) + 1e-12
    np.testing.assert_allclose(seen.max(axis=0), -seen.min(axis=0), atol=1e-12)


def test_fit_looks_along_the_thinnest_direction_onto_the_outside() -> None:
    mesh = of_sample("disk", size=100)
    rotated = mesh.moved(mesh.points @ frame(33, 44) * [1.0, 1.0, 1.0])
    seen = screen(rotated.surface(), "fit")
    assert np.ptp(seen[:, 2]) < 1e-12
    a, b, c = (seen[mesh.faces[:, k], :2] for k in range(3))
    assert (np.linalg.det(np.stack([b - a, c - a], axis=-1)) > 0).all()


def test_up_is_the_axis_that_is_asked_for() -> None:
    mesh = of_sample("cylinder", size=100)
    tall = mesh.moved(mesh.points[:, [0, 2, 1]] * [1, 1, -1])
    np.testing.assert_allclose(
        screen(tall.surface(), "front", "y")[:, 1], screen(mesh.surface(), "front", "z")[:, 1], atol=1e-12
    )


def test_a_vertex_that_no_face_uses_does_not_move_the_camera() -> None:
    mesh = of_sample("saddle", size=100)
    more = mesh.moved(np.vstack([mesh.points, [[1e9, np.nan, np.inf]]]))
    seen = screen(more.surface(), "iso")
    assert np.isfinite(seen).all()
    np.testing.assert_array_equal(seen[:-1], screen(mesh.surface(), "iso"))


def test_panels_fill_the_sheet() -> None:
    assert arrange(1, (600, 450), (4, 3))[:2] == (1, 1)
    assert arrange(6, (900, 400), (4, 3))[:2] == (3, 2)
    assert arrange(3, (200, 900), (4, 3))[:2] == (1, 3)
    assert arrange(4, None, (800, 600))[2] == (1600, 1200)
    with pytest.raises(UsageError, match="--size 300x300: too small for 12 panels; 720x540 is enough"):
        arrange(12, (300, 300), (4, 3))
    assert arrange(12, (720, 540), (4, 3))[:2] == (4, 3)
