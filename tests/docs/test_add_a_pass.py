"""Whoever follows docs/add-a-pass.md, on a copy of the project, has a quantity that is everywhere."""

from __future__ import annotations

import csv
import json
import shutil
import tomllib
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path

import pytest

from tests.docs.pages import ROOT, Block, blocks
from tests.docs.programs import provide, served, shell

PAGE = "docs/add-a-pass.md"
PARTS = ("curvcli", "docs", "tests", "sample_meshes", "pyproject.toml", "mkdocs.yml", "README.md", ".gitignore")
PLUGIN = "Write plugin/pyproject.toml"


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project as it is before anybody follows the page."""
    folder = tmp_path_factory.mktemp("clone")
    for part in PARTS:
        if (ROOT / part).is_dir():
            shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__", "corpus"))
        elif (ROOT / part).exists():
            shutil.copy(ROOT / part, folder / part)
    # The linter comes with the tools for development only.
    provide(folder / "bin", python="", ruff="-m ruff" if find_spec("ruff") else "-c pass")
    return folder


def write(block: Block, project: Path) -> bool:
    """Write or append to the file that a block names; whether it names one."""
    doing, _, path = block.title.rpartition(" ")
    if doing in ("Write", "Append to"):
        (project / path).parent.mkdir(exist_ok=True)
        with (project / path).open("a" if doing == "Append to" else "w", encoding="utf-8") as stream:
            stream.write(block.code)
    return doing in ("Write", "Append to")


def install(project: Path) -> None:
    """What `pip install ./plugin` does, from the plug-in's own description."""
    about = tomllib.loads((project / "plugin/pyproject.toml").read_text())["project"]
    info = project / "plugin" / f"{about['name'].replace('-', '_')}-{about['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {about['name']}\nVersion: {about['version']}\n")
    points = about["entry-points"]["curvcli.passes"]
    lines = "".join(f"{name} = {module}\n" for name, module in points.items())
    (info / "entry_points.txt").write_text(f"[curvcli.passes]\n{lines}")


@pytest.mark.slow
def test_the_page_as_written(project: Path) -> None:
    paths = {"PYTHONPATH": f"{project}:{project / 'plugin'}"}
    steps = [block for block in blocks(PAGE) if not block.reason]
    # The program starts anew once its code has changed.
    parts = [list(part) for _, part in groupby(steps, lambda block: block.language == "sh")]
    for part in parts:
        if part[0].language == "sh":
            with served(project / "bin", **paths):
                shell("\n".join(block.code for block in part), project, project / "bin", **paths)
            continue
        for block in part:
            assert write(block, project), f"{PAGE}:{block.line}: neither a file nor commands"
            if block.title == PLUGIN:
                install(project)
    # The quantity is there with nothing else touched: table, report, page, schema.
    with (project / "k.csv").open() as stream:
        cells = [row["canham"] for row in csv.DictReader(stream)]
    assert cells
    assert all(float(cell) > 0 for cell in cells)
    report = json.loads((project / "k.json").read_text())
    assert report["columns"]["canham"]["unit"] == "1"
    assert report["totals"]["canham"] == pytest.approx(sum(map(float, cells)))
    assert "## `canham`" in (project / "docs/quantities.md").read_text(encoding="utf-8")
    changed = {
        str(path.relative_to(ROOT))
        for folder in ("curvcli", "tests", "docs")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in (".py", ".md") and "corpus" not in path.parts
        if (project / path.relative_to(ROOT)).read_bytes() != path.read_bytes()
    }
    assert "curvcli/curvatures/principal.py" in changed
    assert {path for path in changed if not path.startswith("docs/")} == {"curvcli/curvatures/principal.py"}
