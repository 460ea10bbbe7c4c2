"""Topology of a sample, under the keys of the report."""

from __future__ import annotations

import math

from .model import Fact


def orientable(*, genus: int = 0, loops: int = 0, components: int = 1, **more: Fact) -> dict[str, Fact]:
    """Facts of an oriented manifold: chi = 2c - 2g - b for c components of total genus g with b boundary loops."""
    return _manifold(2 * components - 2 * genus - loops, loops, components, genus=genus, crosscaps=None) | more


def nonorientable(*, crosscaps: int, loops: int = 0, **more: Fact) -> dict[str, Fact]:
    """Facts of a connected one-sided manifold: chi = 2 - k - b for k crosscaps and b boundary loops."""
    return _manifold(2 - crosscaps - loops, loops, 1, genus=None, crosscaps=crosscaps) | more


def nonmanifold(*, chi: int, edges: int = 0, vertices: int = 0, **more: Fact) -> dict[str, Fact]:
    """Facts of a connected complex with that many non-manifold edges and vertices, every face of which is oriented."""
    facts = _common(chi, 1) | {"manifold": False, "orientable": True, "consistent_winding": True, "closed": False}
    undefined: dict[str, Fact] = {"boundary_loops": None, "genus": None, "crosscaps": None}
    return facts | undefined | {"nonmanifold_edges": edges, "nonmanifold_vertices": vertices} | more


def _manifold(chi: int, loops: int, components: int, *, genus: int | None, crosscaps: int | None) -> dict[str, Fact]:
    two_sided = crosscaps is None
    facts = _common(chi, components) | {"manifold": True, "orientable": two_sided, "consistent_winding": two_sided}
    facts |= {"closed": loops == 0, "boundary_loops": loops, "genus": genus, "crosscaps": crosscaps}
    facts |= {"nonmanifold_edges": 0, "nonmanifold_vertices": 0}
    return facts if loops else facts | {"K": 2 * math.pi * chi}


def _common(chi: int, components: int) -> dict[str, Fact]:
    return {"euler_characteristic": chi, "components": components, "degenerate_faces": 0, "duplicate_faces": 0}
