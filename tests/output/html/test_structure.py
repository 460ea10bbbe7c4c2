"""The page without a browser: well formed, closed in itself, escaped, and saying what the report says."""

from __future__ import annotations

import hashlib
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.output.html import page as pages
from curvcli.output.html import three_js as engines
from curvcli.output.html.three_js import engine
from curvcli.output.pictures.camera import frame
from tests.helpers.meshes import grid, of_sample, tetrahedron
from tests.output.html.pages import HOSTILE, labelled, page_of, parsed
from tests.output.html.parsed import Page

MESHES = {
    "closed": of_sample("torus"),
    "open": grid(),
    "one face": tetrahedron().with_faces([0, 1, 2]),
    "not manifold": of_sample("book"),
    "not orientable": of_sample("mobius"),
    "pieces": of_sample("two_components"),
}


@pytest.fixture(scope="module", params=MESHES)
def both(request: pytest.FixtureRequest) -> Any:
    return parsed(tuple(MESHES[request.param]), "paper")


def test_it_asks_nobody_and_nothing_else_runs_in_it(both: Any) -> None:
    _, page = both
    for element in page.root.all():
        for name, value in element.attributes.items():
            assert not name.startswith("on"), element
            assert name != "style", "the policy allows no styles of elements"
            if name in ("src", "href", "data", "action", "poster"):
                assert value == "data:," or value.startswith("#"), element
    policy = page.root.one("meta", http_equiv="Content-Security-Policy").attributes["content"]
    assert policy.startswith("default-src 'none'; ")
    assert "http" not in policy
    assert "unsafe-inline" not in policy
    scripts = [script for script in page.root.all("script") if "type" not in script.attributes]
    assert [pages._digest(script.text) in policy for script in scripts] == [True, True]
    assert pages._digest(page.root.one("style").text) in policy


def test_ids_are_unique_and_every_reference_is_met(both: Any) -> None:
    _, page = both
    ids = [element.attributes["id"] for element in page.root.all() if "id" in element.attributes]
    assert len(ids) == len(set(ids))
    for name in ("for", "aria-labelledby", "aria-describedby"):
        for element in page.root.all():
            if name in element.attributes:
                assert element.attributes[name] in ids, element
    for link in page.root.all("a"):
        assert link.attributes["href"][1:] in ids, link
    for element in page.root.all("rect"):
        if element.attributes["fill"].startswith("url("):
            assert element.attributes["fill"][5:-1] in ids


