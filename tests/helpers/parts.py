"""Machine parts built in code: rings of any profile whose corners are sharp or filleted, and boxes rounded all over."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from tests.helpers.meshes import Floats, Mesh, mesh

# Corners (radius, height) of closed profiles, counterclockwise: all convex; with a concave corner; with a groove.
PROFILES = {
    "square": [[40, 0], [60, 0], [60, 20], [40, 20]],
    "step": [[40, 0], [70, 0], [70, 15], [55, 15], [55, 35], [40, 35]],
    "groove": [[40, 0], [80, 0], [80, 30], [70, 30], [70, 15], [50, 15], [50, 30], [40, 30]],
}


def filleted(corners: object, radii: object, segments: int) -> Floats:
    """(n, 2) a closed polygon, each corner an arc of its radius in so many chords; 0 leaves it sharp."""
    at = np.asarray(corners, np.float64)
    found = []
    for k, radius in enumerate(np.broadcast_to(np.asarray(radii, np.float64), len(at))):
        back, ahead = at[k - 1] - at[k], at[(k + 1) % len(at)] - at[k]
        back, ahead = back / np.linalg.norm(back), ahead / np.linalg.norm(ahead)
        if radius == 0:
            found.append(at[k][None])
            continue
        opening = np.arccos(np.clip(back @ ahead, -1, 1))
        bisector = (back + ahead) / np.linalg.norm(back + ahead)
        center = at[k] + bisector * radius / np.sin(opening / 2)
        first = at[k] + back * radius / np.tan(opening / 2) - center
        turn = np.sign(back[1] * ahead[0] - back[0] * ahead[1]) * (np.pi - opening)
        angle = np.linspace(0, turn, segments + 1)[:, None]
        found.append(center + np.cos(angle) * first + np.sin(angle) * np.array([-first[1], first[0]]))
    return np.concatenate(found)


def ring(profile: Floats, around: int = 160) -> Mesh:
    """The profile turned about the z axis, outward."""
    n = len(profile)
    angle = 2 * np.pi * np.arange(around)[:, None] / around
    points = np.stack([np.cos(angle) * profile[:, 0], np.sin(angle) * profile[:, 0], 0 * angle + profile[:, 1]], axis=2)
    k, j = (index.ravel() for index in np.meshgrid(np.arange(around), np.arange(n), indexing="ij"))
    a, b, c, d = (k % around * n + j, (k + 1) % around * n + j, (k + 1) % around * n + (j + 1) % n, k * n + (j + 1) % n)
    return mesh(points.reshape(-1, 3), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def rounded_box(half: object, radius: float, segments: int) -> Mesh:
    """A box with every edge and corner rounded: the hull of the eight octants of a sphere, moved into the corners."""
    i, j = (index.ravel() for index in np.meshgrid(*[np.arange(segments + 1)] * 2, indexing="ij"))
    i, j = i[i + j <= segments], j[i + j <= segments]
    angle = np.pi / 2 * np.column_stack([i, j, segments - i - j]) / segments
    unit = np.sin(angle) / np.linalg.norm(np.sin(angle), axis=1)[:, None]
    sides = np.array([[x, y, z] for x in (1, -1) for y in (1, -1) for z in (1, -1)], np.float64)
    box = (sides[:, None] * (radius * unit + (np.asarray(half, np.float64) - radius))).reshape(-1, 3)
    hull = ConvexHull(box, qhull_options="Qt")
    corners = box[hull.simplices]
    inward = (
        np.einsum(
            "ij,ij->i", np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), hull.equations[:, :3]
        )
        < 0
    )
    faces = np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)
    return mesh(box, faces)
