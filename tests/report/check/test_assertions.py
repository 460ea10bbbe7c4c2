"""Assertions: what they compute, what they compare, and what is no assertion."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli.api import analyze
from curvcli.errors import UsageError
from curvcli.report.check.assertions import OPERATORS, columns, parse
from tests.helpers import meshes
from tests.helpers.gates import judged, outcome

COLUMNS = ("K", "h_signed", "A_vec_y", "kappa_g", "degree", "theta", "length", "area", "normal_z", "willmore")


def values_of(analysis: object, column: str) -> tuple[np.ndarray, np.ndarray | None]:
    """The column and the areas of its elements, read from the library's own tables."""
    for table, area in (("vertices", "A"), ("edges", None), ("faces", "area")):
        held = getattr(analysis, table)
        if column in held:
            return held[column].astype(float), None if area is None else held[area]
    raise AssertionError(column)


@pytest.mark.parametrize("column", COLUMNS)
def test_a_statistic_is_taken_of_defined_values(column: str) -> None:
    body = meshes.cap()
    analysis = analyze((body.points, body.faces), "all")
    values, area = values_of(analysis, column)
    known = ~np.isnan(values)
    given = values[known]
    expected = {
        "min": given.min(),
        "max": given.max(),
        "absmax": np.abs(given).max(),
        "mean": given.mean(),
        "sum": given.sum(),
        "p02": np.quantile(given, 0.02),
        "p98": np.quantile(given, 0.98),
        "median": np.median(given),
        "std": given.std(),
        "p97.5": np.quantile(given, 0.975),
        "count": len(given),
        "nulls": len(values) - len(given),
    }
    if area is not None:
        expected["area_mean"] = (given * area[known]).sum() / area[known].sum()
        expected["area_p10"] = np.quantile(given, 0.1, weights=area[known], method="inverted_cdf")
    for statistic, value in expected.items():
        ((held, found, _, _),) = parse(f"{statistic}({column}) <= 0").judge(analysis)
        assert found == pytest.approx(value, rel=1e-12, abs=1e-15)
        assert held == (found <= 0)


@pytest.mark.parametrize("operator", OPERATORS)
def test_comparisons_are_exact_at_the_bound(operator: str) -> None:
    """Exact, also where the bound is met."""
    body = meshes.tetrahedron()
    analysis = analyze((body.points, body.faces), "topology")
    for bound in (2, 3, 4):
        ((held, value, _, _),) = parse(f"max( degree ){operator}{bound}").judge(analysis)
        assert value == 3.0
        expected = {2: (">", ">=", "!="), 3: ("<=", ">=", "=="), 4: ("<", "<=", "!=")}
        assert held == (operator in expected[bound])


@pytest.mark.parametrize("number", ["0", "-1", "+2.5", ".5", "3.", "1e-3", "-2E+10"])
def test_a_bound_is_read_as_a_float(number: str) -> None:
    assert parse(f"max(K) < {number}").bound == float(number)


def test_outcomes_name_the_place() -> None:
    body = meshes.torus()
    found = judged(body, asserted=("absmax(h_signed) <= 0.5", "min(theta) < 10", "sum(K)<=1e-9"))
    worst = outcome(found, "absmax(h_signed) <= 0.5")
    h = analyze((body.points, body.faces)).vertices["h_signed"]
    at = int(np.nanargmax(np.abs(h)))
    assert (worst.status, worst.kind, worst.expected) == ("fail", "assertion", 0.5)
    assert worst.value == abs(h[at])
    assert worst.message == f"absmax(h_signed) = {abs(h[at]):.6g} at vertex {at}"
    edge = outcome(found, "min(theta) < 10")
    assert edge.status == "pass"
    assert " at edge " in edge.message
    assert outcome(found, "sum(K) <= 1e-09").status == "pass"


def test_what_is_undefined_everywhere_fails_and_says_so() -> None:
    for operator in ("<", ">", "!="):
        found = outcome(
            judged(meshes.tetrahedron(), asserted=(f"max(kappa_g) {operator} 3",)), f"max(kappa_g) {operator} 3"
        )
        assert found.status == "fail"
        assert found.value is None
        assert found.message == "max(kappa_g) is undefined: no vertex has a value"


def test_assertions_follow_the_convention_for_the_mean() -> None:
    body = meshes.icosphere()
    full = judged(body, asserted=("mean(h_signed) > 1.5",))
    half = judged(body, asserted=("mean(h_signed) > 1.5",), mean="average")
    assert [outcome(found, "mean(h_signed) > 1.5").status for found in (full, half)] == ["pass", "fail"]


def test_every_number_of_a_table_can_be_asserted() -> None:
    body = meshes.grid()
    analysis = analyze((body.points, body.faces))
    known = 0
    for column, quantity in columns().items():
        if not quantity.labels:
            ((held, value, words, _),) = parse(f"min({column}) < 0").judge(analysis)
            assert held == (value is not None and value < 0)
            assert words.startswith(f"min({column}) {'is undefined' if value is None else '= '}")
            known += value is not None
    assert known > 50


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected STAT(COLUMN) OP NUMBER"),
        ("max K < 3", "expected STAT(COLUMN) OP NUMBER"),
        ("max(K) < 3; exit()", "expected STAT(COLUMN) OP NUMBER"),
        ("max(K).real < 3", "expected STAT(COLUMN) OP NUMBER"),
        ("__import__('os') < 3", "expected STAT(COLUMN) OP NUMBER"),
        ("maks(K) < 3", "known: count, nulls, min, max"),
        ("max(h_sgned) < 3", "nearest: h_signed"),
        ("max(K) = 3", "expected one of <="),
        ("max(K) =< 3", "expected one of <="),
        ("max(K) < x", "'x' is not a number"),
        ("max(K) < inf", "'inf' is not a number"),
        ("max(K) < nan", "'nan' is not a number"),
        ("max(K) < 1e999", "is not a number in the range of doubles"),
        ("max(K) < 1_0", "'1_0' is not a number"),
        ("max(K) < ３", "'３' is not a number"),
        ("max(H_vec) < 3", "H_vec_x, H_vec_y, H_vec_z"),
        ("max(status) < 3", "has words"),
        ("area_mean(theta) < 3", "use mean"),
        ("p101(K) < 3", "unknown statistic 'p101'"),
        ("volum >= 3", "nearest: volume"),
        ("h_signed >= 3", "h_signed is a column"),
        ("closed == 1", "unknown value 'closed'"),
        ("each regoin: max(K) < 3", "expected one of each region, each component"),
        ("every region: max(K) < 3", "expected one of each region, each component"),
        ("each region max(K) < 3", "expected STAT(COLUMN) OP NUMBER"),
        ("region(): max(K) < 3", "expected one of each region, each component"),
        ("each component: share_area < 3", "unknown value 'share_area'"),
    ],
)
def test_what_is_no_assertion(text: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse(text)
    assert words in str(caught.value)
    assert repr(text) in str(caught.value)
