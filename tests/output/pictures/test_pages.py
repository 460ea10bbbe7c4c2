"""Pictures as pages: texts are texts, the surface has the resolution asked for, equal runs give equal bytes."""

from __future__ import annotations

import base64
import io
import re
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from xml.etree import ElementTree

import pytest

import curvcli
from curvcli.api import Analysis
from curvcli.errors import UsageError
from curvcli.output.appearance import Appearance
from curvcli.output.pictures.options import PictureOptions, check_picture_options
from curvcli.output.write import write_outputs
from tests.helpers.images import opengl
from tests.helpers.meshes import of_sample

__all__ = ["opengl"]
pytestmark = pytest.mark.usefixtures("opengl")

SVG = "{http://www.w3.org/2000/svg}"
LINK = "{http://www.w3.org/1999/xlink}href"


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    mesh = of_sample("torus", size=300)
    return curvcli.analyze((mesh.points, mesh.faces))


def drawn(analysis: Analysis, path: Path, **options: object) -> bytes:
    appearance = Appearance(color_by=("K_density",), picture=PictureOptions(size=(400, 300), **options))  # type: ignore[arg-type]
    write_outputs(analysis, [str(path)], appearance=appearance)
    return path.read_bytes()


def images_of(svg: bytes) -> list[tuple[int, int]]:
    """Width and height in pixels of the images in an SVG."""
    from PIL import Image

    found = []
    for each in ElementTree.fromstring(svg).iter(f"{SVG}image"):
        kind, _, content = each.attrib[LINK].partition(",")
        assert kind == "data:image/png;base64"
        with Image.open(io.BytesIO(base64.b64decode(content))) as image:
            found.append(image.size)
    return found


def texts_of(svg: bytes) -> list[str]:
    return ["".join(each.itertext()).strip() for each in ElementTree.fromstring(svg).iter(f"{SVG}text")]


@pytest.mark.parametrize("suffix", ["pdf", "svg", "hist.pdf", "hist.svg"])
def test_equal_runs_give_equal_bytes(analysis: Analysis, tmp_path: Path, suffix: str) -> None:
    first, second = (drawn(analysis, tmp_path / f"{k}.{suffix}") for k in range(2))
    assert first == second
    assert first.startswith(b"%PDF-" if suffix.endswith("pdf") else b"<?xml")
    assert not re.search(rb"CreationDate|<dc:date>", first)


@pytest.mark.parametrize("suffix", ["svg", "hist.svg"])
def test_the_texts_of_an_svg_are_texts(analysis: Analysis, tmp_path: Path, suffix: str) -> None:
    texts = texts_of(drawn(analysis, tmp_path / f"t.{suffix}"))
    assert "K_density" in texts
    assert any("vertices" in text for text in texts)
    assert any("p98 of |values|" in text for text in texts)


def test_a_pdf_contains_its_font_as_truetype(analysis: Analysis, tmp_path: Path) -> None:
    content = drawn(analysis, tmp_path / "t.pdf")
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", content, re.DOTALL)
    assert b"/FontFile2" in content
    assert b"/Type3" not in content
    # The content of the page comes first, with two bytes for each character and kerning between them.
    page = zlib.decompress(streams[0])
    assert b"K_density" in b"".join(re.findall(rb"\((.*?)\)", page)).replace(b"\0", b"")


@pytest.mark.parametrize("dpi", [100, 250])
def test_the_surface_has_the_resolution_asked_for(analysis: Analysis, tmp_path: Path, dpi: int) -> None:
    svg = drawn(analysis, tmp_path / "t.svg", dpi=dpi)
    root = ElementTree.fromstring(svg)
    assert root.attrib["width"] == "288pt"  # 400 pixels are 4 inches
    width, height = max(images_of(svg))
    margin = 2 * 8  # beside the surface, in pixels of the layout
    assert width == pytest.approx((400 - margin) * dpi / 100, abs=3)
    assert 150 * dpi / 100 < height < 300 * dpi / 100


def test_histograms_have_no_image(analysis: Analysis, tmp_path: Path) -> None:
    assert images_of(drawn(analysis, tmp_path / "t.hist.svg")) == []


def test_too_many_pixels_are_refused_before_any_work() -> None:
    with pytest.raises(UsageError, match=r"--dpi 1200: .* 14,400 pixels long.*--dpi 682"):
        check_picture_options(PictureOptions(dpi=1200), page=True)
    check_picture_options(PictureOptions(dpi=682), page=True)
    check_picture_options(PictureOptions(dpi=1200))


def test_threads_leave_the_settings_of_matplotlib_as_they_were(analysis: Analysis, tmp_path: Path) -> None:
    import matplotlib

    before = dict(matplotlib.rcParams)
    with ThreadPoolExecutor(4) as pool:
        pages = list(pool.map(lambda k: drawn(analysis, tmp_path / f"{k}.hist.svg"), range(8)))
    assert dict(matplotlib.rcParams) == before
    assert len(set(pages)) == 1
