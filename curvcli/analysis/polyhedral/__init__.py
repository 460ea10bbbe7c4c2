"""Simplicial n-manifolds in E^d: how they hang together, what shape their simplices have, and their curvature."""

from .manifold import PolyhedralManifold

__all__ = ["PolyhedralManifold"]
