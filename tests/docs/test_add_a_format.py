"""Steps of docs/add-a-format.md, on a copy of the project: an input format everywhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.clone import changed, clone, follow
from tests.docs.pages import ROOT


@pytest.mark.slow
def test_the_page_as_written(tmp_path: Path) -> None:
    project = clone(tmp_path / "clone")
    follow("docs/add-a-format.md", project)
    assert changed(project) <= {"docs/formats.md", "docs/command-line.md", "docs/performance.md"}
    package = {path.relative_to(project) for path in (project / "curvcli").rglob("*.py")}
    before = {path.relative_to(ROOT) for path in (ROOT / "curvcli").rglob("*.py")}
    assert package - before == {Path("curvcli/loading/formats/mesh.py")}
