"""Steps of docs/add-a-check.md, on a copy of the project: an identity and a requirement everywhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.clone import changed, clone, follow


@pytest.mark.slow
def test_the_page_as_written(tmp_path: Path) -> None:
    project = clone(tmp_path / "clone")
    follow("docs/add-a-check.md", project)
    outside = {path for path in changed(project) if not path.startswith("docs/")}
    assert outside == {
        "curvcli/checks/total_absolute_curvature.py",
        "curvcli/checks/requirements/shape.py",
    }
