"""Pictures of creased meshes: edges in the colours of their bend, and flat sides that are not painted as curved."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.errors import UsageError
from curvcli.output.appearance import Appearance
from curvcli.output.cells import own_cells
from curvcli.output.html.page import page as page_bytes
from curvcli.output.pictures.options import PictureOptions
from curvcli.output.write import check_appearance
from tests.helpers import meshes
from tests.helpers.cli.program import curvcli as program
from tests.helpers.images import near, opengl
from tests.helpers.meshes import Mesh
from tests.output.coloring import colored
from tests.output.html.parsed import Page
from tests.output.pictures.test_pictures import picture, seen

__all__ = ["opengl"]
pytestmark = pytest.mark.usefixtures("opengl")


def tin(n: int = 48) -> Mesh:
    """A closed cylinder as CAD tessellates it: every vertex on a rim, the flat sides fans from one of them."""
    angle = 2 * np.pi * np.arange(n) / n
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([np.column_stack([rim, np.full(n, z)]) for z in (-0.5, 0.5)])
    k = np.arange(n)
    ahead = (k + 1) % n
    sides = np.concatenate([np.stack([k, ahead, ahead + n], 1), np.stack([k, ahead + n, k + n], 1)])
    inner = np.arange(1, n - 1)
    top = np.stack([0 * inner + n, inner + n, inner + n + 1], 1)
    return meshes.mesh(points, np.concatenate([sides, top, top[:, ::-1] - n]))


def analysed(mesh: Mesh) -> Analysis:
    return curvcli.analyze((mesh.points, mesh.faces), ["core", "curvedness"])


@pytest.mark.parametrize("column", ["h_signed", "K_density", "curvedness", "kappa_1"])
def test_the_flat_side_of_a_cylinder_is_not_painted_as_curved(column: str) -> None:
    """Seen from above, all but a narrow rim has the colour of 0."""
    analysis = analysed(tin())
    assert "creased" in {notice.code for notice in analysis.notices}
    scale = colored(analysis, column).scale
    flat = scale.gradient[len(scale.gradient) // 2 if scale.signed else 0]
    pixels = seen(analysis, color_by=(column,), picture=PictureOptions(view="top", size=(800, 800)))
    height, width = pixels.shape[:2]
    middle = pixels[height // 2 - 150 : height // 2 + 100, width // 2 - 120 : width // 2 + 120, :3]
    assert near(middle, tuple(int(part) for part in flat), 24).mean() > 0.99


def test_edges_have_the_colours_of_theta() -> None:
    analysis = analysed(tin())
    _, told = picture(analysis, color_by=("theta",), picture=PictureOptions(size=(800, 800)))
    assert told[0].split("theta: ")[1].startswith("−1.571 to 1.571")
    scale = colored(analysis, "theta").scale
    assert len(scale.rgb) == len(analysis.surface.edges)
    pixels = seen(analysis, color_by=("theta",), picture=PictureOptions(size=(800, 800)))
    sharp = near(pixels[..., :3], tuple(int(part) for part in scale.gradient[-1]), 20)
    assert 500 < sharp.sum() < 20000
    both = seen(analysis, color_by=("theta", "h_signed", "kappa_across"), picture=PictureOptions(size=(1200, 500)))
    assert both.shape[1] == 1200


def test_flat_edges_are_rounding() -> None:
    flat = meshes.grid(12)
    turned = (flat.points * [1, 1, 0]) @ np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    analysis = curvcli.analyze((turned, flat.faces), "core")
    for name in ("theta", "kappa_across", "H_theta"):
        scale = colored(analysis, name).scale
        assert (scale.low, scale.high) == (0.0, 0.0)
        assert scale.rounded is not None


def test_coloured_meshes_have_no_edges() -> None:
    for suffix in (".ply", ".glb", ".hist.png"):
        with pytest.raises(UsageError, match="theta: a column of edges"):
            check_appearance(Appearance(color_by=("theta",)), ["K"], [suffix])
    with pytest.raises(UsageError, match="theta"):
        check_appearance(Appearance(color_by=("thta",)), ["K"], [".png"])
    check_appearance(Appearance(color_by=("theta",)), ["K"], [".png", ".csv"])


def test_smooth_meshes_are_blended_as_before() -> None:
    torus = meshes.of_sample("torus", size=300)
    analysis = curvcli.analyze((torus.points, torus.faces), "core")
    colors = np.unique(
        seen(analysis, color_by=("h_signed",), picture=PictureOptions(size=(600, 600)))[..., :3].reshape(-1, 3), axis=0
    )
    assert len(colors) > 2000


@pytest.mark.parametrize("seed", range(3))
def test_cells_tile_the_faces(seed: int) -> None:
    mesh = meshes.grid(6, seed)
    colors = np.random.default_rng(seed).integers(0, 200, (len(mesh.points), 3)).astype(np.uint8)
    cells = own_cells(mesh.points, mesh.faces, colors, (255, 0, 0))

    def areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
        a, b, c = (points[faces[:, k]] for k in range(3))
        return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2

    assert areas(cells.positions, cells.faces).sum() == pytest.approx(areas(mesh.points, mesh.faces).sum(), rel=1e-12)
    tinted = (cells.colors != [255, 0, 0]).any(axis=1)
    nearest = np.linalg.norm(cells.positions[tinted][:, None] - mesh.points[None], axis=2).argmin(axis=1)
    own = (cells.colors[tinted] == colors[nearest]).all(axis=1)
    assert own.mean() > 0.8  # the tips themselves, and all ends but those that two cells share


def test_pages_have_the_edges_and_keep_colours_in_cells() -> None:
    analysis = analysed(tin())
    page = Page(page_bytes(analysis, Appearance(color_by=("theta", "h_signed")), ("theta", "h_signed"), None))
    data = page.json()
    cells = {column["name"]: column["cells"] for column in data["columns"]}
    assert cells["h_signed"]
    assert cells["K_density"]
    assert not cells["A"]
    assert not cells["K"]
    counts = [count for _, count in data["bend"]]
    theta = analysis.edges["theta"]
    assert sum(counts) == np.count_nonzero(np.abs(theta) > 0.05)
    assert data["bend"][-1][1] == np.count_nonzero(theta > 1.5)
    assert "theta" in page.root.one("figure", id="edge-scale").text
    smooth = meshes.of_sample("torus", size=300)
    plain = Page(page_bytes(curvcli.analyze((smooth.points, smooth.faces), "core"), Appearance(), (), None)).json()
    assert plain["bend"] == []
    assert not any(column["cells"] for column in plain["columns"])


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_the_cells_of_pages_are_those_of_pictures(tmp_path: Path) -> None:
    source = (Path(curvcli.__file__).parent / "output/html/templates/scene.js").read_text()
    function = source[source.index("function ownCells") :]
    function = function[: function.index("\n}\n") + 3]
    mesh = meshes.grid(3)
    script = f"""{function}
