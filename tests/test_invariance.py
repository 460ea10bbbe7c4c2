"""What every quantity declares about itself, tried on every kind of surface: a new pass is tested with no edit here."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from curvcli.declare import Quantity
from tests import meshes, strategies
from tests.columns import PUBLIC, Array, agree, everything, same
from tests.meshes import Mesh

NAMES = tuple(meshes.ZOO)
# The first face of a patch orients it: where the file's winding is inconsistent, renumbering faces may turn a patch.
CONSISTENT = tuple(name for name in NAMES if name not in ("inconsistent", "mobius", "klein_bottle"))

Columns = dict[str, Array]
Change = Callable[[Mesh], Mesh]


@cache
def of_zoo(name: str) -> Columns:
    return everything(meshes.zoo(name).surface())


@cache
def changed(name: str, change: Change) -> Columns:
    return everything(change(meshes.zoo(name)).surface())


@cache
def quantised(name: str) -> Columns:
    return everything(meshes.quantised(meshes.zoo(name)).surface())


def translated(given: Mesh) -> Mesh:
    """By an offset that is exact on coordinates of 20 bits."""
    exact = meshes.quantised(given)
    return exact.moved(exact.points + np.array([2.0**20, -3 * 2.0**18, 5 * 2.0**17]))


def rotated(given: Mesh) -> Mesh:
    return given.moved(given.points @ meshes.rotation().T)


def at_1e9(given: Mesh) -> Mesh:
    return given.moved(given.points * 1e9)


def at_1e_9(given: Mesh) -> Mesh:
    return given.moved(given.points * 1e-9)


def face_order(given: Mesh) -> Array:
    return np.random.default_rng(6).permutation(len(given.faces))


def faces_shuffled(given: Mesh) -> Mesh:
    """Faces in another order, each beginning at another corner."""
    rng = np.random.default_rng(7)
    order = face_order(given)
    start = rng.integers(0, 3, len(order))[:, None]
    return given.with_faces(given.faces[order[:, None], (start + np.arange(3)) % 3])


def vertex_order(given: Mesh) -> Array:
    return np.random.default_rng(8).permutation(len(given.points))


def vertices_shuffled(given: Mesh) -> Mesh:
    return meshes.relabelled(given, vertex_order(given))


def with_a_loose_vertex(given: Mesh) -> Mesh:
    """A vertex of no face in front of all others."""
    return meshes.mesh(np.vstack([[[7.0, -5.0, 1e3]], given.points]), given.faces + 1)


def beside_another(given: Mesh) -> Mesh:
    """With another surface after it in the file."""
    other = meshes.torus()
    return meshes.joined(given, other.moved(other.points + 9.0))


def behind_another(given: Mesh) -> Mesh:
    return meshes.joined(meshes.cap(), given)


def edge_map(one: Mesh, other: Mesh, vertex: Array) -> Array:
    """For each edge of the one mesh its index among the other's, given the new index of each vertex."""
    mine, theirs = one.surface().edges, other.surface().edges
    n = len(other.points)
    ends = np.sort(np.stack([vertex[mine.a], vertex[mine.b]]), axis=0).astype(np.int64)
    return np.asarray(np.searchsorted(theirs.a.astype(np.int64) * n + theirs.b, ends[0] * n + ends[1]))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_translation(column: str, name: str) -> None:
    """An offset that costs no digit changes no bit."""
    same(PUBLIC[column], changed(name, translated)[column], quantised(name)[column])


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_rotation(column: str, name: str) -> None:
    """Vectors turn with the surface, numbers stay."""
    quantity = PUBLIC[column]
    wanted = of_zoo(name)[column]
    agree(quantity, changed(name, rotated)[column], wanted @ meshes.rotation().T if quantity.vector else wanted)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_scale(column: str, name: str) -> None:
    """The declared power of the scale."""
    quantity = PUBLIC[column]
    for change, factor in ((at_1e9, 1e9), (at_1e_9, 1e-9)):
        agree(
            quantity,
            changed(name, change)[column],
            of_zoo(name)[column] * factor**quantity.length_exponent,
            length=factor,
        )


