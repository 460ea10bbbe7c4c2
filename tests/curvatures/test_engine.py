"""From names to columns: what is asked for, what runs, what is kept and what is let go."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import curvcli
from curvcli.curvatures.catalogue import CORE, loaded, resolve
from curvcli.curvatures.derived import derived
from curvcli.curvatures.engine import arguments, evaluate, needs, schedule
from curvcli.curvatures.quantity import CELL_AREA, NO_QUANTITIES, Element
from curvcli.curvatures.registry import Registry, passes
from curvcli.errors import UsageError
from tests.helpers import meshes
from tests.helpers.columns import PUBLIC

# The order of the tables and of the totals in the report.
VERTICES = (
    *("status", "degree", "K", "kappa_g", "K_comb", "K_plus", "K_minus", "K_abs", "A", "A_mixed", "A_voronoi", "A_vec"),
    *("H_vec", "area_gradient", "h", "h_signed", "h_hks", "h_perp", "h_normal", "K_density", "kappa_1", "kappa_2"),
    *("kappa_max", "dir_1", "dir_2", "shape_index", "curvedness", "willmore", "willmore_hks", "willmore_perp"),
    *("willmore_normal", "willmore_conformal", "helfrich", "K_ring", "h_ring", "kappa_1_ring", "kappa_2_ring"),
    *("K_corrected", "h_corrected"),
    *("kappa_1_corrected", "kappa_2_corrected", "dir_1_corrected", "dir_2_corrected", "K_fit", "h_fit", "kappa_1_fit"),
    *("kappa_2_fit", "dir_1_fit", "dir_2_fit", "condition_fit", "shape_index_ring", "curvedness_ring"),
    *("shape_index_corrected", "curvedness_corrected", "shape_index_fit", "curvedness_fit"),
    *("willmore_ring", "willmore_corrected", "willmore_fit", "helfrich_corrected", "K_sigma", "h_sigma"),
    *("K_positive", "K_negative", "K_rectified", "H_rectified", "folding_index", "intrinsic_index"),
)
EDGES = ("edge_length", "theta", "edge_H_vec", "H_sin", "H_theta", "H_tan", "kappa_across", "beta", "delaunay_defect")
FACES = (
    *("area_of_face", "normal", "dirichlet", "angle_min", "angle_max", "aspect_ratio", "edge_ratio", "radius_ratio"),
    "circumradius",
)
COLUMNS = (*VERTICES, *EDGES, *FACES)

# Keys of the report; `volume` has no column.
TOTALS = (
    *("area", "volume", "K", "kappa_g", "A_vec", "H_vec", "H_sin", "H_theta", "H_tan", "K_plus", "K_minus", "K_abs"),
    *("willmore", "willmore_hks", "willmore_perp", "willmore_normal", "willmore_conformal", "dirichlet"),
    *("helfrich", "willmore_ring", "willmore_corrected", "willmore_fit", "helfrich_corrected"),
    *("K_positive", "K_negative", "K_rectified", "H_rectified", "folding_index", "intrinsic_index"),
)


def test_a_preset_names_its_quantities() -> None:
    assert resolve(["core"]) == list(CORE)
    assert resolve(["topology"]) == ["status", "degree"]
    assert set(resolve(["all"])) == {quantity.name for quantity in passes.quantities()}
    paper = resolve(["paper"])
    assert set(CORE) - {"status", "degree"} <= set(paper) <= set(PUBLIC)
    assert resolve(["all"]) == list(COLUMNS)


@pytest.mark.parametrize(("element", "order"), [("vertex", VERTICES), ("edge", EDGES), ("face", FACES)])
def test_every_column_of_ours_has_its_place(element: Element, order: tuple[str, ...]) -> None:
    """Tables do not follow the order of imports: `after` in a declaration is the column before it."""
    assert [quantity.name for quantity in passes.quantities(element)] == list(order)


def test_every_total_of_ours_has_its_place() -> None:
    assert [q.total for q in passes.totals()] == [key for key in TOTALS if key != "volume"]
    given = meshes.zoo("two_bodies").surface()
    assert [*curvcli.analyze(given, "all").totals] == [
        *TOTALS,
        *(name for name, total in derived.items() if total.beside),
    ]


def test_the_order_of_registration_is_none_of_the_tables() -> None:
    """The same passes registered the other way round give the same tables and totals."""
    other, todo = Registry(), [passes[name] for name in reversed(list(passes))]
    while todo:
        later = []
        for one in todo:
            known = {quantity.name for quantity in other.quantities(public=False)} | {*NO_QUANTITIES, CELL_AREA}
            if known.issuperset(one.needs):
                other.add(one)
            else:
                later.append(one)
        todo = later
    assert list(other) != list(passes)
    assert other.quantities() == passes.quantities()
    assert other.totals() == passes.totals()


def test_names_are_put_in_the_order_of_the_table() -> None:
    assert resolve(["h", "K"]) == resolve(["K,h"]) == resolve([" K , h ", "K"]) == ["K", "h"]
    assert resolve(["willmore", "topology"]) == ["status", "degree", "willmore"]


def test_a_component_of_a_vector_stands_for_the_vector() -> None:
    assert resolve(["A_vec_y"]) == ["A_vec"]


@pytest.mark.parametrize(
    ("name", "near"), [("kapa_1", "kappa_1"), ("wilmore", "willmore"), ("cor", "core"), ("H_vce", "H_vec")]
)
def test_an_unknown_name_is_answered_with_the_nearest(name: str, near: str) -> None:
    with pytest.raises(UsageError) as raised:
        resolve(["K", name])
    assert repr(name) in str(raised.value)
    assert near in str(raised.value)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", ["", "K,,h", "zzzzzzz", "K h", "star_area"])
def test_what_is_no_name(name: str) -> None:
    with pytest.raises(UsageError):
        resolve([name])


@pytest.mark.parametrize("name", PUBLIC)
def test_only_what_is_needed_runs_and_each_after_its_needs(name: str) -> None:
    order = schedule(loaded(), [name], "barycentric")
    names = [one.name for one in order]
    assert len(set(names)) == len(names)
    known: set[str] = set()
    for one in order:
        required = {"A" if need == "cell_area" else need for need in one.needs} - set(NO_QUANTITIES)
        assert required <= known
        known |= {quantity.name for quantity in one.provides}
    wanted = {need for one in order for need in one.needs} | {"A", name}
    assert all(wanted & {quantity.name for quantity in one.provides} for one in order)


def test_each_pass_runs_once(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: Counter[str] = Counter()
    counting = {}
    for name, one in passes.items():

        def compute(*given: object, _name: str = name, **values: object) -> object:
            runs[_name] += 1
            return passes_before[_name].compute(*given, **values)

        counting[name] = replace(one, compute=compute)
    passes_before = dict(passes.items())
    monkeypatch.setattr(passes, "_passes", counting)
    monkeypatch.setattr(passes, "_providers", {q.name: one for one in counting.values() for q in one.provides})
    evaluate(loaded(), meshes.tetrahedron().surface(), list(PUBLIC))
    assert set(runs.values()) == {1}
    runs.clear()
    evaluate(loaded(), meshes.tetrahedron().surface(), ["A"])
    assert set(runs) == {"star_sums", "A"}


@pytest.mark.parametrize("name", PUBLIC)
def test_intermediates_are_let_go(name: str) -> None:
    assert set(evaluate(loaded(), meshes.tetrahedron().surface(), [name])) == {name}


def test_what_is_known_is_not_computed_again() -> None:
    surface = meshes.tetrahedron().surface()
    known = {"K": np.full(4, 12.0)}
    found = evaluate(loaded(), surface, ["K_density"], known=known)
    np.testing.assert_array_equal(found["K_density"] * evaluate(loaded(), surface, ["A"])["A"], known["K"])


@pytest.mark.parametrize("name", PUBLIC)
def test_columns_are_frozen(name: str) -> None:
    surface = meshes.zoo("cap").surface()
    (column,) = evaluate(loaded(), surface, [name]).values()
    assert not column.flags.writeable
    size = {"vertex": surface.n_vertices, "edge": len(surface.edges), "face": surface.n_faces}[PUBLIC[name].on]
    assert column.shape == ((3, size) if PUBLIC[name].vector else (size,))


@pytest.mark.parametrize("name", passes)
def test_every_pass_is_callable_on_a_surface(name: str) -> None:
    """`passes.NAME(surface)` gives its column, or a dictionary of them, as the analysis does."""
    surface = meshes.zoo("cap").surface()
    one = passes[name]
    found = one(surface)
    if len(one.provides) == 1:
        found = {one.provides[0].name: found}
    whole = curvcli.analyze(surface, "all")
    for quantity in one.provides:
        if quantity.public:
            np.testing.assert_array_equal(found[quantity.name], whole.column(quantity.name))
        assert not found[quantity.name].flags.writeable


def test_the_bare_function_is_there() -> None:
    surface = meshes.tetrahedron().surface()
    full = evaluate(loaded(), surface, ["H_vec", "star_vector", "star_area"])
    np.testing.assert_array_equal(
        curvcli.passes.h.compute(surface.interior, full["H_vec"], full["star_vector"], full["star_area"]),
        curvcli.passes.h(surface),
    )


@pytest.mark.parametrize("name", [one.name for one in passes.values() if one.pointwise])
def test_what_looks_at_one_vertex_at_a_time_says_the_same_of_some(name: str) -> None:
    surface = meshes.zoo("with_flat_face").surface()
    one, some = passes[name], np.random.default_rng(1).permutation(surface.n_vertices)[:7]
    have = evaluate(loaded(), surface, {*needs(one, "barycentric"), *(quantity.name for quantity in one.provides)})
    given = arguments(one, surface, have)
    assert all(column.shape[-1] == surface.n_vertices for column in given)
    found = one.compute(*(column[..., some] for column in given))
    for quantity, part in zip(one.provides, found if len(one.provides) > 1 else (found,), strict=True):
        np.testing.assert_array_equal(part, have[quantity.name][..., some])


def test_blocks_of_vertices_do_not_change_a_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = meshes.zoo("cap").surface()
    names = [quantity.name for quantity in passes.quantities("vertex")]
    at_once = evaluate(loaded(), surface, names)
    monkeypatch.setattr("curvcli.curvatures.engine._VERTICES", 5)
    for name, column in evaluate(loaded(), surface, names).items():
        np.testing.assert_array_equal(column, at_once[name], err_msg=name)


def test_the_cell_area_is_chosen() -> None:
    surface = meshes.zoo("ellipsoid").surface()
    for area, column in (("barycentric", "A"), ("mixed", "A_mixed"), ("voronoi", "A_voronoi")):
        found = evaluate(loaded(), surface, ["K", column, "K_density"], area=area)
        np.testing.assert_array_equal(found["K_density"], found["K"] / found[column])
        assert set(evaluate(loaded(), surface, ["K_density"], area=area)) == {"K_density"}
