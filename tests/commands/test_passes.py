"""`curvcli passes`: every quantity in a list, and all about one."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from curvcli.curvatures.catalogue import resolve
from curvcli.report.quantities import find, public
from tests.helpers.cli.program import CUBE, Ended, curvcli, wrote
from tests.helpers.columns import PUBLIC

Run = Callable[..., Ended]


def test_the_list_has_every_public_quantity() -> None:
    ended = curvcli("passes")
    wrote(ended)
    words = ended.out.split()
    for name in PUBLIC:
        assert name in words, name


@pytest.mark.parametrize("name", ["K", "H_vec", "theta", "kappa_1"])
def test_all_about_one(name: str) -> None:
    ended = curvcli("passes", name)
    wrote(ended)
    quantity = PUBLIC[name]
    text = "".join(ended.out.split())
    for fact in (quantity.name, quantity.source, quantity.kind, quantity.description.split(".")[0].split(",")[0]):
        assert "".join(fact.split()) in text


def test_the_list_as_json_has_every_quantity() -> None:
    ended = curvcli("passes", "--json")
    wrote(ended)
    listed = {entry["name"]: entry for entry in json.loads(ended.out)}
    assert listed.keys() == {quantity.name for quantity in public()}
    for name, quantity in PUBLIC.items():
        assert listed[name]["length_exponent"] == quantity.length_exponent
        assert listed[name]["columns"] == list(quantity.columns)
        assert listed[name]["parity"] == quantity.parity
        # Words for people hold no marks of Markdown.
        assert not any("*" in text for text in listed[name].values() if isinstance(text, str)), name
        needs = {*listed[name]["needs"]} - {"the area chosen by --area"}
        assert needs <= PUBLIC.keys(), "what it needs can be looked up"
    one = curvcli("passes", "K", "--json")
    wrote(one)
    assert json.loads(one.out) == listed["K"]


def test_a_component_of_a_vector_names_the_vector() -> None:
    ended = curvcli("passes", "A_vec_x", "--json")
    wrote(ended)
    assert json.loads(ended.out)["name"] == "A_vec"


@pytest.mark.parametrize("column", [column for quantity in PUBLIC.values() for column in quantity.columns])
def test_a_column_is_explained_as_the_one_that_is_computed(column: str) -> None:
    """Vertices and edges both have H_vec_x; `-p` computes that of vertices."""
    assert find(column).name == resolve([column])[0]


@pytest.mark.parametrize(("name", "meant"), [("CORE", "core"), ("k", "K"), ("h_VEC", "H_vec")])
def test_names_in_another_case_are_near(name: str, meant: str, within: Run) -> None:
    for arguments in (("analyze", CUBE, "-p", name), ("passes", name)):
        if meant != "core" or arguments[0] == "analyze":
            ended = within(*arguments)
            assert ended.code == 2
            assert f"nearest: {meant}" in ended.complaint
