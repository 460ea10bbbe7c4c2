"""Parameters of passes: what a signature declares, what a text sets, and what is refused with the way out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.curvatures.registry import Registry, curvature_pass, passes
from curvcli.curvatures.setting import Setting
from curvcli.curvatures.setting_values import describe_settings, parse_described, parse_settings
from curvcli.errors import UsageError
from curvcli.support.arrays import Column
from tests.helpers import meshes

_ = curvcli.passes  # importing registers them


@pytest.fixture(autouse=True)
def registry() -> Iterator[Registry]:
    """The registry, put back as it was afterwards."""
    before = dict(passes._passes), dict(passes._providers)
    yield passes
    passes._passes, passes._providers = before


def declare() -> None:
    @curvature_pass(kind="density", pointwise=True, settings={"power": Setting("the exponent", minimum=0)})
    def shaped(K: Column, power: int = 1, *, factor: float = 2, word: str = "plain", turned: bool = False) -> Column:
        """A power of K."""
        return (-factor if turned else factor) * K**power + (0 if word == "plain" else 1)


def test_a_default_makes_a_parameter() -> None:
    declare()
    declared = passes["shaped"]
    assert declared.needs == ("K",)
    assert [(each.name, each.kind, each.default) for each in declared.settings] == [
        ("power", "int", 1),
        ("factor", "float", 2.0),
        ("word", "str", "plain"),
        ("turned", "bool", False),
    ]


def test_values_reach_the_function_by_every_road() -> None:
    declare()
    surface = meshes.torus().surface()
    K = curvcli.passes.K(surface)
    wanted = -3 * K**2 + 1
    given = {"power": 2, "factor": 3.0, "word": "x", "turned": True}
    np.testing.assert_array_equal(passes["shaped"](surface), 2 * K)
    np.testing.assert_array_equal(passes["shaped"](surface, **given), wanted)
    flat: dict[str, Any] = {f"shaped.{key}": value for key, value in given.items()}
    texts = ["shaped.power=2", "shaped.factor=3", "shaped.word=x", "shaped.turned=yes"]
    for settings in (flat, {"shaped": given}, texts):
        analysis = curvcli.analyze(surface, "K", settings=settings)
        np.testing.assert_array_equal(analysis.vertices["shaped"], wanted)
        said = analysis.report()["conventions"]["settings"]
        assert said == "shaped.factor=3 shaped.power=2 shaped.turned=true shaped.word=x"


def test_what_a_parameter_is_used_for_is_said_and_nothing_else() -> None:
    surface = meshes.torus().surface()
    assert curvcli.analyze(surface, "K").report()["conventions"]["settings"] is None
    assert curvcli.analyze(surface, "helfrich").report()["conventions"]["settings"] == "helfrich.c0=0"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("helfrch.c0=1", r"unknown pass 'helfrch'; nearest: helfrich"),
        ("helfrich.c=1", r"the pass helfrich has no parameter 'c'; nearest: c0"),
        ("helfrich=1", r"give one of c0"),
        ("K.c0=1", r"the pass K has no parameters; those of others: helfrich\.c0"),
        ("helfrich.c0", r"expected PASS\.NAME=VALUE, such as helfrich\.c0=0\.5"),
        ("helfrich.c0=", r"helfrich\.c0 is '', expected a finite number"),
        ("helfrich.c0==1", r"helfrich\.c0 is '=1', expected a finite number"),
        ("helfrich.c0=nan", r"helfrich\.c0 is 'nan', expected a finite number"),
        ("helfrich.c0=1e999", r"expected a finite number"),
        ("helfrich.c0=a=b", r"helfrich\.c0 of region 'a' is 'b', expected a finite number"),
        (["helfrich.c0=1", "helfrich.c0=1"], r"helfrich\.c0 is set twice"),
        (["helfrich.c0=a=1", "helfrich.c0=a=1"], r"helfrich\.c0 of region 'a' is set twice"),
        (5, r"settings 5: expected a mapping from PASS\.NAME"),
        ([("helfrich.c0", 1)], r"expected a mapping from PASS\.NAME to a value, or texts"),
        ({"helfrich.c0": True}, r"helfrich\.c0 is True, expected a finite number"),
        ({"helfrich.c0": [1.0]}, r"helfrich\.c0 is \[1\.0\], expected a finite number"),
        ({"helfrich": {"c1": 1}}, r"no parameter 'c1'; known: c0"),
        ({"shaped.power": 1.5}, r"shaped\.power is 1\.5, expected a whole number of at least 0"),
        ("shaped.power=-1", r"shaped\.power is '-1', expected a whole number of at least 0"),
        ("shaped.turned=maybe", r"shaped\.turned is 'maybe', expected true or false"),
        ({"shaped.word": 1}, r"shaped\.word is 1, expected a text"),
        ({"shaped.factor": {"a": 1.0}}, r"shaped\.factor has values by region"),
    ],
)
def test_a_wrong_value_is_refused(given: Any, message: str) -> None:
    declare()
    with pytest.raises(UsageError, match=message):
        parse_settings(given)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"c1": 1.0}, "pass helfrich has no parameter 'c1'; known: c0"),
        ({"c0": "x"}, "expected a finite number"),
        ({"c0": np.ones(3)}, "expected a finite number"),
    ],
)
def test_a_call_refuses_the_same(values: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        curvcli.passes["helfrich"](meshes.torus().surface(), **values)


@pytest.mark.parametrize(
    ("source", "settings", "message"),
    [
        ("def f(K, a: list = None): return K", {}, "the default of a is None, expected a type among float, int"),
        ("def f(K, a: float = float('nan')): return K", {}, "the default of a is nan, expected a finite number"),
        ("def f(K, a: int = 1.5): return K", {}, "the default of a is 1.5, expected a whole number"),
        ("def f(K, a=1): return K", {"b": Setting("x")}, "describes a parameter b, and its function has none"),
        ("def f(K, a: 'float | Column' = 0.0): return K", {}, "looks at one vertex at a time and needs a"),
    ],
)
def test_a_wrong_declaration_fails_at_once(source: str, settings: dict[str, Setting], message: str) -> None:
    space: dict[str, Any] = {}
    exec(source, space)
    with pytest.raises(UsageError, match=message):
        curvature_pass(pointwise=True, settings=settings)(space["f"])
    assert "f" not in passes


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"helfrich.c0": -0.1},
        {"helfrich.c0": {"a b='c": 1e-300, "": 2.0, "ü": 3.0}},
        {"helfrich.c0": {"tip": 0.5}},
    ],
)
def test_a_description_reads_back(given: dict[str, Any]) -> None:
    values = parse_settings(given)
    assert parse_described(describe_settings(values)) == values


def test_values_at_the_default_need_not_be_set_again() -> None:
    assert parse_described("helfrich.c0=0") == {}


def test_a_parameter_has_the_unit_of_the_file() -> None:
    """A mesh so small that it is computed in another unit of length."""
    surface = meshes.icosphere()
    plain = curvcli.passes["helfrich"](surface.surface(), c0=0.75)
    tiny = surface.moved(np.ldexp(surface.points, -200)).surface()
    assert tiny.unit_exponent
    np.testing.assert_array_equal(curvcli.passes["helfrich"](tiny, c0=float(np.ldexp(0.75, 200))), plain)
