"""Every shell block tagged `sh run` in the documentation runs as written, page by page, beside the sample meshes."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.program import environment

ROOT = Path(__file__).parent.parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]
BLOCK = re.compile(r"^```sh run\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PLAIN = re.compile(r"^```(?:sh|bash)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?://)([^)#]*)(#[^)]*)?\)")
NAMES = [str(page.relative_to(ROOT)) for page in PAGES]


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [name for name in NAMES if BLOCK.search(text(name))])
def test_shell_blocks_run(name: str, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "sample_meshes", tmp_path / "sample_meshes")
    programs = tmp_path / "bin"
    programs.mkdir()
    for program, arguments in (("python", ""), ("curvcli", " -m curvcli")):
        (programs / program).write_text(f'#!/bin/sh\nexec "{sys.executable}"{arguments} "$@"\n')
        (programs / program).chmod(0o755)
    path = f"{programs}:{environment()['PATH']}"
    for block in BLOCK.findall(text(name)):
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", block],
            cwd=tmp_path,
            env=environment(PATH=path),
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert done.returncode == 0, f"{block}\n{done.stdout}\n{done.stderr}"


@pytest.mark.parametrize("name", [name for name in NAMES if name != "README.md"])
def test_blocks_that_could_run_do(name: str) -> None:
    """What uses the sample meshes only is tagged, so that it is tried."""
    assert not [block for block in PLAIN.findall(text(name)) if "sample_meshes" in block]


@pytest.mark.parametrize("name", NAMES)
def test_links_lead_somewhere(name: str) -> None:
    for target, anchor in LINK.findall(text(name)):
        page = (ROOT / name).parent / target if target else ROOT / name
        assert page.exists(), target
        if anchor:
            headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
            slugs = {"#" + re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
            assert anchor in slugs, anchor


def test_every_page_is_linked_from_the_index() -> None:
    linked = {target for target, _ in LINK.findall(text("docs/index.md"))}
    pages = {str(page.relative_to(ROOT / "docs")) for page in (ROOT / "docs").glob("**/*.md")}
    assert pages - linked == {"index.md"}
