"""A copy of the project, on which a test follows a page of instructions."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path

from tests.docs.pages import ROOT, Block, blocks
from tests.docs.programs import provide, served, shell

FILES = ("pyproject.toml", "mkdocs.yml", "README.md", ".gitignore", ".pre-commit-hooks.yaml")
PARTS = ("curvcli", "docs", "tests", "sample_meshes", *FILES)


# Titles of blocks that are files of the project; the path follows.
WRITTEN = ("Write ", "Append to ")


def clone(folder: Path) -> Path:
    """The project as it is, with the programs that pages call in `bin`."""
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
    is_file = block.title.startswith(WRITTEN)
    if is_file:
        (project / path).parent.mkdir(exist_ok=True)
        with (project / path).open("a" if doing == "Append to" else "w", encoding="utf-8") as stream:
            stream.write(block.code)
    return is_file


def follow(page: str, project: Path, written: Callable[[Block], None] = lambda _: None) -> None:
    """Run the commands of a page and write its files, in order. written: called after each file."""
    paths = {"PYTHONPATH": f"{project}:{project / 'plugin'}"}
    steps = [block for block in blocks(page) if not block.reason]
    # The program starts anew once its code has changed.
    parts = [list(part) for _, part in groupby(steps, lambda block: block.language == "sh")]
    for part in parts:
        if part[0].language == "sh":
            with served(project / "bin", **paths):
                shell("\n".join(block.code for block in part), project, project / "bin", **paths)
            continue
        for block in part:
            assert write(block, project), f"{page}:{block.line}: neither a file nor commands"
            written(block)


def changed(project: Path) -> set[str]:
    """The Python files and pages of the project that differ now, without those that are new."""
    return {
        str(path.relative_to(ROOT))
        for folder in ("curvcli", "tests", "docs")
        for path in (ROOT / folder).rglob("*")
        if path.suffix in (".py", ".md") and "corpus" not in path.parts
        if (project / path.relative_to(ROOT)).read_bytes() != path.read_bytes()
    }
