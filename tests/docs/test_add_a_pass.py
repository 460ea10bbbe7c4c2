"""Steps of docs/add-a-pass.md, on a copy of the project: a quantity everywhere."""

from __future__ import annotations

import csv
import json
import tomllib
from pathlib import Path

import pytest

from tests.docs.clone import changed, clone, follow
from tests.docs.pages import Block

PAGE = "docs/add-a-pass.md"
PLUGIN = "Write plugin/pyproject.toml"


def install(project: Path) -> None:
    """Install the plug-in as `pip install ./plugin` does, from its own description."""
    about = tomllib.loads((project / "plugin/pyproject.toml").read_text())["project"]
    info = project / "plugin" / f"{about['name'].replace('-', '_')}-{about['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {about['name']}\nVersion: {about['version']}\n")
    points = about["entry-points"]["curvcli.passes"]
    lines = "".join(f"{name} = {module}\n" for name, module in points.items())
    (info / "entry_points.txt").write_text(f"[curvcli.passes]\n{lines}")


@pytest.mark.slow
def test_the_page_as_written(tmp_path: Path) -> None:
    project = clone(tmp_path / "clone")

    def written(block: Block) -> None:
        if block.title == PLUGIN:
            install(project)

    follow(PAGE, project, written)
    # The quantity is there with nothing else touched: table, report, page, schema.
    with (project / "k.csv").open() as stream:
        cells = [row["canham"] for row in csv.DictReader(stream)]
    assert cells
    assert all(float(cell) > 0 for cell in cells)
    report = json.loads((project / "k.json").read_text())
    assert report["columns"]["canham"]["unit"] == "1"
    assert report["totals"]["canham"] == pytest.approx(sum(map(float, cells)))
    assert "## `canham`" in (project / "docs/quantities.md").read_text(encoding="utf-8")
    outside = {path for path in changed(project) if not path.startswith("docs/")}
    assert outside == {"curvcli/curvatures/principal.py"}
