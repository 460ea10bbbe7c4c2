"""Platonic solids: small meshes with discrete curvatures in closed form."""

from __future__ import annotations

import math

import numpy as np

from .catalogue import sample
from .facts import orientable
from .model import FloatArray, Sample, demand_positive

GOLDEN = (1 + math.sqrt(5)) / 2


@sample(
    summary="a regular tetrahedron of the given edge",
    exact="K = pi at each vertex; exact area, volume and H_theta = 6 edge (pi - acos(1/3)).",
)
def tetrahedron(*, edge: float = 1.0) -> Sample:
    """4 vertices."""
    corners = np.array([(1.0, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) / math.sqrt(8)
    polygons = np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])
    return _solid(corners, polygons, edge, area=math.sqrt(3), volume=1 / math.sqrt(72), dihedral=math.acos(1 / 3))


@sample(
    summary="a cube of the given edge, each square cut along a diagonal",
    exact="K = pi/2 at each vertex; area 6 edge^2, volume edge^3, H_theta = 6 pi edge.",
)
def cube(*, edge: float = 1.0) -> Sample:
    """8 vertices."""
    corners = np.array([(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    squares = np.array([(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
    return _solid(corners, squares, edge, area=6, volume=1, dihedral=math.pi / 2)


@sample(
    summary="a regular octahedron of the given edge",
    exact="K = 2 pi/3 at each vertex; exact area, volume and H_theta = 12 edge acos(1/3).",
)
def octahedron(*, edge: float = 1.0) -> Sample:
    """6 vertices."""
    corners = np.concatenate([np.eye(3), -np.eye(3)]) / math.sqrt(2)
    polygons = np.array([(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)])
    return _solid(corners, polygons, edge, area=2 * math.sqrt(3), volume=math.sqrt(2) / 3, dihedral=math.acos(-1 / 3))


@sample(
    summary="a regular dodecahedron of the given edge, each pentagon cut into three triangles",
    exact="K = pi/5 at each vertex; exact area, volume and H_theta = 30 edge atan(2).",
)
def dodecahedron(*, edge: float = 1.0) -> Sample:
    """20 vertices: the centres of the faces of an icosahedron, one pentagon round each of its vertices."""
    points, faces = icosahedron_corners()
    corners = points[faces].mean(axis=1)
    side = min(math.dist(corners[0], other) for other in corners[1:])
    pentagons = np.array(
        [_round(points[corner], np.flatnonzero((faces == corner).any(1)), corners) for corner in range(12)]
    )
    area, volume = 3 * math.sqrt(25 + 10 * math.sqrt(5)), (15 + 7 * math.sqrt(5)) / 4
    return _solid(corners / side, pentagons, edge, area=area, volume=volume, dihedral=math.pi - math.atan(2))


@sample(
    summary="a regular icosahedron of the given edge",
    exact="K = pi/3 at each vertex; exact area, volume and H_theta = 30 edge acos(sqrt(5)/3).",
)
def icosahedron(*, edge: float = 1.0) -> Sample:
    """12 vertices."""
    points, faces = icosahedron_corners()
    volume = 5 * (3 + math.sqrt(5)) / 12
    return _solid(points / 2, faces, edge, area=5 * math.sqrt(3), volume=volume, dihedral=math.acos(-math.sqrt(5) / 3))


def icosahedron_corners() -> tuple[FloatArray, np.ndarray[tuple[int, int], np.dtype[np.int32]]]:
    """The 12 corners (edge 2) and 20 outward faces of an icosahedron."""
    points = np.array([(0, s, t * GOLDEN) for s in (-1, 1) for t in (-1, 1)])
    points = np.concatenate([points, np.roll(points, 1, axis=1), np.roll(points, 2, axis=1)])
    near = np.abs(np.linalg.norm(points[:, None] - points[None], axis=2) - 2) < 0.5
    a, b, c = (axis.ravel() for axis in np.indices((12, 12, 12)))
    faces = np.stack([a, b, c], axis=1)[near[a, b] & near[b, c] & near[c, a] & (a < b) & (a < c)]
    outward = np.linalg.det(points[faces]) > 0
    return points, faces[outward].astype(np.int32)


def _round(axis: FloatArray, members: np.ndarray[tuple[int], np.dtype[np.intp]], points: FloatArray) -> list[int]:
    """The members in counterclockwise order seen from outside along the axis."""
    first = points[members[0]] - axis * (points[members[0]] @ axis) / (axis @ axis)
    second = np.cross(axis / np.linalg.norm(axis), first)
    angle = np.arctan2(points[members] @ second, points[members] @ first)
    return [int(member) for member in members[np.argsort(angle)]]


def _solid(
    corners: FloatArray,
    polygons: np.ndarray[tuple[int, int], np.dtype[np.signedinteger]],
    edge: float,
    *,
    area: float,
    volume: float,
    dihedral: float,
) -> Sample:
    """A Platonic solid of edge 1 made `edge` times as large; area and volume are those of edge 1."""
    demand_positive(edge=edge)
    sides = polygons.shape[1]
    edges = polygons.size // 2
    fan = [polygons[:, [0, k, k + 1]] for k in range(1, sides - 1)]
    faces = np.stack(fan, axis=1).reshape(-1, 3).astype(np.int32)
    facts = orientable(
        area=area * edge**2, volume=volume * edge**3, H_theta=edges * edge * (math.pi - dihedral), convex=True
    )
    defect = np.full(len(corners), 4 * math.pi / len(corners))
    return Sample(corners * edge, faces, {"K": defect}, facts)
