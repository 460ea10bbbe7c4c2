"""Declaring a pass: what is misspelt or there already fails at once, and says what was meant."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.curvatures.quantity import Quantity
from curvcli.curvatures.registry import Pass, Registry, curvature_pass, passes
from curvcli.errors import UsageError
from curvcli.mesh.surface import Surface
from curvcli.support.arrays import Column
from tests.helpers import meshes

_ = curvcli.passes  # importing registers them


@pytest.fixture(autouse=True)
def registry() -> Iterator[Registry]:
    """The registry, put back as it was afterwards."""
    before = dict(passes._passes), dict(passes._providers)
    yield passes
    passes._passes, passes._providers = before


def test_a_function_becomes_a_pass() -> None:
    @curvature_pass(symbol="2A", length_exponent=2, source="here")
    def twice_the_area(A: Column) -> Column:
        """Twice the area."""
        return 2 * A

    assert isinstance(twice_the_area, Pass)
    assert (twice_the_area.name, twice_the_area.needs) == ("twice_the_area", ("A",))
    (quantity,) = twice_the_area.provides
    assert (quantity.name, quantity.symbol, quantity.description) == ("twice_the_area", "2A", "Twice the area.")
    surface = meshes.tetrahedron().surface()
    wanted = 2 * curvcli.analyze(surface, "A").vertices["A"]
    np.testing.assert_array_equal(twice_the_area(surface), wanted)
    np.testing.assert_array_equal(curvcli.passes.twice_the_area.compute(np.ones(3)), [2, 2, 2])
    np.testing.assert_array_equal(curvcli.analyze(surface, "twice_the_area").vertices["twice_the_area"], wanted)
    assert "twice_the_area" in curvcli.analyze(surface, "all").vertices
    assert "twice_the_area" not in curvcli.analyze(surface, "paper").vertices


def test_several_columns_from_one_pass() -> None:
    @curvature_pass(provides=(Quantity("one", length_exponent=2), Quantity("other", vector=True, length_exponent=2)))
    def both(A: Column, A_vec: NDArray[np.float64]) -> tuple[Column, NDArray[np.float64]]:
        """The area and its vector."""
        return A.copy(), 2 * A_vec

    surface = meshes.tetrahedron().surface()
    found = both(surface)
    assert set(found) == {"one", "other"}
    assert found["other"].shape == (4, 3)
    assert passes.provider("other") is both
    assert list(curvcli.analyze(surface, "other").vertices) == ["other", "other_x", "other_y", "other_z"]


@pytest.mark.parametrize(("wrong", "near"), [("A_vce", "A_vec"), ("surfcae", "surface"), ("kapa_1", "kappa_1")])
def test_a_misspelt_parameter_fails_at_once(wrong: str, near: str) -> None:
    before = list(passes), [q.name for q in passes.quantities(public=False)]
    space: dict[str, object] = {}
    exec(f"def broken({wrong}): return {wrong}", space)
    with pytest.raises(UsageError) as raised:
        curvature_pass()(space["broken"])  # type: ignore[arg-type]
    assert f"pass broken needs {wrong}" in str(raised.value)
    assert near in str(raised.value)
    assert (list(passes), [q.name for q in passes.quantities(public=False)]) == before


def test_a_pass_cannot_need_itself() -> None:
    with pytest.raises(UsageError, match="needs selfish"):

        @curvature_pass()
        def selfish(selfish: Column) -> Column:
            return selfish


@pytest.mark.parametrize("need", ["surface", "scale", "theta", "face_area"])
def test_what_looks_at_one_vertex_at_a_time_needs_columns_of_vertices(need: str) -> None:
    space: dict[str, object] = {}
    exec(f"def alone({need}, K): return K", space)
    with pytest.raises(UsageError, match=f"pass alone looks at one vertex at a time and needs {need}, expected"):
        curvature_pass(pointwise=True)(space["alone"])  # type: ignore[arg-type]
    assert "alone" not in passes


def test_a_column_is_provided_once() -> None:
    with pytest.raises(UsageError, match="pass K provides K, which exists already"):

        @curvature_pass()
        def K(A: Column) -> Column:
            return A

    with pytest.raises(UsageError, match="provides h, which exists already"):

        @curvature_pass(provides=(Quantity("fresh"), Quantity("h")))
        def mixed(A: Column) -> tuple[Column, Column]:
            return A, A

    assert "mixed" not in passes
    with pytest.raises(KeyError):
        passes.provider("fresh")


def test_a_pass_is_registered_once() -> None:
    """Also when it provides something new under a name that is taken."""
    assert "star_sums" in passes
    with pytest.raises(UsageError, match="star_sums"):

        @curvature_pass(provides=(Quantity("fresh"),))
        def star_sums(A: Column) -> Column:
            return A

    assert len(passes["star_sums"].provides) > 1

    with pytest.raises(UsageError, match="provides twin, which exists already"):

        @curvature_pass(provides=(Quantity("twin"), Quantity("twin")))
        def twins(A: Column) -> tuple[Column, Column]:
            return A, A


def test_an_unknown_pass_is_no_attribute_and_no_key() -> None:
    with pytest.raises(AttributeError):
        _ = curvcli.passes.no_such_pass
    with pytest.raises(KeyError):
        curvcli.passes["no_such_pass"]


@pytest.mark.parametrize("quantity", passes.quantities(), ids=lambda quantity: quantity.name)
def test_declarations_are_complete(quantity: Quantity) -> None:
    """A column has all the texts that users read, and they agree."""
    assert quantity.symbol
    assert quantity.formula
    assert quantity.description.split("\n")[0].endswith(".")
    assert quantity.boundary
    assert quantity.source
    assert quantity.mean_degree in (0, 1, 2)
    assert quantity.parity in ("even", "odd")
    if quantity.kind in ("angle", "ratio", "direction", "count", "label"):
        assert quantity.length_exponent == 0
    if quantity.kind == "density":
        assert quantity.length_exponent < 0
    if quantity.partner:
        assert passes.quantity(quantity.partner).partner == quantity.name
    assert len(quantity.columns) == (3 if quantity.vector else 1)


def test_column_names_are_unique_in_each_table() -> None:
    for element in ("vertex", "edge", "face"):
        names = [column for quantity in passes.quantities(element) for column in quantity.columns]
        assert len(names) == len(set(names))


@pytest.mark.parametrize(
    ("exponent", "length", "unit"), [(0, "mm", "1"), (1, "mm", "mm"), (2, None, "length^2"), (-1, "mm", "mm^-1")]
)
def test_a_unit_is_the_power_of_the_length(exponent: int, length: str | None, unit: str) -> None:
    assert Quantity("x", length_exponent=exponent).unit(length) == unit


def test_a_declared_pass_takes_the_surface() -> None:
    @curvature_pass(kind="count")
    def faces_here(surface: Surface) -> NDArray[np.int32]:
        """Faces at the vertex."""
        return surface.corner_count.copy()

    assert faces_here(meshes.tetrahedron().surface()).tolist() == [3, 3, 3, 3]
