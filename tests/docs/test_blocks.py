"""Every block of code in the documentation runs as written, or says above itself why it cannot."""

from __future__ import annotations

import json
import shutil
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.docs.clone import WRITTEN
from tests.docs.pages import NAMES, ROOT, Block, blocks
from tests.docs.programs import provide, served, shell
from tests.docs.shown import OUTPUT, missing

RUN = ("sh", "python")
SHOWN = ("text", "yaml", "toml", "json", "make", "snakemake", "dockerfile", "csv")

# Tests of their own follow the pages that write files of the project, on a copy of it.
FOLLOWED = [name for name in NAMES if any(block.title.startswith(WRITTEN) for block in blocks(name))]

# What a README installs, the continuous integration installs in an empty environment: see `.ci/run`.
INSTALLS = "pip install"
INSTALLED = "pip install . && "


@pytest.mark.parametrize("name", FOLLOWED)
def test_a_test_follows_a_page_that_writes_files(name: str) -> None:
    test = Path(__file__).with_name(f"test_{Path(name).stem.replace('-', '_')}.py")
    assert f'"{name}"' in test.read_text(encoding="utf-8")


def runnable(name: str) -> list[Block]:
    """The blocks of a page that are to run; of the README without the installation."""
    found = [block for block in blocks(name) if block.language in RUN and not block.reason and name not in FOLLOWED]
    if name == "README.md":
        found = [replace(block, code=block.code.removeprefix(INSTALLED)) for block in found]
        return [block for block in found if INSTALLS not in block.code]
    return found


def outputs_of(name: str) -> dict[int, str]:
    """The output that a page shows after a block of commands, by the line of the commands."""
    pairs = zip(blocks(name), blocks(name)[1:], strict=False)
    return {block.line: after.code for block, after in pairs if block.language == "sh" and after.title == OUTPUT}


@pytest.mark.parametrize("name", NAMES)
def test_every_output_stands_behind_its_commands(name: str) -> None:
    shown = len(outputs_of(name))
    assert shown == sum(block.title == OUTPUT for block in blocks(name))
    assert shown >= {"README.md": 1, "docs/tutorial.md": 5}.get(name, 0)


@pytest.mark.parametrize("name", NAMES)
def test_every_block_says_what_it_is(name: str) -> None:
    for block in blocks(name):
        assert block.language in (*RUN, *SHOWN), f"{name}:{block.line}: {block.language!r}"


@pytest.mark.parametrize("name", NAMES)
def test_blocks_of_data_can_be_read(name: str) -> None:
    readers = {"yaml": yaml.safe_load, "toml": tomllib.loads, "json": json.loads}
    for block in blocks(name):
        if block.language in readers:
            readers[block.language](block.code)


def test_what_the_readme_installs_is_run_in_an_empty_environment() -> None:
    """`.ci/run` runs the first two blocks of commands as they stand."""
    commands = [block.code for block in blocks("README.md") if block.language == "sh"]
    assert [INSTALLS in code for code in commands] == [True, True] + [False] * (len(commands) - 2)
    run = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert 'eval "$(command_of 1)"' in run
    assert 'eval "$(command_of 2)"' in run


# ---------------------------------------------------------------------------- blocks that run


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with `curvcli` and `python`."""
    folder = tmp_path_factory.mktemp("bin")
    provide(folder, python="")
    with served(folder):
        yield folder


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory, programs: Path) -> Path:
    """A folder with the files that pages speak of."""
    folder = tmp_path_factory.mktemp("stage")
    samples = folder / "sample_meshes"
    shutil.copytree(ROOT / "sample_meshes", samples)
    for given, name in (
        ("sphere.obj", "bunny.obj"),
        ("sphere.ply", "bunny.ply"),
        ("cube.stl", "part.stl"),
        ("sphere.ply", "scans/a.ply"),
        ("torus.ply", "scans/more/b.ply"),
        ("sphere.ply", "cortex.ply"),
        ("sphere.obj", "flattened.obj"),
        ("sphere.ply", "vesicle.ply"),
    ):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(samples / given, folder / name)
    faces = int((samples / "sphere.ply").read_bytes().split(b"element face ")[1].split()[0])
    (folder / "parcels.csv").write_text("region\n" + "".join(f"{face % 3}\n" for face in range(faces)))
    (folder / "knot.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nl 1 2 3 4 1\n")
    shell("curvcli analyze bunny.obj -q -o baseline.json", folder, programs)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if runnable(name)])
def test_the_blocks_of_a_page_run_as_written(
    name: str, stage: Path, programs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the order of the page, beside the sample meshes; shells and Python share a folder."""
    folder = tmp_path / "page"
    shutil.copytree(stage, folder)
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {"__name__": "page"}
    waiting: list[str] = []
    outputs = outputs_of(name)
    for block in [*runnable(name), None]:
        if block is not None and block.language == "sh" and block.line not in outputs:
            waiting.append(block.code)
            continue
        if waiting:
            shell("\n".join(waiting), folder, programs)
            waiting = []
        if block is not None and block.language == "sh":
            printed = shell(block.code, folder, programs)
            assert missing(outputs[block.line], printed) == [], f"{name}:{block.line}\n{printed}"
        elif block is not None:
            code = "\n" * (block.line - 1) + block.code
            exec(compile(code, str(ROOT / name), "exec"), names)
