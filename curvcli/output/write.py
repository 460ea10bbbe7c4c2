"""Every output of one analysis, by suffix: tables, coloured meshes and the report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from ..declare import Quantity, passes
from ..errors import Notice, UsageError
from ..memory import require_polars
from ..tables import TABLES, vertex_properties, vertex_table
from .atomic import Outputs
from .formats import format_of

if TYPE_CHECKING:
    from ..analysis import Analysis
    from .colors import ColorScale

# What colours a mesh when nothing is asked for: the first of these that was computed.
_COLOR_BY = ("K_density", "h_signed", "h", "K", "A")


@dataclass(frozen=True)
class Appearance:
    """How tables and coloured meshes look."""

    color_by: str | None = None
    cmap: str | None = None
    value_range: str | None = None
    precision: str | int = "shortest"


def write_outputs(
    analysis: Analysis,
    paths: Iterable[str],
    *,
    force: bool = False,
    appearance: Appearance = Appearance(),
    stream_format: str | None = None,
) -> list[Notice]:
    """Write the named outputs whole or not at all; `-` is stdout in `stream_format`.

    Errors: UsageError for a suffix that is not promised, OutputError for a path that exists or cannot be written.
    """
    paths = list(paths)
    with ExitStack() as stack:
        outputs = stack.enter_context(Outputs(paths, force))
        return write_into(outputs, analysis, paths, appearance, stream_format)


def write_into(
    outputs: Outputs,
    analysis: Analysis,
    paths: Iterable[str],
    appearance: Appearance,
    stream_format: str | None = None,
    tables: Iterable[tuple[str, str]] = (),
) -> list[Notice]:
    """Write the vertex table, mesh or report that each path's suffix names into outputs that are open already.

    tables: pairs of a kind (`edges`, `faces`, …) and a path.
    """
    notices: list[Notice] = []
    require_polars(64 * analysis.surface.n_vertices)
    for kind_of_table, path in tables:
        from .tables import write_table

        with outputs.open(path) as stream:
            suffix = format_of(path, name=stream_format if path == "-" else None, kinds=["table"]).suffix
            write_table(stream, TABLES[kind_of_table](analysis), suffix, precision=appearance.precision)
    for path in paths:
        kind = format_of(path, name=stream_format if path == "-" else None)
        with outputs.open(path) as stream:
            if kind.kind == "table":
                from .tables import write_table

                write_table(stream, vertex_table(analysis), kind.suffix, precision=appearance.precision)
            elif kind.kind == "mesh":
                notices += _write_mesh(stream, analysis, kind.suffix, appearance)
            else:
                from ..report.model import encode, model

                stream.write(encode(model(analysis)))
    return notices


def check_appearance(appearance: Appearance, chosen: list[str]) -> None:
    """Refuse, before any work, a colour column that will not be there, an unknown map, range or precision.

    Errors: UsageError.
    """
    if appearance.precision != "shortest":
        from .tables import parse_precision

        parse_precision(appearance.precision)
    if appearance.cmap is not None or appearance.value_range is not None:
        from .colors import colorize

        colorize(np.zeros(1), cmap=appearance.cmap, value_range=appearance.value_range)
    if appearance.color_by is not None:
        _colored_column(appearance.color_by, chosen)


def _colored_column(name: str, chosen: list[str]) -> Quantity:
    """The quantity whose column colours the mesh."""
    columns = {column: q for q in map(passes.quantity, chosen) for column in q.columns if q.on == "vertex"}
    if name not in columns or columns[name].labels:
        known = ", ".join(column for column, quantity in columns.items() if not quantity.labels)
        raise UsageError(f"--color-by {name}: no such column is computed, expected one of {known}; -p {name} adds it")
    return columns[name]


def colors(analysis: Analysis, appearance: Appearance) -> tuple[str, ColorScale] | None:
    """The column that colours the surface and its colours; None when no column was computed."""
    from .colors import colorize

    name = appearance.color_by or next((n for n in _COLOR_BY if n in analysis.chosen), None)
    if name is None:
        return None
    quantity = _colored_column(name, analysis.chosen)
    values = np.where(analysis.surface.referenced, analysis.vertices[name].astype(np.float64), np.nan)
    scale = colorize(
        values,
        cmap=appearance.cmap,
        value_range=appearance.value_range,
        signed=quantity.signed or quantity.vector,
        ignore=analysis.surface.boundary,
    )
    return name, scale


def _write_mesh(stream: BinaryIO, analysis: Analysis, suffix: str, appearance: Appearance) -> list[Notice]:
    from .meshes import beside_input, write_mesh

    surface, file = analysis.surface, analysis.surface.file
    colored = colors(analysis, appearance)
    ours: Mapping[str, Any] = vertex_properties(analysis) if suffix == ".ply" else {}
    inputs = file.vertex_properties if file is not None and suffix == ".ply" else {}
    properties, notices = beside_input(ours, inputs, colored=colored is not None)
    polygons = None
    if file is not None and file.sizes is not None:
        polygons = (file.corners, file.sizes)
    faces = file.corners.reshape(-1, 3) if file is not None and file.sizes is None else surface.faces
    lost = write_mesh(
        stream,
        suffix,
        surface.points,
        faces,
        polygons=polygons,
        vertex_colors=None if colored is None else colored[1].rgb,
        vertex_properties=properties,
        face_properties=file.polygon_properties if file is not None else {},
        comments=_comments(analysis, colored),
    )
    return [*notices, *lost]


def _comments(analysis: Analysis, colored: tuple[str, ColorScale] | None) -> list[str]:
    convention = "k1 + k2" if analysis.conventions.mean == "sum" else "(k1 + k2) / 2"
    told = [f"curvcli: H = {convention}, positive where convex; NaN is undefined"]
    if colored is not None and colored[1].low is not None:
        name, scale = colored
        told.append(f"colour: {name} from {scale.low!r} to {scale.high!r}, {scale.cmap}")
    return told
