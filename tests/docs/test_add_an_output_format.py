"""Steps of docs/add-an-output-format.md, on a copy of the project: an output format everywhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.clone import changed, clone, follow
from tests.docs.pages import ROOT


@pytest.mark.slow
def test_the_page_as_written(tmp_path: Path) -> None:
    project = clone(tmp_path / "clone")
    follow("docs/add-an-output-format.md", project)
    assert not {path for path in changed(project) if not path.startswith("docs/")}
    package = {path.relative_to(project) for path in (project / "curvcli").rglob("*.py")}
    before = {path.relative_to(ROOT) for path in (ROOT / "curvcli").rglob("*.py")}
    assert package - before == {Path("curvcli/output/formats/mesh.py")}
