"""Camera of a picture: axes of the screen for parallel projection."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...mesh.surface import Surface
from .options import parse_view

Frame = NDArray[np.float64]

# Above this share of its area, the vector area of a surface shows its outer side.
_ONE_SIDED = 0.1


def screen(surface: Surface, view: str, up: Literal["y", "z"] = "z") -> NDArray[np.float64]:
    """(V, 3) positions to the right, upwards and towards the viewer; the surface is centred, its longest side is 2.

    A vertex that no face uses is moved to a face; it is not drawn. Works at any scale and offset of the mesh.
    """
    xyz = np.where(surface.referenced, surface.xyz, surface.base[:, None])
    if up == "y":
        xyz = np.stack([xyz[0], -xyz[2], xyz[1]])
    middle = (xyz.max(axis=1) + xyz.min(axis=1)) / 2
    xyz = xyz - middle[:, None]
    extent = float(np.abs(xyz).max())
    if extent > 0:
        xyz /= extent
    angles = parse_view(view)
    seen = (_fitting(surface, xyz) if angles is None else frame(*angles)) @ xyz
    seen -= ((seen.max(axis=1) + seen.min(axis=1)) / 2)[:, None]
    return np.ascontiguousarray(seen.T)


def frame(azimuth: float, elevation: float) -> Frame:
    """Unit vectors to the right, upwards and towards the viewer, as rows; z is upwards on the screen."""
    around, above = math.radians(azimuth), math.radians(elevation)
    towards = np.array(
        [math.cos(above) * math.cos(around), math.cos(above) * math.sin(around), math.sin(above)], np.float64
    )
    right = np.array([-math.sin(around), math.cos(around), 0.0])
    return np.stack([right, np.cross(towards, right), towards])


def _fitting(surface: Surface, xyz: NDArray[np.float64]) -> Frame:
    """Principal axes of the surface's area: the longest to the right, the shortest towards the viewer."""
    corners = xyz[:, surface.faces]  # (3, F, 3)
    normals = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0], axis=0) / 2
    areas = np.linalg.norm(normals, axis=0)
    total = float(areas.sum())
    if not total > 0:
        areas, total = np.ones(len(areas)), float(len(areas))
    centres = corners.mean(axis=2)
    centres -= (centres @ areas / total)[:, None]
    towards, upwards, _ = np.linalg.eigh((centres * areas) @ centres.T / total)[1].T
    side = normals.sum(axis=1)
    towards *= np.sign(towards @ side) if np.linalg.norm(side) > _ONE_SIDED * total else _sign(towards)
    upwards *= _sign(upwards)
    return np.stack([np.cross(upwards, towards), upwards, towards])


def _sign(direction: NDArray[np.float64]) -> float:
    """Sign that makes the largest coordinate positive."""
    return 1.0 if direction[np.argmax(np.abs(direction))] >= 0 else -1.0
