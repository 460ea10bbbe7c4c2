"""Random triangle meshes: healthy ones bent, torn, glued and turned, and complexes drawn out of thin air."""

from __future__ import annotations

from functools import cache

import numpy as np
from hypothesis import strategies as st

from tests.helpers.meshes import Mesh, mesh, of_sample, zoo

_BODIES = ("tetrahedron", "torus", "ellipsoid", "two_bodies", "klein_bottle")
_SHEETS = ("grid", "cap", "mobius")


@cache
def _small(name: str) -> Mesh:
    return {"tetrahedron": of_sample("octahedron")}.get(name, zoo(name))


def _jittered(given: Mesh, seed: int, amount: float) -> Mesh:
    """Every coordinate moved by at most the given part of the shortest edge."""
    a, b = given.points[given.faces], given.points[given.faces[:, [1, 2, 0]]]
    shortest = np.sqrt(((a - b) ** 2).sum(axis=2)).min()
    rng = np.random.default_rng(seed)
    return given.moved(given.points + amount * shortest * rng.uniform(-1, 1, given.points.shape))


_seeds = st.integers(0, 2**32 - 1)


@st.composite
def closed(draw: st.DrawFn) -> Mesh:
    """Closed manifolds, orientable or not."""
    return _jittered(_small(draw(st.sampled_from(_BODIES))), draw(_seeds), draw(st.sampled_from((0.0, 0.05, 0.2))))


@st.composite
def bounded(draw: st.DrawFn) -> Mesh:
    """Manifolds with boundary, and closed ones with faces torn out (so vertices may be pinched or unreferenced)."""
    given = _jittered(_small(draw(st.sampled_from(_SHEETS + _BODIES))), draw(_seeds), 0.1)
    rng = np.random.default_rng(draw(_seeds))
    lost = draw(st.integers(0, len(given.faces) // 3))
    keep = np.sort(rng.permutation(len(given.faces))[lost:])
    return given.with_faces(given.faces[keep])


@st.composite
def damaged(draw: st.DrawFn) -> Mesh:
    """Meshes with faces missing, turned and doubled, and vertices glued together."""
    given = draw(bounded())
    rng = np.random.default_rng(draw(_seeds))
    faces = given.faces.copy()
    for _ in range(draw(st.integers(0, 3))):
        one, other = rng.choice(np.unique(faces), 2, replace=False)
        glued = np.where(faces == other, one, faces)
        kept = (np.diff(np.sort(glued, axis=1), axis=1) > 0).all(axis=1)
        faces = glued[kept] if kept.any() else faces
    turned = rng.random(len(faces)) < draw(st.sampled_from((0.0, 0.05, 0.5)))
    faces[turned] = faces[turned][:, ::-1]
    doubled = rng.integers(0, len(faces), draw(st.integers(0, 3)))
    again = faces[doubled][:, rng.permutation(3)]
    return given.with_faces(rng.permutation(np.vstack([faces, again])))


@st.composite
def complexes(draw: st.DrawFn) -> Mesh:
    """Any triples at all over a few vertices: many faces at an edge, doubled faces, stars in many pieces."""
    n = draw(st.integers(3, 9))
    triple = st.lists(st.integers(0, n - 1), min_size=3, max_size=3, unique=True)
    faces = draw(st.lists(triple, min_size=1, max_size=24))
    return mesh(np.random.default_rng(draw(_seeds)).normal(size=(n, 3)), faces)


def any_mesh() -> st.SearchStrategy[Mesh]:
    return st.one_of(closed(), bounded(), damaged(), complexes())
