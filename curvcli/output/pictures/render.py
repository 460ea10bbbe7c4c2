"""The surface as pixels, rendered by VTK in memory: no display and no GPU is needed."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import MissingExtraError
from ..cells import Cells

Color = tuple[float, float, float]
Pixels = NDArray[np.uint8]

# Lines lie this much nearer to the viewer than the surface whose edges they are; the surface is 2 long.
_NEARER = 0.006
_MARGIN = 1.05
# Every pixel is the mean of four, unless that were too many for a frame buffer.
_FINER, _LARGEST_BUFFER = 2, 12000
_MESA = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")


@dataclass(frozen=True)
class Lines:
    """Edges of the surface to be drawn: (n, 2) vertex indices, their colour and their width in pixels.

    colors: (n, 3) bytes, where each edge has a colour of its own.
    """

    edges: NDArray[np.integer[Any]]
    color: Color
    width: float
    colors: NDArray[np.uint8] | None = None


def render(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    colorings: Iterable[NDArray[np.uint8]],
    size: tuple[int, int],
    *,
    background: Color,
    lines: Sequence[Lines] = (),
    mesh_color: Color | None = None,
    cells: Cells | None = None,
) -> list[Pixels]:
    """The surface once per coloring, (height, width, 3), as large as fits.

    positions: (V, 3) to the right, upwards and towards the viewer. colorings: (V, 3) colours of the vertices, blended
    over each face. mesh_color: of the edges of all faces, None to leave them out. cells: what is drawn instead of the
    faces, once and in its own colours.
    Errors: MissingExtraError where the system has no OpenGL that draws without a display.
    """
    import pyvista as pv

    colorings = list(colorings) if cells is None else [cells.colors]
    if not colorings:
        return []
    require_opengl()
    finer = _FINER if max(size) * _FINER <= _LARGEST_BUFFER else 1
    points, corners = (positions, faces) if cells is None else (cells.positions, cells.faces)
    mesh = pv.PolyData.from_regular_faces(points.astype(np.float32), corners)
    plotter = pv.Plotter(off_screen=True, window_size=[side * finer for side in size], lighting="none", border=False)
    try:
        plotter.set_background(_floats(background))
        mesh["rgb"] = np.zeros((len(points), 3), np.uint8)
        plotter.add_mesh(
            mesh,
            scalars="rgb",
            rgb=True,
            ambient=0.52,
            diffuse=0.48,
            specular=0.0,
            show_edges=mesh_color is not None and cells is None,
            edge_color=None if mesh_color is None else _floats(mesh_color),
            line_width=finer * max(0.75, min(size) / 900),
            copy_mesh=False,
        )
        for segments in lines:
            _add_lines(plotter, pv, positions, segments, finer)
        _light(plotter, pv)
        _look(plotter, positions, size)
        pictures = []
        for colors in colorings:
            mesh["rgb"][:] = colors
            mesh.Modified()
            plotter.render()
            pictures.append(_coarser(plotter.screenshot(return_img=True), finer))
        return pictures
    finally:
        plotter.close()


def _add_lines(plotter: Any, pv: Any, positions: NDArray[np.float64], lines: Lines, finer: int) -> None:
    if not len(lines.edges):
        return
    used, ends = np.unique(lines.edges, return_inverse=True)
    near = positions[used] + np.array([0.0, 0.0, _NEARER])
    wire = pv.PolyData()
    wire.points = near.astype(np.float32)
    records = np.full((len(lines.edges), 3), 2, np.int64)
    records[:, 1:] = ends.reshape(-1, 2)
    wire.lines = records.ravel()
    if lines.colors is None:
        plotter.add_mesh(wire, color=_floats(lines.color), line_width=lines.width * finer, lighting=False)
    else:
        wire.cell_data["rgb"] = lines.colors
        plotter.add_mesh(wire, scalars="rgb", rgb=True, line_width=lines.width * finer, lighting=False)


def _floats(color: Color) -> list[float]:
    """Colour from 0 to 1, in a form that VTK does not read as bytes."""
    return [float(part) for part in color]


def _light(plotter: Any, pv: Any) -> None:
    """Light from the viewer and from above to the left; a face seen from the front has exactly its colour."""
    for position, intensity in (((0, 0, 1), 0.5), ((-1.2, 1.6, 2.0), 0.68)):
        light = pv.Light(position=position, focal_point=(0, 0, 0), light_type="scene light", intensity=intensity)
        light.positional = False
        plotter.add_light(light)


def _look(plotter: Any, positions: NDArray[np.float64], size: tuple[int, int]) -> None:
    wide, high, deep = np.abs(positions).max(axis=0)
    camera = plotter.camera
    camera.position, camera.focal_point, camera.up = (0, 0, 10), (0, 0, 0), (0, 1, 0)
    camera.parallel_projection = True
    camera.parallel_scale = max(high, wide * size[1] / size[0], 1e-6) * _MARGIN
    camera.clipping_range = (9.9 - deep, 10.1 + deep)


def _coarser(pixels: Pixels, finer: int) -> Pixels:
    """Mean of each square of `finer` by `finer` pixels."""
    height, width, _ = pixels.shape
    blocks = pixels.reshape(height // finer, finer, width // finer, finer, 3)
    means: Pixels = np.rint(blocks.mean(axis=(1, 3), dtype=np.float32)).astype(np.uint8)
    return means


def require_opengl() -> None:
    """Refuse to draw without the OpenGL library: VTK would crash.

    Errors: MissingExtraError.
    """
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - without it a window is of no kind
    from vtkmodules.vtkCommonCore import vtkLogger, vtkObject
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    # VTK first tests for a display and warns that there is none; the warning is suppressed.
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    vtkObject.GlobalWarningDisplayOff()
    if "OSOpenGL" not in vtkRenderWindow().GetClassName() or any(map(_loads, _MESA)):
        return
    hint = "; `apt install libegl1` brings it to Debian and Ubuntu" if sys.platform.startswith("linux") else ""
    raise MissingExtraError(f"pictures need OpenGL that draws without a display, which this system lacks{hint}")


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