const {{ positions, owner }} = ownCells(
  new Float32Array({mesh.points.ravel().tolist()}), new Uint32Array({mesh.faces.ravel().tolist()}));
console.log(JSON.stringify([Array.from(positions), Array.from(owner)]));"""
    ran = subprocess.run(["node", "-e", script], capture_output=True, text=True, check=True)
    positions, owner = json.loads(ran.stdout)
    colors = np.column_stack([np.arange(len(mesh.points))] * 3).astype(np.uint8)
    wanted = own_cells(mesh.points, mesh.faces, colors, (255, 255, 255))
    places = np.where(wanted.colors[:, 0] == 255, -1, wanted.colors[:, 0].astype(int)).tolist()

    def triangles(at: np.ndarray, names: list[int]) -> list[object]:
        rows = np.column_stack([np.round(at, 5), np.asarray(names, float)]) + 0.0
        return sorted(map(tuple, rows.reshape(-1, 12).tolist()))

    found = triangles(np.reshape(positions, (-1, 3)), owner)
    np.testing.assert_allclose(found, triangles(wanted.positions, places), atol=3e-5)


def test_by_the_command_line(tmp_path: Path) -> None:
    path = tin().write(tmp_path / "tin.obj")
    ended = program("analyze", path, "-o", tmp_path / "x.png", "-o", tmp_path / "x.html", "--color-by", "theta")
    assert ended.code == 0
    refused = program("analyze", path, "-o", tmp_path / "x.ply", "--color-by", "theta")
    assert (refused.code, "a picture (.png)" in refused.complaint) == (2, True)
