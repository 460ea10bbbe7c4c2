"""Pictures by their structure: size, colours, lines, nothing cut off, nothing on top of something else."""

from __future__ import annotations

import io
from functools import cache
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.output.appearance import Appearance
from curvcli.output.pictures.camera import screen
from curvcli.output.pictures.colors import colorize
from curvcli.output.pictures.options import PictureOptions
from curvcli.output.pictures.render import Lines, render
from curvcli.output.pictures.sheet import Sheet
from curvcli.output.registry import format_of
from curvcli.output.write import needs, write_into
from tests.helpers.images import Pixels, collisions, decoded, difference_hash, near, opengl
from tests.helpers.meshes import Mesh, of_sample

__all__ = ["opengl"]
pytestmark = pytest.mark.usefixtures("opengl")

WHITE, BLACK, MAGENTA, GREY = (255, 255, 255), (0, 0, 0), (230, 0, 120), (128, 128, 128)


class _Memory:
    """Outputs kept in memory."""

    def __init__(self) -> None:
        self.stream = io.BytesIO()

    def open(self, path: str) -> _Memory:
        return self

    def __enter__(self) -> io.BytesIO:
        return self.stream

    def __exit__(self, *error: object) -> None:
        pass


def picture(analysis: Analysis, name: str = "x.png", **appearance: Any) -> tuple[bytes, list[str]]:
    memory, look = _Memory(), Appearance(**appearance)
    analysis.include(needs([format_of(name)], (), look, analysis.chosen))
    _, ranges = write_into(memory, analysis, [name], look)  # type: ignore[arg-type]
    return memory.stream.getvalue(), ranges


def seen(analysis: Analysis, name: str = "x.png", **appearance: Any) -> Pixels:
    return decoded(picture(analysis, name, **appearance)[0])[0]


@cache
def analysed(name: str, **parameters: float) -> Analysis:
    mesh = of_sample(name, **parameters)
    return curvcli.analyze((mesh.points, mesh.faces))


def surface_alone(mesh: Mesh, view: str = "iso", size: tuple[int, int] = (200, 160)) -> Pixels:
    """The surface in red on white."""
    red = np.broadcast_to(np.array([200, 0, 0], np.uint8), (len(mesh.points), 3))
    surface = mesh.surface()
    return render(screen(surface, view), surface.faces, [red], size, background=(1, 1, 1))[0]


# ---------------------------------------------------------------------------- the surface


@pytest.mark.parametrize(
    ("view", "size"),
    [("iso", (200, 160)), ("front", (200, 160)), ("top", (90, 240)), ("fit", (240, 90)), ("9,-70", (99, 99))],
)
def test_the_surface_fills_the_picture_and_is_not_cut_off(view: str, size: tuple[int, int]) -> None:
    pixels = surface_alone(of_sample("torus", size=300), view, size)
    assert pixels.shape == (size[1], size[0], 3)
    drawn = ~near(pixels, WHITE, 3)
    rows, columns = (np.flatnonzero(drawn.any(axis=axis)) for axis in (1, 0))
    margins = rows[0], columns[0], size[1] - 1 - rows[-1], size[0] - 1 - columns[-1]
    assert min(margins) >= 1
    assert min(margins) <= 0.05 * max(size)
    assert abs(margins[0] - margins[2]) <= 2
    assert abs(margins[1] - margins[3]) <= 2


def test_one_colour_stays_one_colour_but_for_the_light() -> None:
    pixels = surface_alone(of_sample("icosphere", size=600))
    drawn = pixels[near(pixels, (150, 0, 0), 60)]
    assert len(drawn) > 0.2 * pixels.shape[0] * pixels.shape[1]
    assert (drawn[:, 1:] <= 40).mean() > 0.95
    assert pixels[80, 100].tolist() == pytest.approx([200, 0, 0], abs=16)


