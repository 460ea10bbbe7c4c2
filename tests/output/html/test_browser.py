"""The page in a browser: it opens, it colours, it answers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.output.html import page as pages
from tests.helpers.meshes import grid, of_sample
from tests.output.html.browser import Tab, browser
from tests.output.html.pages import HOSTILE, labelled, page_of, singles, written

FLAT = grid(8).moved(grid(8).points * [1.0, 1.0, 0.0])


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with browser() as launched:
        yield launched


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def bumpy(chromium: Any, folder: Path) -> Iterator[tuple[Tab, Any]]:
    """A page of an open surface with its table as other programs read it."""
    import polars as pl

    mesh = written(grid(12), folder / "bumpy.obj")
    analysis = curvcli.analyze(str(mesh))
    for suffix in ("html", "csv"):
        analysis.write(folder / f"bumpy.{suffix}")
    tab = Tab(chromium, folder / "bumpy.html")
    yield tab, pl.read_csv(folder / "bumpy.csv")
    assert tab.complaints == []


def test_it_opens_with_a_picture_and_without_a_complaint(bumpy: Any) -> None:
    tab, _ = bumpy
    picture = tab.picture()
    drawn = picture[..., 3] > 0
    assert 0.1 < drawn.mean() < 0.9
    assert len(np.unique(picture[drawn][:, :3], axis=0)) > 100
    assert tab.complaints == []


def test_the_menu_changes_the_colours_and_the_legend(bumpy: Any) -> None:
    tab, _ = bumpy
    pictures = {}
    for name in ("K", "A", "h_signed"):
        tab.page.select_option("#column", name)
        tab.page.wait_for_selector(f"html[data-column={name}]")
        pictures[name] = tab.picture().astype(int)
        assert tab.page.locator(".scale:visible figcaption strong").all_inner_texts() == [name]
    for one, other in (("K", "A"), ("A", "h_signed")):
        assert (np.abs(pictures[one] - pictures[other]).max(axis=2) > 8).mean() > 0.1
    grey = [(np.ptp(p[..., :3], axis=2) == 0) & (p[..., 3] > 0) & (p[..., 0] > 20) for p in pictures.values()]
    # K and h_signed are undefined on the boundary, A is defined everywhere.
    assert grey[0].sum() > 500 < grey[2].sum()
    assert grey[1].sum() < 100


@pytest.mark.parametrize("vertex", [0, 20, 84, 168])
def test_the_values_of_a_vertex_are_those_of_the_table(bumpy: Any, vertex: int) -> None:
    tab, table = bumpy
    tab.choose(vertex)
    tab.wait_for_vertex(vertex)
    row = {name: values[0] for name, values in table.filter(table["vertex"] == vertex).to_dict(as_series=False).items()}
    shown = tab.values()
    assert list(shown) == [name for name in row if name != "vertex"]
    for name, text in shown.items():
        if name == "status":
            assert text == row[name]
        elif row[name] is None:
            assert text == "undefined"
        else:
            assert singles(float(text)) == singles(row[name]), name
    assert f"vertex {vertex}, {row['status']}" in tab.page.inner_text("#picked")


def test_a_number_that_is_no_vertex_is_told(bumpy: Any) -> None:
    tab, table = bumpy
    tab.choose(10**6)
    tab.page.wait_for_function("document.getElementById('picked').textContent.startsWith('there is no vertex')")
    assert tab.page.inner_text("#picked") == f"there is no vertex 1000000; the last is {len(table) - 1}"


def test_keys_turn_the_surface_and_bring_it_back(bumpy: Any) -> None:
    tab, _ = bumpy
    tab.page.press("#view", "0")
    before = tab.picture()
    for key in ("ArrowLeft", "ArrowUp", "+"):
        tab.page.press("#view", key)
        assert (tab.picture() != before).any()
    tab.page.press("#view", "0")
    np.testing.assert_array_equal(tab.picture(), before)


def test_a_drag_turns_and_a_wheel_zooms_without_choosing(bumpy: Any) -> None:
    tab, _ = bumpy
    tab.choose(5)
    tab.wait_for_vertex(5)
    box = tab.page.locator("#view").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before = tab.picture()
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    tab.page.mouse.move(x + 40, y + 20, steps=4)
    tab.page.mouse.up()
    turned = tab.picture()
    assert (turned != before).any(axis=2).mean() > 0.05
    tab.page.mouse.wheel(0, -200)
    larger = tab.picture()
    assert (larger[..., 3] > 0).sum() > 1.05 * (turned[..., 3] > 0).sum()
    assert tab.page.input_value("#vertex") == "5"
    tab.page.press("#view", "0")


def test_edges_and_shading(bumpy: Any) -> None:
    tab, _ = bumpy
    before = tab.picture()
    for box in ("#edges", "#smooth"):
        tab.page.check(box)
        assert (tab.picture() != before).any()
        tab.page.uncheck(box)
        np.testing.assert_array_equal(tab.picture(), before)


def test_a_click_finds_the_vertex_under_it(chromium: Any, folder: Path) -> None:
    path = folder / "flat.html"
    path.write_bytes(page_of(curvcli.analyze(tuple(FLAT))))
    tab = Tab(chromium, path)
    tab.page.click("[data-view=top]")
    tab.picture()
    box = tab.page.locator("#view").bounding_box()
    # The farthest vertex is at distance 1 of the middle and the camera looks at a ball of 1.02 with an angle of 35°.
    low, high = FLAT.points.min(axis=0), FLAT.points.max(axis=0)
    middle = (low + high) / 2
    radius = np.linalg.norm(FLAT.points - middle, axis=1).max()
    pixels = box["height"] / 2 * math.cos(math.radians(17.5)) / 1.02 / radius
    for vertex in (10, 30, 40, 52):
        x, y, _ = (FLAT.points[vertex] - middle) * pixels
        at = (box["x"] + box["width"] / 2 + x + 1, box["y"] + box["height"] / 2 - y + 1)
        tab.page.mouse.move(*at)
        tab.page.wait_for_selector("#hover:visible")
        assert tab.page.inner_text("#hover").startswith(f"vertex {vertex} ")
        tab.page.mouse.click(*at)
        tab.wait_for_vertex(vertex)
        assert tab.page.input_value("#vertex") == str(vertex)
        assert singles(float(tab.values()["x"])) == singles(FLAT.points[vertex, 0])
    tab.page.mouse.click(box["x"] + 3, box["y"] + 3)
    assert tab.page.input_value("#vertex") == "52"
    assert tab.complaints == []


def test_a_simplified_mesh_answers_with_true_values(
    chromium: Any, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pages, "MOST_VERTICES", 700)
    analysis = curvcli.analyze(tuple(of_sample("irregular_sphere", size=6000)))
    path = folder / "simplified.html"
    path.write_bytes(page_of(analysis))
    tab = Tab(chromium, path)
    box = tab.page.locator("#view").bounding_box()
    tab.page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    tab.page.wait_for_selector("html[data-vertex]")
    vertex = int(tab.page.input_value("#vertex"))
    shown = tab.values()
    for name in ("K", "A", "h_signed", "willmore"):
        assert singles(float(shown[name])) == singles(analysis.vertices[name][vertex])
    there = _shown(tab)
    hidden = next(v for v in range(vertex + 1, 6000) if v not in there)
    tab.choose(hidden)
    tab.page.wait_for_function("document.getElementById('picked').textContent.includes('is not shown')")
    assert tab.complaints == []


def _shown(tab: Tab) -> set[int]:
    from tests.output.html.parsed import Page

    return set(np.cumsum(Page(tab.page.content().encode()).block("vertices", "<u4", 1)[:, 0]).tolist())


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_telephone_by_day_and_by_night(chromium: Any, folder: Path, scheme: str) -> None:
    path = folder / f"{scheme}.html"
    path.write_bytes(page_of(curvcli.analyze(tuple(of_sample("two_components", size=500)), "paper")))
    settings = {"viewport": {"width": 390, "height": 844}, "color_scheme": scheme, "is_mobile": True, "has_touch": True}
    tab = Tab(chromium, path, **settings)
    assert tab.page.evaluate("[document.documentElement.scrollWidth, innerWidth]") == [390, 390]
    style = "getComputedStyle(document.documentElement)"
    back, ink = (
        [int(part) for part in tab.page.evaluate(f"{style}.{name}.match(/\\d+/g)")]
        for name in ("backgroundColor", "color")
    )
    assert (min(back) > 200 and max(ink) < 60) if scheme == "light" else (max(back) < 60 and min(ink) > 200)
    tab.page.locator("#view").tap()
    assert tab.complaints == []


def test_names_from_the_file_do_nothing(chromium: Any, folder: Path) -> None:
    mesh = labelled(grid(), folder / "<img src=x onerror=alert(3)>.obj", HOSTILE)
    path = folder / "hostile.html"
    path.write_bytes(page_of(curvcli.analyze(str(mesh), regions="groups"), command=HOSTILE))
    tab = Tab(chromium, path)
    assert "<img src=x onerror=alert(3)>.obj" in tab.page.inner_text("h1")
    assert HOSTILE in tab.page.locator("#regions tbody th").first.inner_text()
    assert tab.complaints == []


def test_without_webgl_the_values_are_there(chromium: Any, folder: Path) -> None:
    path = folder / "plain.html"
    path.write_bytes(page_of(curvcli.analyze(tuple(grid()))))
    tab = Tab(chromium, path, before="HTMLCanvasElement.prototype.getContext = () => null")
    assert "no WebGL" in tab.page.inner_text("#trouble")
    tab.choose(3)
    tab.wait_for_vertex(3)
    assert singles(float(tab.values()["A"])) == singles(curvcli.analyze(tuple(grid())).vertices["A"][3])