@cache
def at_power_of_two(name: str, power: int) -> Columns:
    given = meshes.zoo(name)
    return everything(given.moved(np.ldexp(given.points, power)).surface())


@pytest.mark.parametrize("power", [-500, -120, -60, -1, 1, 60, 120, 500])
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_powers_of_two(column: str, name: str, power: int) -> None:
    """Bit for bit; where a double cannot hold the result, null."""
    quantity = PUBLIC[column]
    with np.errstate(over="ignore", under="ignore"):
        wanted = np.ldexp(of_zoo(name)[column], power * quantity.length_exponent)
    if abs(power) == 500:
        plain = of_zoo(name)[column]
        lost = np.isinf(wanted) | ((np.abs(wanted) < np.finfo(float).tiny) & (plain != 0))
        wanted = np.where(lost, np.nan, wanted)
    same(quantity, at_power_of_two(name, power)[column], wanted)


@pytest.mark.parametrize("name", CONSISTENT)
@pytest.mark.parametrize("column", PUBLIC)
def test_order_of_faces(column: str, name: str) -> None:
    """Vertices and edges keep their values, faces take theirs along."""
    quantity = PUBLIC[column]
    wanted = of_zoo(name)[column]
    if quantity.on == "face":
        wanted = wanted[face_order(meshes.zoo(name))]
    agree(quantity, changed(name, faces_shuffled)[column], wanted)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_order_of_vertices(column: str, name: str) -> None:
    """Values follow their vertices and edges."""
    quantity, given = PUBLIC[column], meshes.zoo(name)
    found, order = changed(name, vertices_shuffled)[column], vertex_order(given)
    wanted = of_zoo(name)[column]
    if quantity.on == "vertex":
        wanted = wanted[order]
    elif quantity.on == "edge":
        found = found[edge_map(given, vertices_shuffled(given), np.argsort(order))]
    agree(quantity, found, wanted)


