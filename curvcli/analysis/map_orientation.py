"""Orientation of a map on each face: the faces that it turns over."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..mesh.orientation import same_direction
from ..mesh.topology import label_graph
from ..mesh.triangles import EPSILON, cross, dot, triangles
from ..support.arrays import Floats, Index, Mask
from ..support.blocks import slices

if TYPE_CHECKING:
    from ..mesh.surface import Surface
    from .map_differential import Stretch


# Points of a plane are this many units of rounding of their coordinates away from it.
_PLANE = 64 * EPSILON


def orientation(source: Surface, image: Surface, stretch: Stretch) -> Floats:
    """(F,) +1 where f keeps a face the way up that most of its patch has by area, −1 where it turns it over.

    Into a plane it is the sign of det df, by the signed areas of the images of the coherently wound faces. In space a
    face has no side of its own, and the sign is carried from face to face: it changes across an edge where the dihedral
    angles |θ| of surface and image differ by more than a right angle. Rotations and reflections of the surface or of
    its image change nothing. Null on faces without area or whose image has none, and where the carried signs contradict
    each other.
    Source: curvcli; det df as in Floater and Hormann, Surface parameterization: a tutorial and survey, 2005.
    """
    known = ~(np.isnan(stretch.sigma_1) | stretch.collapsed)
    sign = _signed_areas(image)
    if sign is None:
        return _majority(*_carried(source, image, known), stretch.image_area, known)
    below = _signed_areas(source)
    if below is not None:
        return _majority(sign * below, source.orientation.patch, stretch.image_area, known)
    wound = source.orientation.face_sign
    sign = sign if wound is None else sign * wound
    majority = _majority(sign, source.orientation.patch, stretch.image_area, known)
    one_sided = ~source.orientation.orientable[source.orientation.patch]
    if one_sided.any():
        carried = _majority(*_carried(source, image, known), stretch.image_area, known)
        majority[one_sided] = carried[one_sided]
    return majority


def _signed_areas(surface: Surface) -> Floats | None:
    """(F,) signs of the areas of the faces as wound, from one side of the plane of the surface; None in space."""
    used = surface.referenced
    xyz = surface.xyz.compress(used, axis=1)
    offset = xyz - xyz[:, :1]
    extent = np.abs(offset).max(initial=0.0)
    if extent == 0:
        return None
    offset = offset / extent
    offset -= offset.mean(axis=1)[:, None]
    normal = np.linalg.eigh(offset @ offset.T)[1][:, 0]
    allowed = _PLANE * (1 + np.abs(xyz).max() / extent)
    if np.abs(normal @ offset).max() > allowed:
        return None
    signs = np.empty(surface.n_faces)
    for block in slices(surface.n_faces):
        normals = triangles(surface.xyz, surface.faces[block]).normal
        signs[block] = np.sign(sum(part * along for part, along in zip(normals, normal, strict=True)))
    return signs


def _carried(source: Surface, image: Surface, known: Mask) -> tuple[Floats, Index]:
    """(F,) signs carried from face to face, 0 where they contradict each other, and the piece of each face."""
    half_edge, twin = source.edges.pairs
    usable = known[half_edge // 3] & known[twin // 3]
    half_edge, twin = half_edge[usable], twin[usable]
    against = same_direction(source.faces, half_edge, twin)
    face, neighbour = half_edge // 3, twin // 3
    bends = [_bend(surface, source.faces, face, neighbour, against) for surface in (source, image)]
    folded = np.abs(bends[0] - bends[1]) > np.pi / 2 + 64 * EPSILON
    # Double cover: each face with either side up.
    count = source.n_faces
    ahead = np.where(folded, neighbour + count, neighbour), np.where(folded, neighbour, neighbour + count)
    _, label = label_graph(2 * count, np.concatenate([face, face + count]), np.concatenate(ahead))
    up, down = label[:count], label[count:]
    return np.sign(down - up).astype(np.float64), np.minimum(up, down)


def _bend(surface: Surface, faces: Index, face: Index, neighbour: Index, against: Mask) -> Floats:
    """(E,) unsigned dihedral angle between two faces of each edge, 0 where they continue in a plane."""
    angle = np.empty(len(face))
    for block in slices(len(face)):
        own_normal, neighbour_normal = (
            np.array(triangles(surface.xyz, faces[side[block]]).normal) for side in (face, neighbour)
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            own_normal, neighbour_normal = (
                normal / np.sqrt(dot(normal, normal)) for normal in (own_normal, neighbour_normal)
            )
        neighbour_normal = np.where(against[block], -neighbour_normal, neighbour_normal)
        across = np.array(cross(own_normal, neighbour_normal))
        angle[block] = np.arctan2(np.sqrt(dot(across, across)), dot(own_normal, neighbour_normal))
    return angle


def _majority(sign: Floats, piece: Index, area: Floats, known: Mask) -> Floats:
    """Signs, reversed on each piece where most of its area has the other sign; NaN where none is known."""
    known = known & (sign != 0)
    total = np.bincount(piece[known], (sign * area)[known], minlength=int(piece.max(initial=0)) + 1)
    return np.where(known, np.where(total[piece] < 0, -sign, sign), np.nan)
