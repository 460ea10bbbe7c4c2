"""Binary glTF: triangles with vertex colours for viewers and web pages, written by trimesh."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ...errors import Notice, OutputError
from ...support.words import pluralize


def write_glb(
    stream: BinaryIO,
    points: NDArray[np.float64],
    faces: NDArray[np.integer[Any]],
    vertex_colors: NDArray[np.uint8] | None = None,
) -> tuple[Notice, ...]:
    """Write points (V, 3) and triangles (F, 3), with colours (V, 3) as COLOR_0; vertices keep their order.

    glTF has float32 positions. If the mesh lies far from the origin, they are relative to its middle, which
    the node stores, so that the offset costs no digits of the shape. A vertex that no face uses and that has no finite
    position is put at the origin. Colours in glTF are linear in light: a viewer shows those of the legend.
    Returns the number of rounded positions. Errors: OutputError for a size beyond float32.
    """
    import trimesh

    used = points[np.unique(faces)]
    low, high = used.min(axis=0), used.max(axis=0)
    middle, half = low / 2 + high / 2, float((high / 2 - low / 2).max())
    largest, smallest = float(np.finfo(np.float32).max), float(np.finfo(np.float32).tiny)
    if half > largest / 4 or 0 < half < smallest * 2**24:
        raise OutputError(f"glTF has float32 only, and the size {2 * half:g} of the mesh is beyond it; write .ply")
    if np.abs(middle).max() <= 4 * half:
        middle = np.zeros(3)
    shifted = np.where(np.isfinite(points), points, middle) - middle
    with np.errstate(over="ignore", under="ignore"):
        kept = shifted.astype(np.float32)
    mesh = trimesh.Trimesh(kept, faces, vertex_colors=_linear(vertex_colors), process=False, validate=False)
    scene = trimesh.Scene()
    place = np.eye(4)
    place[:3, 3] = middle
    scene.add_geometry(mesh, node_name="surface", geom_name="surface", transform=place)
    stream.write(scene.export(file_type="glb"))
    rounded = int((kept != shifted).any(axis=1).sum())
    if not rounded:
        return ()
    message = pluralize(rounded, "[position|positions] rounded to float32, the only precision glTF has")
    return (Notice("glb_float32", rounded, message, hint="write .ply, .vtp or .obj to keep every digit"),)


def _linear(colors: NDArray[np.uint8] | None) -> NDArray[np.uint8] | None:
    """(V, 4) bytes linear in light, as in glTF, from those of a screen (sRGB)."""
    if colors is None:
        return None
    screen = np.arange(256) / 255
    light = np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4)
    opaque = np.full((len(colors), 4), 255, np.uint8)
    opaque[:, :3] = np.rint(light * 255).astype(np.uint8)[colors]
    return opaque