def reversed_column(quantity: Quantity, columns: Columns, without: Array) -> Array:
    """What the column becomes when all faces are reversed, by its declared parity.

    without: elements of patches that have no orientation, where what is odd holds absolute values or nulls.
    """
    # κ₁ ≥ κ₂ stay in order, so that reversing takes κ₁ to −κ₂.
    column = columns[quantity.partner or quantity.name]
    if quantity.parity == "even":
        return column
    return np.where(without if column.ndim == 1 else without[:, None], column, -column)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_reversal(column: str, name: str) -> None:
    """What is declared even stays, what is declared odd changes its sign."""
    quantity, surface = PUBLIC[column], meshes.zoo(name).surface()
    face = ~surface.orientation.orientable[surface.orientation.patch]
    edge = face[surface.edges.order[surface.edges.start[:-1]] // 3]
    without = {"face": face, "edge": edge, "vertex": np.zeros(surface.n_vertices, bool)}[quantity.on]
    found = changed(name, meshes.reversed_faces)[column]
    if quantity.name == "normal" and without.any():
        # Without an orientation a face's normal is that of its own winding.
        without = np.zeros_like(without)
    agree(quantity, found, reversed_column(quantity, of_zoo(name), without))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_convention_for_mean_curvature(column: str, name: str) -> None:
    """Halved as often as declared."""
    quantity = PUBLIC[column]
    same(quantity, averaged(name)[column], of_zoo(name)[column] * 0.5**quantity.mean_degree)


@cache
def averaged(name: str) -> Columns:
    return everything(meshes.zoo(name).surface(), mean="average")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_another_surface_in_the_file(column: str, name: str) -> None:
    quantity, given = PUBLIC[column], meshes.zoo(name)
    wanted = of_zoo(name)[column]
    beside, behind = changed(name, beside_another)[column], changed(name, behind_another)[column]
    n = len(wanted)
    agree(quantity, beside[:n], wanted, 1e-13)
    agree(quantity, behind[len(behind) - n :], wanted, 1e-13)
    assert len(given.points) < len(beside) or quantity.on != "vertex"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("column", PUBLIC)
def test_an_unreferenced_vertex(column: str, name: str) -> None:
    quantity = PUBLIC[column]
    found, wanted = changed(name, with_a_loose_vertex)[column], of_zoo(name)[column]
    if quantity.on == "vertex":
        loose, found = found[0], found[1:]
        if quantity.kind not in ("label", "count"):
            assert np.isnan(loose).all()
    same(quantity, found, wanted)


# ---------------------------------------------------------------------------- on random meshes

# Quotients are as ill-conditioned as the mesh pleases; what is an integral is not.
MEASURES = [q for q in PUBLIC.values() if q.kind in ("measure", "angle", "length") and "willmore" not in q.name]


def unfolded(columns: Columns) -> Columns:
    """Without the dihedral angles of edges whose two faces lie on each other: π is as right as −π there."""
    folded = np.abs(columns["theta"]) > np.pi - 1e-7
    of_edges = ("theta", "H_sin", "H_theta", "H_tan")
    return columns | {name: np.where(folded, np.nan, columns[name]) for name in of_edges if name in columns}


@settings(max_examples=60)
@given(strategies.any_mesh(), st.integers(-300, 300))
def test_powers_of_two_on_random_meshes(given: Mesh, power: int) -> None:
    plain, scaled = (everything(m.surface()) for m in (given, given.moved(np.ldexp(given.points, power))))
    for quantity in PUBLIC.values():
        with np.errstate(over="ignore", under="ignore"):
            wanted = np.ldexp(plain[quantity.name], power * quantity.length_exponent)
        lost = np.isinf(wanted) | ((np.abs(wanted) < np.finfo(float).tiny) & (plain[quantity.name] != 0))
        np.testing.assert_array_equal(
            np.where(lost, np.nan, scaled[quantity.name]), np.where(lost, np.nan, wanted), err_msg=quantity.name
        )


@settings(max_examples=60)
@given(strategies.any_mesh(), st.tuples(*[st.integers(-(2**20), 2**20)] * 3))
def test_translation_of_random_meshes(given: Mesh, offset: tuple[int, int, int]) -> None:
    exact = meshes.quantised(given)
    plain, moved = (everything(m.surface()) for m in (exact, exact.moved(exact.points + np.array(offset))))
    for quantity in PUBLIC.values():
        same(quantity, moved[quantity.name], plain[quantity.name])


@settings(max_examples=60)
@given(strategies.any_mesh())
def test_rotation_of_random_meshes(given: Mesh) -> None:
    plain, turned = (unfolded(everything(m.surface())) for m in (given, rotated(given)))
    for quantity in MEASURES:
        wanted = plain[quantity.name]
        agree(quantity, turned[quantity.name], wanted @ meshes.rotation().T if quantity.vector else wanted, 1e-8)


@settings(max_examples=60)
@given(strategies.any_mesh())
def test_relabelling_of_random_meshes(given: Mesh) -> None:
    order = vertex_order(given)
    plain, other = (unfolded(everything(m.surface())) for m in (given, vertices_shuffled(given)))
    where = edge_map(given, vertices_shuffled(given), np.argsort(order))
    for quantity in MEASURES:
        found, wanted = other[quantity.name], plain[quantity.name]
        found = found[where] if quantity.on == "edge" else found
        agree(quantity, found, wanted[order] if quantity.on == "vertex" else wanted, 1e-9)


@settings(max_examples=60)
@given(strategies.any_mesh())
def test_reversal_of_random_meshes(given: Mesh) -> None:
    plain, other = (unfolded(everything(m.surface())) for m in (given, meshes.reversed_faces(given)))
    surface = given.surface()
    for quantity in MEASURES:
        if quantity.parity == "odd" and not surface.orientable:
            continue
        nothing = np.zeros(len(plain[quantity.name]), bool)
        agree(quantity, other[quantity.name], reversed_column(quantity, plain, nothing), 1e-9)