@pytest.mark.parametrize(("factor", "shift"), [(1e-9, 0.0), (1e150, 0.0), (1.0, 1e6)])
def test_scale_and_offset_change_no_picture(factor: float, shift: float) -> None:
    mesh = of_sample("monkey_saddle", size=300)
    first, second = (difference_hash(surface_alone(one)) for one in (mesh, mesh.moved(mesh.points * factor + shift)))
    assert (first != second).mean() < 0.02
    other = difference_hash(surface_alone(of_sample("torus", size=300)))
    assert (first != other).mean() > 0.05


def test_lines_lie_on_the_surface_and_are_hidden_behind_it() -> None:
    mesh = of_sample("icosphere", size=600)
    surface = mesh.surface()
    positions = screen(surface, "front")
    plain = np.full((len(mesh.points), 3), 255, np.uint8)
    edges = np.stack([surface.edges.a, surface.edges.b], axis=1)
    front = positions[edges].mean(axis=1)[:, 2] > 0.1
    shown = []
    for side in (front, ~front & (positions[edges].mean(axis=1)[:, 2] < -0.1)):
        lines = [Lines(edges[side], (0, 0, 1), 1.5)]
        pixels = render(positions, surface.faces, [plain], (200, 200), background=(1, 1, 1), lines=lines)[0]
        shown.append(int(((pixels[..., 2] > 200) & (pixels[..., 0] < 120)).sum()))
    assert shown[0] > 1000
    assert shown[1] < 0.03 * shown[0]  # at the silhouette


# ---------------------------------------------------------------------------- the whole picture


def test_colours_are_those_of_the_column() -> None:
    pixels = seen(analysed("torus", size=2000), color_by=("K_density",), picture=PictureOptions(size=(400, 320)))
    surface = pixels[40:220].astype(int)
    red, blue = surface[..., 0] - surface[..., 2] > 40, surface[..., 2] - surface[..., 0] > 40
    assert red.mean() > 0.05
    assert blue.mean() > 0.03
    inner = np.argwhere(blue).std(axis=0).sum()
    assert inner < np.argwhere(red).std(axis=0).sum()  # negative inside, positive outside


def test_a_closed_surface_has_neither_boundary_nor_null() -> None:
    pixels = seen(analysed("torus", size=500), picture=PictureOptions(size=(400, 320)))[40:220]
    assert near(pixels, BLACK, 30).sum() == near(pixels, MAGENTA, 60).sum() == 0


def test_boundaries_are_drawn_and_undefined_is_grey() -> None:
    analysis = analysed("disk", size=400)
    pixels = seen(analysis, color_by=("h",), picture=PictureOptions(view="top", size=(400, 400)))
    panel = pixels[40:300]
    ring = near(panel, BLACK, 60)
    assert ring.sum() > 400
    assert near(panel, GREY, 12).sum() > 200
    assert near(panel, GREY, 12).sum() < 0.1 * (~near(panel, WHITE, 3)).sum()
    dark = seen(analysis, color_by=("h",), picture=PictureOptions(view="top", size=(400, 400), background="black"))
    assert tuple(dark[0, 0]) == BLACK
    assert near(dark[40:300], WHITE, 60).sum() > 400


def test_edges_of_more_than_two_faces_are_marked() -> None:
    pixels = seen(analysed("book"), color_by=("status",), picture=PictureOptions(view="35,25", size=(400, 320)))
    assert near(pixels[40:240], MAGENTA, 70).sum() > 60


def test_edges_of_all_faces_on_request() -> None:
    off, on = (
        seen(analysed("torus", size=100), color_by=("A",), picture=PictureOptions(size=(400, 320), edges=edges))[
            40:220
        ].astype(int)
        for edges in (False, True)
    )
    assert (np.abs(off - on).sum(axis=2) > 90).mean() > 0.01


