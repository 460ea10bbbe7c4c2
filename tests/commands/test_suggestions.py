"""An unknown name is answered by the few that are meant, in the same words everywhere, whatever the case."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import curvcli
from curvcli.support.words import suggest, suggestion
from tests.commands.conftest import Run
from tests.helpers.cli.program import CUBE

FOLDER = Path(curvcli.__file__).parent


def test_the_case_is_ignored() -> None:
    assert suggest("KAPPA_1", ["kappa_1", "kappa_2", "K"]) == ["kappa_1"]
    assert suggest("k", ["K", "kappa_1"]) == ["K"]
    assert suggest("Gauss-Bonnet", ["gauss_bonnet", "volume"]) == ["gauss_bonnet"]


def test_few_names_are_suggested_and_sensible_ones() -> None:
    many = [f"willmore_{k}" for k in range(50)] + ["area", "volume"]
    assert len(suggest("willmore", many)) == 3
    assert suggest("xyzzy", many) == []
    assert suggestion("xyzzy", many) == ""
    assert suggestion("xyzzy", many, "`curvcli passes` lists them") == "; `curvcli passes` lists them"
    assert suggestion("arae", many) == "; nearest: area"
    assert suggestion("xyzzy", ["a", "b"]) == "; known: a, b"
    assert suggestion("xyzzy", []) == ""


def test_a_name_may_be_begun() -> None:
    assert suggest("gauss", ["gauss_bonnet", "gauss_bonnet_combinatorial", "area_gradient"])[0] == "gauss_bonnet"
    assert "nonmanifold_edges" in suggest("nonman", ["nonmanifold_edges", "closed"])


ASKED = [
    (["analyze", CUBE, "-p", "KAPPA_1"], "nearest: kappa_1"),
    (["analyze", CUBE, "--color-by", "KAPPA_1"], "nearest: kappa_1"),
    (["analyze", CUBE, "--get", "TOTALS.K"], "nearest: totals"),
    (["analyze", CUBE, "--get", "totals.k"], "nearest: K"),
    (["analyze", CUBE, "--get", "topology.GENUS"], "nearest: genus"),
    (["analyze", CUBE, "-o", "x.cvs"], "nearest: .csv"),
    (["analyze", CUBE, "-o", "-", "--format", "CVS"], "nearest: csv"),
    (["analyze", CUBE, "--table", "Edges=x.csv"], "nearest: edges"),
    (["analyze", CUBE, "--cmap", "VIRDIS", "-o", "x.ply"], "nearest: viridis"),
    (["check", CUBE, "--require", "CLOSED"], "nearest: closed"),
    (["check", CUBE, "--require", "Genus=1"], "nearest: genus"),
    (["check", CUBE, "--allow", "Manifold"], "nearest: manifold"),
    (["check", CUBE, "--allow", "Gauss-Bonnet"], "nearest: gauss_bonnet"),
    (["check", CUBE, "--assert", "max(KAPPA_1)<1"], "nearest: kappa_1"),
    (["check", CUBE, "--assert", "MAX(kappa_1)<1"], "nearest: max"),
    (["passes", "KAPPA_1"], "nearest: kappa_1"),
    (["help", "Convention"], "nearest: conventions"),
    (["sample", "Icospher", "-o", "x.obj"], "nearest: icosphere"),
    (["sample", "icosphere", "--set", "Radios=2", "-o", "x.obj"], "nearest: radius"),
    (["Analyze", CUBE], "nearest: analyze"),
    (["batch", CUBE, "--save", "edgs.csv", "-o", "out"], "nearest: edges"),
]


@pytest.mark.parametrize(
    ("arguments", "expected"), ASKED, ids=lambda value: " ".join(value[:4:2]) if isinstance(value, list) else ""
)
def test_every_message_suggests(arguments: list[str], expected: str, within: Run) -> None:
    ended = within(*arguments)
    assert ended.code == 2
    assert expected in ended.complaint
    listed = ended.complaint.partition("nearest: ")[2].partition(";")[0].split(",")
    assert len(listed) <= 3


UNLIKE = [
    ["analyze", CUBE, "-p", "xyzzy"],
    ["analyze", CUBE, "--color-by", "xyzzy"],
    ["analyze", CUBE, "--get", "xyzzy"],
    ["check", CUBE, "--require", "xyzzy"],
    ["check", CUBE, "--allow", "xyzzy"],
    ["check", CUBE, "--assert", "max(xyzzy)<1"],
    ["passes", "xyzzy"],
    ["help", "xyzzy"],
    ["sample", "xyzzy", "-o", "x.obj"],
    ["xyzzy"],
]


@pytest.mark.parametrize("arguments", UNLIKE, ids=" ".join)
def test_what_is_like_nothing_is_shown_the_list_and_not_told_it(arguments: list[str], within: Run) -> None:
    ended = within(*arguments)
    complaint = ended.complaint
    assert ended.code == 2
    assert "nearest" not in complaint
    assert "lists them" in complaint or "shows them" in complaint
    assert complaint.count(",") < 4


def test_suggestions_are_made_in_one_place() -> None:
    """No other module compares names with `difflib`."""
    for path in FOLDER.rglob("*.py"):
        imported = {
            name
            for node in ast.walk(ast.parse(path.read_text()))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for name in ([node.module] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names])
        }
        assert "difflib" not in imported or path.name == "words.py", path
