"""Curvatures of other libraries on one mesh at one radius: `python peers.py NAME IN.npz RINGS RADIUS OUT.npz`.

A separate file without imports of curvcli, so that it runs in the environment of the peer.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np

# Gauss and mean curvature, the latter as κ₁ + κ₂; either may be missing. Signs are settled by who compares.
Found = dict[str, Any]


def libigl(points: Any, faces: Any, rings: int, radius: float) -> Found:
    """principal_curvature: a quadric through the vertex over some rings."""
    import igl

    found = igl.principal_curvature(points, faces, radius=rings)
    return {"K": found[2] * found[3], "h": found[2] + found[3]}


def pymeshlab(points: Any, faces: Any, rings: int, radius: float) -> Found:
    """Scale-dependent quadric fitting within the radius."""
    import pymeshlab

    found = {}
    for key, kind in (("K", "Gaussian Curvature"), ("h", "Mean Curvature")):
        meshes = pymeshlab.MeshSet(verbose=False)
        meshes.add_mesh(pymeshlab.Mesh(points, faces))
        meshes.compute_curvature_principal_directions_per_vertex(
            method="Scale Dependent Quadric Fitting",
            scale=pymeshlab.PureValue(radius),
            curvcolormethod=kind,
            autoclean=False,
        )
        found[key] = meshes.current_mesh().vertex_scalar_array() * (2 if key == "h" else 1)
    return found


def trimesh(points: Any, faces: Any, rings: int, radius: float) -> Found:
    """The measures of Cohen-Steiner and Morvan in the ball, per area of a flat disk of its radius."""
    import trimesh
    from trimesh import curvature

    mesh = trimesh.Trimesh(points, faces, process=False)
    disk = np.pi * radius**2
    return {
        "K": curvature.discrete_gaussian_curvature_measure(mesh, points, radius) / disk,
        "h": 2 * curvature.discrete_mean_curvature_measure(mesh, points, radius) / disk,
    }


PEERS: dict[str, Callable[[Any, Any, int, float], Found]] = {
    "libigl": libigl,
    "PyMeshLab": pymeshlab,
    "trimesh": trimesh,
}

if __name__ == "__main__":
    name, source, ring_count, reach, target = sys.argv[1:]
    with np.load(source) as stored:
        given = stored["points"], stored["faces"].astype(np.int64)
    np.savez(target, **PEERS[name](*given, int(ring_count), float(reach)))