def test_a_screen_reader_finds_its_way(both: Any) -> None:
    _, page = both
    levels = [int(e.tag[1]) for e in page.root.all() if re.fullmatch("h[1-6]", e.tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert set(levels) == {1, 2}
    for table in page.root.all("table"):
        assert table.all("caption")[0].text.strip()
        assert all(head.attributes.get("scope") in ("row", "col") for head in table.all("th"))
        widths = {len(row.all("th")) + len(row.all("td")) for row in table.all("tr")}
        assert len(widths) == 1, table.all("caption")[0].text
    labels = {label.attributes.get("for") for label in page.root.all("label")}
    for kind in ("select", "input"):
        for control in page.root.all(kind):
            inside = any(control in label.all() for label in page.root.all("label"))
            assert inside or control.attributes["id"] in labels
    for picture in page.root.all("svg"):
        assert picture.attributes["role"] == "img"
        assert picture.attributes["aria-label"]
    assert page.root.one("html").attributes["lang"] == "en"


def test_the_checks_are_those_of_the_report_failing_first(both: Any) -> None:
    analysis, page = both
    report = analysis.report()
    expected = {
        (c["name"], c["scope"]): (c["status"], c["residual"], c["tolerance"], c["value"], c["expected"])
        for c in report["checks"]
    }
    found = {}
    for row in page.root.one("table", id="checks-table").one("tbody").all("tr"):
        numbers = [[float(x) for x in data.attributes["value"].split()] for data in row.all("data")]
        plain = [x if len(x) > 1 else x[0] for x in numbers] or [None] * 4
        key = (row.attributes["data-name"], row.attributes["data-scope"])
        found[key] = (row.attributes["data-status"], *plain)
    assert found == expected
    ranks = [("fail", "pass", "not_applicable").index(status) for status, *_ in found.values()]
    assert ranks == sorted(ranks)


def test_the_numbers_of_topology_totals_and_columns(both: Any) -> None:
    analysis, page = both
    report = analysis.report()

    def shown(section: str) -> list[str]:
        return [data.attributes["value"] for data in page.root.one("section", id=section).all("data")]

    assert shown("topology") == ["" if v is None else str(v) for v in report["topology"].values()]
    totals = [" ".join(map(repr, v)) if isinstance(v, list) else repr(v) for v in report["totals"].values()]
    assert shown("totals")[: len(totals)] == ["" if text == "None" else text for text in totals]
    keys = ("min", "p02", "median", "p98", "max", "mean", "area_mean", "std", "nulls")
    columns = [c[key] for c in report["columns"].values() for key in keys]
    assert shown("columns") == ["" if v is None else repr(v) for v in columns]
    loops = page.root.all("section", id="loops")
    assert len(loops) == bool(report["loops"])
    if loops:
        assert len(loops[0].one("tbody").all("tr")) == len(report["loops"])
    components = page.root.one("section", id="components").one("tbody").all("tr")
    assert len(components) == len(report["components"])


def test_the_data_are_the_surface_to_float32(both: Any) -> None:
    analysis, page = both
    surface, data = analysis.surface, page.json()
    vertices = np.cumsum(page.block("vertices", "<u4", 1)[:, 0])
    np.testing.assert_array_equal(vertices, np.flatnonzero(surface.referenced))
    np.testing.assert_array_equal(
        page.block("positions", "<f4", 3), surface.points[vertices].astype(np.float32), strict=True
    )
    for k, column in enumerate(data["columns"]):
        assert column["exponent"] == 0
        expected = analysis.vertices[column["name"]][vertices].astype(np.float32)
        stored = page.block(f"column-{k}", "<f4", 1)[: len(vertices), 0]
        np.testing.assert_array_equal(stored, expected, column["name"])
    names = [name for name, column in analysis.vertices.items() if column.ndim == 1 and column.dtype.kind != "U"]
    assert sorted(column["name"] for column in data["columns"]) == sorted(names)


def test_a_column_of_one_value_and_its_rounding_has_one_bar_and_one_number() -> None:
    mesh = of_sample("icosahedron")
    analysis, page = parsed(tuple(mesh.moved(mesh.points @ frame(33, 44))))
    assert 0 < np.ptp(analysis.vertices["A"]) < 1e-14
    place = [column["name"] for column in page.json()["columns"]].index("A")
    figure = page.root.one("figure", id=f"scale-{place}")
    bars = [rect for rect in figure.all("rect") if not rect.attributes["fill"].startswith("url(")]
    assert [float(bar.attributes["height"]) for bar in bars] == [30]
    assert [data.text for data in figure.one("p", **{"class": "ticks"}).all("data")] == ["0.7217"]
    assert [data.text for data in figure.one("p", **{"class": "cut"}).all("data")] == ["0", "0", "0"]


def test_warnings_come_with_their_hints() -> None:
    analysis, page = parsed(tuple(MESHES["not manifold"]))
    text = page.root.one("section", id="warnings").text
    assert analysis.notices
    for notice in analysis.notices:
        assert f"{notice.code}: {notice.count:,} {notice.message}" in text
        assert notice.hint is None or notice.hint in text


def test_vectors_are_told_without_the_marks_of_markdown() -> None:
    assert "**" in curvcli.passes.quantity("h_sigma").description
    text = page_of(curvcli.analyze(tetrahedron().surface(), ["h_sigma", "K_density"])).decode()
    assert "**H**" not in text
    assert "∂H" in text


def test_names_from_the_file_are_text(tmp_path: Path) -> None:
    path = labelled(grid(), tmp_path / "<script>alert(2)<&\x1b\n'.obj", HOSTILE)
    analysis = curvcli.analyze(str(path), regions="groups")
    content = page_of(analysis, command=f"curvcli analyze {HOSTILE}")
    page = Page(content)
    assert [script for script in page.root.all("script") if "alert" in script.text] == []
    assert page.root.all("img") == []
    assert "<script>alert(2)<&\\x1b\\n'.obj" in page.root.one("h1").text
    assert page.root.one("title").text.endswith("'.obj: curvature")
    assert HOSTILE in page.root.one("section", id="regions").all("tbody")[0].all("th")[0].text
    assert page.root.one("code", id="command").text == f"curvcli analyze {HOSTILE}"
    assert b"alert(1)>" not in content
    assert b"<script>alert" not in content


def test_regions_have_their_statistics_and_shares() -> None:
    given = of_sample("icosphere", size=162)
    labels = (given.points[given.faces].mean(axis=1)[:, 2] > 0).astype(np.int64)
    analysis = curvcli.analyze((given.points, given.faces), ["K", "h_signed"], regions=labels, stat="mean,area_p10")
    section = Page(page_of(analysis)).root.one("section", id="regions")
    rows = section.one("table", id="region-statistics").one("tbody").all("tr")
    names = [(row.one("th").text, row.all("td")[0].text) for row in rows]
    assert names == [(region, column) for region in "01" for column in ("K", "h_signed")]
    regions = analysis.report()["regions"]
    shown = [float(data.attributes["value"]) for data in rows[1].all("data")]
    assert shown == list(regions[0]["columns"]["h_signed"].values())
    heads = [head.text for head in section.all("th")]
    assert "share area" in heads


def test_a_large_mesh_is_simplified_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pages, "SURFACE_BYTES", 40_000)
    analysis, page = parsed(tuple(of_sample("icosphere", size=8000)))
    used = int(analysis.surface.referenced.sum())
    vertices = np.cumsum(page.block("vertices", "<u4", 1)[:, 0])
    assert len(vertices) == page.json()["vertices"] < used / 4
    note = page.root.one("p", **{"class": "note"}).text
    assert f"{len(vertices):,} of {used:,} vertices" in note
    blocks = [script for script in page.root.all("script") if script.attributes.get("id", "").startswith("block-")]
    assert sum(len(script.text) for script in blocks) <= 40_000
    names = [column["name"] for column in page.json()["columns"]]
    K = page.block(f"column-{names.index('K')}", "<f4", 1)[:, 0]
    np.testing.assert_array_equal(K, analysis.vertices["K"][vertices].astype(np.float32))


def test_the_same_analysis_gives_the_same_bytes() -> None:
    analysis = curvcli.analyze(tuple(grid()))
    assert page_of(analysis) == page_of(analysis)


# SHA-256 of build/three.min.js, examples/js/controls/TrackballControls.js and LICENSE of the npm package three 0.147.0.
PINNED = {
    "three.min.js": "f34446bf875b5fb0dcd93819ffe1d9e182d46634ee855f5d904c6c4ac7cdbc95",
    "TrackballControls.js": "68efcc085c07621100745d50f0f8dd150f929cfd744b9a98a27e7e1e01ef76bc",
    "LICENSE": "fbf3943930dacbf56aabb8dc5d816440bd16aa6f4cc78ddbdf12106ee1807832",
}


def test_the_viewer_is_three_js_as_npm_has_it_with_its_licence() -> None:
    folder = Path(str(engines.__file__)).parent / "three"
    found = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}
    assert found == PINNED
    code = engine()
    assert 'const e="147"' in code[:2000]
    assert engines.VERSION.split(".")[1] == "147"
    assert " ".join((folder / "LICENSE").read_text("utf-8").split()) in " ".join(code.split())
    assert "SPDX-License-Identifier: MIT" in code
    assert "GLTFLoader" not in code
    assert "</script" not in code.lower()
    assert "\r" not in code
    assert len(code) < 700_000


