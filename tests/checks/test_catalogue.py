"""The catalogues of identities and requirements name every file, and importing them runs none."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import pytest

import curvcli.checks
from curvcli.checks import catalogue
from curvcli.checks.requirements import catalogue as of_requirements

FOLDER = Path(curvcli.checks.__file__).parent
DECLARING = {
    "identities": (FOLDER, "@check(", catalogue.BUILT_IN),
    "requirements": (FOLDER / "requirements", "@requirement(", of_requirements.BUILT_IN),
}


@pytest.mark.parametrize("kind", DECLARING)
def test_every_declaring_file_is_listed(kind: str) -> None:
    folder, decorator, listed = DECLARING[kind]
    declaring = {path.stem for path in folder.glob("*.py") if f"\n{decorator}" in path.read_text(encoding="utf-8")}
    assert declaring == set(listed)
    assert len(listed) == len(declaring)


def test_the_catalogue_imports_no_identity() -> None:
    code = (
        "import sys, curvcli.checks.catalogue, curvcli.checks.requirements.catalogue\n"
        "print(*(m for m in sys.modules if m.endswith(('gauss_bonnet', 'holonomy', 'soundness'))))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert run.stdout.strip() == ""


def test_plug_ins_come_after_the_built_ins(monkeypatch: pytest.MonkeyPatch) -> None:
    built_in = list(catalogue.identities())
    first = dict.fromkeys(["of_a_plug_in", *built_in], catalogue.registered["gauss_bonnet"])
    monkeypatch.setattr(catalogue, "registered", first)
    assert list(catalogue.identities()) == [*built_in, "of_a_plug_in"]


def test_processes_pass_a_rule_on_by_name() -> None:
    rule = catalogue.identities()["holonomy"]
    assert pickle.loads(pickle.dumps(rule)) is rule
    code = f"import pickle; print(pickle.loads({pickle.dumps(rule)!r}).name)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert run.stdout.strip() == "holonomy"
