"""`-o x.html` and `-o x.md` from the command line."""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from curvcli.batch.model import BatchItem, BatchSettings, Limits
from curvcli.batch.plan import saves
from curvcli.batch.run import run
from tests.helpers.cli.program import CUBE, DISK, curvcli, environment, wrote
from tests.output.html.parsed import Page


def test_several_meshes_each_with_its_pages(tmp_path: Path) -> None:
    arguments = ["analyze", CUBE, DISK, "-q", "-o", str(tmp_path / "{stem}.html"), "-o", str(tmp_path / "{stem}.md")]
    wrote(curvcli(*arguments, "--color-by", "A,K", "--range", "0:1", "--up", "y", "--view", "front"))
    for mesh in (CUBE, DISK):
        path = tmp_path / f"{Path(mesh).stem}.html"
        shown = Page(path.read_bytes())
        command = shlex.split(shown.root.one("code", id="command").text)
        assert command[:10] == ["curvcli", *arguments, "--color-by"]
        assert shown.root.one("h1").text == mesh
        assert shown.root.one("option", selected=None).text == "A"
        scales = {column["name"]: (column["low"], column["high"]) for column in shown.json()["columns"]}
        assert scales["A"] == scales["K"] == (0.0, 1.0) != scales["h"]
        assert shown.json()["view"] == [pytest.approx([0, 0, 1], abs=1e-9), pytest.approx([0, 1, 0], abs=1e-9)]
        assert path.with_suffix(".md").read_text().startswith(f"### curvcli: `{mesh}`\n")


def test_a_page_on_stdout(tmp_path: Path) -> None:
    ended = curvcli("analyze", CUBE, "-o", "-", "--format", "html")
    assert (ended.code, ended.err) == (0, "")
    assert Page(ended.out.encode()).root.one("h1").text == CUBE


def test_the_page_needs_no_viewer_of_trimesh(tmp_path: Path) -> None:
    """The library is a file of ours: the archive with the page of trimesh's viewer is never opened."""
    code = """
import sys, zipfile
def refuse(*_, **__): raise OSError("no archive")
zipfile.ZipFile = refuse
from curvcli.commands.main import main
sys.exit(main())
"""
    path = tmp_path / "cube.html"
    command = [sys.executable, "-c", code, "analyze", CUBE, "-q", "-o", str(path)]
    done = subprocess.run(command, env=environment(), capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    assert "THREE.TrackballControls" in path.read_text("utf-8")


def test_a_batch_writes_pages_that_name_its_command(tmp_path: Path) -> None:
    outputs = (("", str(tmp_path / "cube.html")), ("", str(tmp_path / "cube.md")))
    settings = BatchSettings(passes=("K", "A"), save=saves(["html,md"]), command="curvcli batch 'x/*.obj' -o y")
    row, failure = run(BatchItem(CUBE, CUBE, outputs), settings, Limits())
    assert (row.status, failure) == ("ok", False)
    assert Page((tmp_path / "cube.html").read_bytes()).root.one("code", id="command").text == settings.command
    assert f"```sh\n{settings.command}\n```" in (tmp_path / "cube.md").read_text()
    assert settings.digest() == BatchSettings(passes=("K", "A"), save=("html", "md")).digest()
