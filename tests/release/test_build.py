"""Released files: content, metadata, and a run elsewhere."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zipfile
from email import message_from_bytes
from email.message import Message
from pathlib import Path

import pytest
import yaml
from trove_classifiers import classifiers

import curvcli
from curvcli.commands.schemas import SCHEMAS
from tests.helpers.cli.program import ROOT, environment
from tests.release.conftest import Built

TORUS = ROOT / "sample_meshes" / "torus.obj"


def metadata(built: Built) -> Message:
    name = next(name for name in built.in_wheel if name.endswith(".dist-info/METADATA"))
    return message_from_bytes(zipfile.ZipFile(built.wheel).read(name))


def test_the_wheel_holds_the_package_and_nothing_else(built: Built) -> None:
    package = {
        str(path.relative_to(ROOT))
        for path in (ROOT / "curvcli").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    inside = {name for name in built.in_wheel if ".dist-info/" not in name}
    assert inside == package
    assert "curvcli/py.typed" in inside
    assert {f"curvcli/commands/data/schemas/{name}.schema.json" for name in SCHEMAS} <= inside
    assert {
        f"curvcli/output/html/three/{name}" for name in ("three.min.js", "TrackballControls.js", "LICENSE")
    } <= inside
    assert {"curvcli/commands/data/topics/conventions.txt", "curvcli/commands/data/topics/python.txt"} <= inside


def test_the_source_archive_holds_what_is_needed_to_work_on_it(built: Built) -> None:
    inside = set(built.in_sdist)
    assert {".ci/run", "README.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md", "pyproject.toml"} <= inside
    assert {"tests/conftest.py", "tests/release/test_build.py", "sample_meshes/torus.obj", "PKG-INFO"} <= inside
    assert not [name for name in inside if "__pycache__" in name or name.endswith(".pyc")]
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("no repository here to compare the archive with")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    tracked = {name for name in listed.split("\0") if name and (ROOT / name).is_file()}
    assert tracked - inside <= {".gitignore"}


def test_the_version_stands_in_one_place(built: Built) -> None:
    version = curvcli.__version__
    assert metadata(built)["Version"] == version
    assert built.wheel.name.startswith(f"curvcli-{version}-py3-none-any")
    assert built.sdist.name == f"curvcli-{version}.tar.gz"
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["version"] == version
    others = [
        path
        for path in (ROOT / "curvcli").rglob("*")
        if path.suffix in (".py", ".json", ".txt") and f'"{version}"' in path.read_text(encoding="utf-8")
    ]
    assert others == [ROOT / "curvcli" / "_version.py"]
    log = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.findall(r"^## (\S+)", log, re.MULTILINE)
    assert released[0] in ("Unreleased", version)


def test_the_metadata_has_licence_and_python(built: Built) -> None:
    said = metadata(built)
    assert said["License-Expression"] == "MIT"
    assert said.get_all("License-File") == ["LICENSE", "curvcli/output/html/three/LICENSE"]
    assert said["Requires-Python"] == ">=3.11"
    assert said["Summary"]
    assert said["Description-Content-Type"] == "text/markdown"
    page = said.get_payload(decode=True)
    assert isinstance(page, bytes)
    assert page.strip() == (ROOT / "README.md").read_bytes().strip()
    given = said.get_all("Classifier") or []
    assert set(given) <= classifiers
    # Beside a licence expression such classifiers are not allowed.
    assert not [name for name in given if name.startswith("License ::")]
    assert said.get_all("Project-URL")
    assert {"test", "dask", "remote", "dev"} <= set(said.get_all("Provides-Extra") or [])


def test_the_citation_has_the_keys_of_its_format() -> None:
    """The keys that the Citation File Format 1.2 demands, and the licence of the project."""
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["cff-version"] == "1.2.0"
    assert {"message", "title", "authors"} <= cited.keys()
    assert cited["license"] == "MIT"
    assert cited["type"] == "software"
    paper = cited["references"][0]
    assert (paper["year"], paper["authors"][0]["family-names"]) == (2008, "Sullivan")


def run(folder: Path, installed: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    program = installed / "bin" / "curvcli"
    # Isolated from the folder it is started in; what is installed comes first, its dependencies after it.
    path = os.pathsep.join([str(installed), *(entry for entry in sys.path if entry.endswith("site-packages"))])
    return subprocess.run(
        [sys.executable, "-P", "-W", "error", str(program), *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        env=environment(PYTHONPATH=path),
    )


def test_what_is_installed_runs(installed: Path, tmp_path: Path) -> None:
    assert run(tmp_path, installed, "--version").stdout == f"curvcli {curvcli.__version__}\n"
    where = run(tmp_path, installed, "help", "schemas").stdout
    assert "analyze" in where
    found = run(tmp_path, installed, "analyze", str(TORUS), "-o", "k.csv", "--get", "topology.genus")
    assert (found.returncode, found.stdout, found.stderr) == (0, "1\n", "")
    assert (tmp_path / "k.csv").stat().st_size > 0
    assert run(tmp_path, installed, "help", "conventions").stdout.startswith("# Conventions")


def test_it_is_the_installed_package_that_runs(installed: Path, tmp_path: Path) -> None:
    path = os.pathsep.join([str(installed), *(entry for entry in sys.path if entry.endswith("site-packages"))])
    program = "import curvcli; print(curvcli.__file__)"
    done = subprocess.run(
        [sys.executable, "-P", "-c", program],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env=environment(PYTHONPATH=path),
    )
    assert Path(done.stdout.strip()).is_relative_to(installed), done.stderr
