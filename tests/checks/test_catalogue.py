"""The catalogues of passes, identities and requirements import every file that declares one, and no other."""

from __future__ import annotations

import pickle
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import curvcli.checks
from curvcli.checks import catalogue
from curvcli.checks.requirements import catalogue as of_requirements
from curvcli.curvatures import catalogue as of_passes

FOLDER = Path(curvcli.checks.__file__).parent
DECLARING = {
    "identities": (FOLDER, "@check(", catalogue.WITHOUT_IDENTITIES),
    "requirements": (FOLDER / "requirements", "@requirement(", of_requirements.WITHOUT_REQUIREMENTS),
    "passes": (FOLDER.parent / "curvatures", "@curvature_pass(", of_passes.WITHOUT_PASSES),
}


@pytest.mark.parametrize("kind", DECLARING)
def test_every_declaring_file_is_imported(kind: str) -> None:
    folder, decorator, others = DECLARING[kind]
    texts = {path.stem: path.read_text(encoding="utf-8") for path in folder.glob("*.py") if path.stem != "__init__"}
    declaring = {name for name, text in texts.items() if f"\n{decorator}" in text}
    assert declaring
    assert declaring.isdisjoint(others)
    assert texts.keys() >= set(others)


def test_the_catalogue_imports_no_identity() -> None:
    code = (
        "import sys, curvcli.checks.catalogue, curvcli.checks.requirements.catalogue\n"
        "print(*(m for m in sys.modules if m.endswith(('gauss_bonnet', 'holonomy', 'soundness'))))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert run.stdout.strip() == ""


def test_plug_ins_come_after_the_built_ins(monkeypatch: pytest.MonkeyPatch) -> None:
    built_in = list(catalogue.identities())
    plug_in = replace(catalogue.registered["gauss_bonnet"], name="of_a_plug_in", after=None)
    monkeypatch.setattr(catalogue, "registered", {"of_a_plug_in": plug_in, **catalogue.registered})
    assert list(catalogue.identities()) == [*built_in, "of_a_plug_in"]


def test_processes_pass_a_rule_on_by_name() -> None:
    rule = catalogue.identities()["holonomy"]
    assert pickle.loads(pickle.dumps(rule)) is rule
    code = f"import pickle; print(pickle.loads({pickle.dumps(rule)!r}).name)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert run.stdout.strip() == "holonomy"