def test_outliers_do_not_ruin_the_range() -> None:
    mesh = of_sample("irregular_torus", size=800)
    noise = np.random.default_rng(0).normal(size=mesh.points.shape)
    spiky = mesh.points + 1e-3 * noise
    spiky[::200] *= 1.2
    analysis = curvcli.analyze((spiky, mesh.faces))
    png, told = picture(analysis, color_by=("K_density",), picture=PictureOptions(size=(400, 320)))
    pixels, about = decoded(png)
    scale = colorize(analysis.vertices["K_density"], signed=True)
    assert scale.high is not None
    assert scale.high < 0.2 * np.nanmax(np.abs(analysis.vertices["K_density"]))
    assert told == [f"x.png: {about['Description']}"]
    assert f"cuts {scale.clipped_below:,} below and {scale.clipped_above:,} above" in told[0]
    # More than two middle shades are seen.
    assert len(np.unique(pixels[40:220].reshape(-1, 3) // 32, axis=0)) > 20


@pytest.fixture
def sheets(monkeypatch: pytest.MonkeyPatch) -> list[Sheet]:
    """Every sheet that is finished."""
    finished: list[Sheet] = []
    content = Sheet.content

    def caught(self: Sheet, title: str, description: str) -> bytes:
        made = content(self, title, description)
        finished.append(self)
        return made

    monkeypatch.setattr(Sheet, "content", caught)
    return finished


@pytest.mark.parametrize(
    ("name", "size", "background"),
    [
        ("torus", (200, 180), "white"),
        ("mobius", (200, 180), "black"),
        ("book", (600, 450), "white"),
        ("mobius", (600, 450), "#0d1117"),
        ("mobius", (1600, 1200), "#0d1117"),
    ],
)
def test_no_text_is_cut_off_or_lies_on_another(
    sheets: list[Sheet], monkeypatch: pytest.MonkeyPatch, background: str, size: tuple[int, int], name: str
) -> None:
    """The surface is left out, which is drawn into a box of its own."""
    monkeypatch.setattr(
        "curvcli.output.pictures.picture.render",
        lambda *given, **options: [np.zeros((given[3][1], given[3][0], 3), np.uint8)] * len(given[2]),
    )
    analysis = analysed(name, size=300) if name != "book" else analysed(name)
    many = size[0] > 500
    columns = ("K", "K_density", "h", "status", "A_vec_x", "willmore_hks") if many else ("K_density",)
    for suffix in (".png", ".hist.png"):
        picture = PictureOptions(size=size, background=background)
        pixels = seen(analysis, f"x{suffix}", color_by=columns, picture=picture)
        assert pixels.shape == (size[1], size[0], 3)
        assert collisions(sheets[-1]) == []
        assert near(pixels, tuple(round(255 * one) for one in sheets[-1].background), 2)[:, :2].all()  # type: ignore[arg-type]


def test_a_file_name_of_any_length_and_script_stands_in_the_legend(sheets: list[Sheet]) -> None:
    analysis = analysed("torus", size=100)
    file = curvcli.mesh.file.MeshFile(
        "ply", analysis.surface.xyz, analysis.surface.faces.ravel(), path="/x/" + "名$x_" * 60
    )
    named = curvcli.analyze(curvcli.mesh.surface.Surface(analysis.surface.points, analysis.surface.faces, file=file))
    seen(named, picture=PictureOptions(size=(300, 260)))
    assert collisions(sheets[-1]) == []


def test_a_surface_without_any_column_is_drawn_plainly() -> None:
    mesh = of_sample("torus", size=100)
    analysis = curvcli.analyze((mesh.points, mesh.faces), ["degree"])
    png, told = picture(analysis, picture=PictureOptions(size=(300, 260)))
    assert told == []
    assert near(decoded(png)[0], (200, 200, 200), 60).mean() > 0.15


def test_histograms_show_every_number_by_default() -> None:
    _, told = picture(analysed("torus", size=300), "x.hist.png")
    assert [line.split(": ")[1] for line in told] == [
        *("degree", "K", "kappa_g", "A", "h", "h_signed", "K_density", "kappa_1", "kappa_2", "willmore"),
        "willmore_hks",
    ]
