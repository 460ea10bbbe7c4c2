"""Declared invariances of every quantity, on random meshes."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.helpers import meshes, strategies
from tests.helpers.columns import PUBLIC, agree, everything, same
from tests.helpers.meshes import Mesh
from tests.properties.test_invariance import (
    Columns,
    edge_map,
    reversed_column,
    rotated,
    vertex_order,
    vertices_shuffled,
)

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
