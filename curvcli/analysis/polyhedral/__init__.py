"""Simplicial n-manifolds in E^d: combinatorics, shape of the simplices, and curvature."""

from .manifold import PolyhedralManifold

__all__ = ["PolyhedralManifold"]
