"""`curvcli passes`: every quantity in a list, and all about one."""

from __future__ import annotations

import json

import pytest

from curvcli.report.quantities import public
from tests.cli.program import curvcli, wrote
from tests.columns import PUBLIC


def test_the_list() -> None:
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


def test_as_data() -> None:
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
