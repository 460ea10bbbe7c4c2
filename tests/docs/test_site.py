"""The site builds with warnings as errors, offline, and asks nobody for anything."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml

from curvcli.report.quantities import public
from tests.docs.pages import NAMES, ROOT
from tests.helpers.cli.program import environment

NEEDED = ("mkdocs", "material", "mkdocstrings", "mkdocstrings_handlers")
ELSEWHERE = re.compile(r"""<(?:script|link|img|iframe)\b[^>]*\b(?:src|href)=["']?(?:https?:)?//""")


def built(folder: Path) -> None:
    for name in NEEDED:
        if find_spec(name) is None:
            pytest.skip(f"{name} is not installed; `pip install 'curvcli[docs]'`")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(folder)],
        cwd=ROOT,
        env=environment(NO_MKDOCS_2_WARNING="1", HTTPS_PROXY="http://127.0.0.1:9", HTTP_PROXY="http://127.0.0.1:9"),
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "WARNING" not in done.stderr


@pytest.mark.slow
def test_the_site_builds(tmp_path: Path) -> None:
    built(tmp_path)
    pages = {path.relative_to(tmp_path).as_posix() for path in tmp_path.glob("**/*.html")}
    assert {name.removeprefix("docs/").removesuffix(".md") + ".html" for name in NAMES if name != "README.md"} <= pages
    for page in pages:
        found = ELSEWHERE.search((tmp_path / page).read_text(encoding="utf-8"))
        assert found is None, (page, found and found[0])
    python = (tmp_path / "python.html").read_text(encoding="utf-8")
    for name in ("curvcli.load", "curvcli.analyze", "curvcli.Analysis", "curvcli.Surface"):
        assert f'id="{name}"' in python, name
    quantities = (tmp_path / "quantities.html").read_text(encoding="utf-8")
    assert [one.name for one in public() if f"<code>{one.name}</code>" not in quantities] == []


def test_every_page_is_in_the_menu() -> None:
    def leaves(entry: object) -> list[str]:
        if isinstance(entry, dict):
            return [leaf for value in entry.values() for leaf in leaves(value)]
        return [leaf for value in entry for leaf in leaves(value)] if isinstance(entry, list) else [str(entry)]

    menu = leaves(yaml.safe_load((ROOT / "mkdocs.yml").read_text(encoding="utf-8"))["nav"])
    assert sorted(menu) == sorted(name.removeprefix("docs/") for name in NAMES if name != "README.md")
