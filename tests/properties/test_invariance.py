"""Declared invariances of every quantity, on every kind of surface: a new pass is tested with no edit here."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from curvcli.curvatures.quantity import Quantity
from tests.helpers import meshes
from tests.helpers.columns import PUBLIC, Array, agree, everything, for_all, same
from tests.helpers.meshes import Mesh

NAMES = tuple(meshes.ZOO)
# The first face of a patch orients it: where the file's winding is inconsistent, renumbering faces may turn a patch.
CONSISTENT = tuple(name for name in NAMES if name not in ("inconsistent", "mobius", "klein_bottle"))

Columns = dict[str, Array]
Change = Callable[[Mesh], Mesh]


@cache
def of_zoo(name: str) -> Columns:
    return everything(meshes.zoo(name).surface())


def changed(name: str, change: Change) -> Columns:
    return everything(change(meshes.zoo(name)).surface())


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


def on_every_column(hold: Callable[[Quantity], None]) -> None:
    for_all(PUBLIC, lambda name: hold(PUBLIC[name]))


@pytest.mark.parametrize("name", NAMES)
def test_translation_changes_no_bit(name: str) -> None:
    """An offset that costs no digit changes no bit."""
    found, wanted = changed(name, translated), quantised(name)
    on_every_column(lambda quantity: same(quantity, found[quantity.name], wanted[quantity.name]))


@pytest.mark.parametrize("name", NAMES)
def test_rotation_turns_only_vectors(name: str) -> None:
    """Vectors turn with the surface, numbers stay."""
    found = changed(name, rotated)

    def hold(quantity: Quantity) -> None:
        wanted = of_zoo(name)[quantity.name]
        agree(quantity, found[quantity.name], wanted @ meshes.rotation().T if quantity.vector else wanted)

    on_every_column(hold)


@pytest.mark.parametrize(("change", "factor"), [(at_1e9, 1e9), (at_1e_9, 1e-9)])
@pytest.mark.parametrize("name", NAMES)
def test_scale_acts_by_the_declared_power(name: str, change: Change, factor: float) -> None:
    """The declared power of the scale."""
    found, plain = changed(name, change), of_zoo(name)

    def hold(quantity: Quantity) -> None:
        wanted = plain[quantity.name] * factor**quantity.length_exponent
        agree(quantity, found[quantity.name], wanted, length=factor)

    on_every_column(hold)


@pytest.mark.parametrize("power", [-500, -120, -60, -1, 1, 60, 120, 500])
@pytest.mark.parametrize("name", NAMES)
def test_powers_of_two(name: str, power: int) -> None:
    """Bit for bit; where a double cannot hold the result, null."""
    given, plain = meshes.zoo(name), of_zoo(name)
    found = everything(given.moved(np.ldexp(given.points, power)).surface())

    def hold(quantity: Quantity) -> None:
        column = plain[quantity.name]
        with np.errstate(over="ignore", under="ignore"):
            wanted = np.ldexp(column, power * quantity.length_exponent)
        if abs(power) == 500:
            lost = np.isinf(wanted) | ((np.abs(wanted) < np.finfo(float).tiny) & (column != 0))
            wanted = np.where(lost, np.nan, wanted)
        same(quantity, found[quantity.name], wanted)

    on_every_column(hold)


@pytest.mark.parametrize("name", CONSISTENT)
def test_order_of_faces(name: str) -> None:
    """Vertices and edges keep their values, faces take theirs along."""
    found, order = changed(name, faces_shuffled), face_order(meshes.zoo(name))

    def hold(quantity: Quantity) -> None:
        wanted = of_zoo(name)[quantity.name]
        agree(quantity, found[quantity.name], wanted[order] if quantity.on == "face" else wanted)

    on_every_column(hold)


@pytest.mark.parametrize("name", NAMES)
def test_order_of_vertices(name: str) -> None:
    """Values follow their vertices and edges."""
    given = meshes.zoo(name)
    columns, order = changed(name, vertices_shuffled), vertex_order(given)
    edges = edge_map(given, vertices_shuffled(given), np.argsort(order))

    def hold(quantity: Quantity) -> None:
        found, wanted = columns[quantity.name], of_zoo(name)[quantity.name]
        if quantity.on == "vertex":
            wanted = wanted[order]
        elif quantity.on == "edge":
            found = found[edges]
        agree(quantity, found, wanted)

    on_every_column(hold)


def reversed_column(quantity: Quantity, columns: Columns, without: Array) -> Array:
    """The column after all faces are reversed, by its declared parity.

    without: elements of patches that have no orientation, where what is odd holds absolute values or nulls.
    """
    # κ₁ ≥ κ₂ stay in order, so that reversing takes κ₁ to −κ₂.
    column = columns[quantity.partner or quantity.name]
    if quantity.parity == "even":
        return column
    return np.where(without if column.ndim == 1 else without[:, None], column, -column)


@pytest.mark.parametrize("name", NAMES)
def test_reversal_changes_the_sign_of_what_is_odd(name: str) -> None:
    """Even quantities stay, odd ones change their sign."""
    surface, found = meshes.zoo(name).surface(), changed(name, meshes.reversed_faces)
    face = ~surface.orientation.orientable[surface.orientation.patch]
    edge = face[surface.edges.order[surface.edges.start[:-1]] // 3]
    unoriented = {"face": face, "edge": edge, "vertex": np.zeros(surface.n_vertices, bool)}

    def hold(quantity: Quantity) -> None:
        without = unoriented[quantity.on]
        if quantity.name == "normal" and without.any():
            # Without an orientation a face's normal is that of its own winding.
            without = np.zeros_like(without)
        agree(quantity, found[quantity.name], reversed_column(quantity, of_zoo(name), without))

    on_every_column(hold)


@pytest.mark.parametrize("name", NAMES)
def test_convention_for_mean_curvature(name: str) -> None:
    """Halved as often as declared."""
    found, plain = everything(meshes.zoo(name).surface(), mean="average"), of_zoo(name)
    on_every_column(lambda q: same(q, found[q.name], plain[q.name] * 0.5**q.mean_degree))


@pytest.mark.parametrize("name", NAMES)
def test_another_surface_in_the_file(name: str) -> None:
    given = meshes.zoo(name)
    beside, behind = changed(name, beside_another), changed(name, behind_another)

    def hold(quantity: Quantity) -> None:
        wanted = of_zoo(name)[quantity.name]
        n = len(wanted)
        agree(quantity, beside[quantity.name][:n], wanted, 1e-13)
        agree(quantity, behind[quantity.name][len(behind[quantity.name]) - n :], wanted, 1e-13)
        assert len(given.points) < len(beside[quantity.name]) or quantity.on != "vertex"

    on_every_column(hold)


@pytest.mark.parametrize("name", NAMES)
def test_an_unreferenced_vertex(name: str) -> None:
    columns = changed(name, with_a_loose_vertex)

    def hold(quantity: Quantity) -> None:
        found = columns[quantity.name]
        if quantity.on == "vertex":
            loose, found = found[0], found[1:]
            if quantity.kind not in ("label", "count"):
                assert np.isnan(loose).all()
        same(quantity, found, of_zoo(name)[quantity.name])

    on_every_column(hold)