def test_the_viewer_has_what_the_page_uses() -> None:
    code = engine()
    scene = (Path(str(pages.__file__)).parent / "templates" / "scene.js").read_text("utf-8")
    names = set(re.findall(r"THREE\.(\w+)", scene))
    assert len(names) > 15
    assert [name for name in sorted(names) if f"t.{name}=" not in code and f"THREE.{name} =" not in code] == []


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_the_viewer_defines_three_as_a_plain_script(tmp_path: Path) -> None:
    (tmp_path / "engine.js").write_text(engine(), "utf-8")
    code = """
const vm = require("vm"), fs = require("fs");
const context = vm.createContext({ console: { warn: (text) => { throw new Error(text); } } });
vm.runInContext(fs.readFileSync("engine.js", "utf-8"), context);
const found = vm.runInContext("[THREE.REVISION, typeof THREE.TrackballControls, typeof THREE.WebGLRenderer]", context);
console.log(JSON.stringify(found));
"""
    done = subprocess.run(["node", "-e", code], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.strip() == '["147","function","function"]'


def test_of_very_many_pieces_the_first_are_listed_and_all_are_counted() -> None:
    corners = np.random.default_rng(0).uniform(0, 1, (450, 3)) + np.repeat(np.arange(150.0), 3)[:, None]
    _, page = parsed((corners, np.arange(450).reshape(-1, 3)))
    for name in ("components", "loops"):
        section = page.root.one("section", id=name)
        assert len(section.one("tbody").all("tr")) == 100
        assert re.match(rf"150 {name}, the first 100 are shown; --table {name}=PATH", section.one("caption").text)
    assert len(page.root.one("table", id="checks-table").one("tbody").all("tr")) <= 100
