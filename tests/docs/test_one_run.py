"""The page about one run: its files exist, and the run enters every module that its sections name."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from tests.docs.pages import ROOT, blocks, text

PAGE = "docs/one-run.md"
NAMED = re.compile(r"`((?:\w+/)*\w+(?:\.py|/))`")
FOLLOWED = """
import sys
sys.argv = ["curvcli", *sys.argv[1:]]
from curvcli.commands.main import main
from curvcli.__main__ import _wait
try:
    main(_wait, [])
finally:
    print("\\n".join(sys.modules), file=sys.stderr)
"""


def test_files_and_folders_exist() -> None:
    named = NAMED.findall(text(PAGE))
    assert len(named) > 30
    assert [path for path in named if not (ROOT / path).exists() and not (ROOT / "curvcli" / path).exists()] == []


def test_every_folder_of_the_package_is_on_the_page() -> None:
    package = ROOT / "curvcli"
    entries = [path.name + "/" * path.is_dir() for path in package.iterdir() if not path.name.startswith("_")]
    assert [name for name in entries if name != "py.typed" and f"`{name}`" not in text(PAGE)] == []


def test_the_run_enters_the_modules_of_its_sections(tmp_path: Path) -> None:
    (command,) = blocks(PAGE)
    arguments = command.code.replace("sample_meshes", str(ROOT / "sample_meshes")).split()[1:]
    done = subprocess.run(
        [sys.executable, "-c", FOLLOWED, *arguments],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={"PYTHONPATH": str(ROOT)},
    )
    assert (tmp_path / "k.csv").exists(), done.stderr
    entered = set(done.stderr.split())
    sections = text(PAGE).partition("## The other folders")[0]
    modules = [
        "curvcli." + path.removesuffix(".py").replace("/", ".")
        for path in NAMED.findall(sections)
        if path.endswith(".py")
    ]
    assert [module for module in modules if module not in entered] == []
