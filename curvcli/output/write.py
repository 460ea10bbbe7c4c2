"""Every output of one analysis, by suffix: tables, coloured meshes and the report."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Event
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from ..curvatures.registry import passes
from ..errors import Notice, UsageError
from ..support.memory import require_polars
from .appearance import DEFAULT, Appearance
from .atomic import Outputs
from .coloring import color_needs, colored_quantity, colors
from .distributions import histogram_columns, samples_of
from .pictures.options import check_picture_options, parse_view
from .registry import DocumentFormat, Format, MeshFormat, OverlayFormat, TableFormat, format_of, output_formats
from .tables.columns import (
    HISTOGRAM,
    ROWS_IN_A_FRAME,
    TABLES,
    Table,
    brief_table,
    chosen_columns,
    vertex_properties,
    vertex_table,
)
from .tables.histogram import histogram_table

if TYPE_CHECKING:
    from ..analysis.result import Result
    from .pictures.colors import ColorScale


def write_outputs(
    analysis: Result,
    paths: Iterable[str],
    *,
    force: bool = False,
    appearance: Appearance = DEFAULT,
    stream_format: str | None = None,
) -> list[Notice]:
    """Write the named outputs whole or not at all; `-` is stdout in `stream_format`.

    Errors: UsageError for an unknown suffix, OutputError for a path that exists or cannot be written.
    """
    paths = list(paths)
    formats = [format_of(path, name=stream_format if path == "-" else None) for path in paths]
    with Outputs(paths, force) as outputs:
        analysis.include(needs(formats, (), appearance, analysis.chosen))
        return write_into(outputs, analysis, paths, appearance, stream_format)[0]


def needs(formats: Iterable[Format], tables: Iterable[str], appearance: Appearance, chosen: list[str]) -> set[str]:
    """The quantities that outputs need beside the chosen ones: `besides` of a `Request`.

    tables: kinds of tables. chosen: names of quantities, at each scale.
    """
    tables = {*tables}
    names = {quantity.name for kind in ("edge", "face") if f"{kind}s" in tables for quantity in passes.quantities(kind)}
    columns: set[str] = set()
    for format in formats:
        if format.shows is not None:
            columns.update(format.shows(appearance, chosen))
    if HISTOGRAM in tables:
        columns.update(histogram_columns(appearance, chosen))
    return names.union(*(color_needs(name, chosen) for name in columns)).difference(chosen)


def write_into(
    outputs: Outputs,
    analysis: Result,
    paths: Iterable[str],
    appearance: Appearance,
    stream_format: str | None = None,
    tables: Iterable[tuple[str, str]] = (),
    command: str | None = None,
    checked: Future[None] | None = None,
) -> tuple[list[Notice], list[str]]:
    """Write the vertex table, mesh, picture or report that each path's suffix names into outputs that are open already.

    Returns notices of values that a format cannot hold, and a line for each column of a picture, with its range, and
    for each overlay, with its columns. The analysis must include the quantities of `needs`. tables: pairs of a kind
    (`edges`, `faces`, …) and a path. command: the command line, for pages. checked: the checks, computed in another
    thread; reports wait for them.
    """
    notices: list[Notice] = []
    ranges: list[str] = []
    formats = {path: format_of(path, name=stream_format if path == "-" else None) for path in paths}
    tables = list(tables)
    if tables or any(format.kind == "table" for format in formats.values()):
        require_polars(64 * min(analysis.surface.n_vertices, ROWS_IN_A_FRAME))
    stop = Event()
    with ThreadPoolExecutor(1) as other:
        try:
            written = [
                other.submit(_write_table, outputs, path, columns, suffix, appearance.precision, stop)
                for path, columns, suffix in _tables(analysis, formats, tables, stream_format, appearance)
            ]
            for path, format in formats.items():
                if isinstance(format, MeshFormat):
                    with outputs.open(path) as stream:
                        notices += _write_mesh(stream, analysis, format, appearance)
                elif isinstance(format, OverlayFormat):
                    from .overlays import write_overlay

                    with outputs.open(path) as stream:
                        line, lost = write_overlay(stream, analysis, path, format, appearance)
                    notices += lost
                    ranges.append(f"{path}: {line}")
                elif isinstance(format, TableFormat) and format.totals is not None:
                    with outputs.open(path) as stream:
                        format.totals(stream, analysis, appearance)
            if checked is not None:
                checked.result()
            for path, format in formats.items():
                if isinstance(format, DocumentFormat):
                    with outputs.open(path) as stream:
                        ranges += [f"{path}: {line}" for line in format.write(stream, analysis, appearance, command)]
            for table in written:
                table.result()
        except BaseException:
            stop.set()
            raise
    return notices, ranges


def _tables(
    analysis: Result,
    formats: Mapping[str, Format],
    others: Iterable[tuple[str, str]],
    stream_format: str | None,
    appearance: Appearance,
) -> Iterator[tuple[str, Table, str]]:
    """Path, columns and suffix of every requested table."""
    for kind, path in others:
        format = format_of(path, name=stream_format if path == "-" else None, kinds=["table"])
        table = _table(kind, analysis, appearance)
        if appearance.columns:
            table = chosen_columns(table, appearance.columns)
        elif isinstance(format, TableFormat) and format.brief:
            table = brief_table(table)
        yield path, table, format.suffix
    table_paths = [
        path for path, format in formats.items() if isinstance(format, TableFormat) and format.totals is None
    ]
    columns = vertex_table(analysis) if table_paths else {}
    yield from ((path, columns, formats[path].suffix) for path in table_paths)


def _table(kind: str, analysis: Result, appearance: Appearance) -> Table:
    if kind == HISTOGRAM:
        return histogram_table(samples_of(analysis, appearance), appearance)
    return TABLES[kind](analysis)


def _write_table(outputs: Outputs, path: str, columns: Table, suffix: str, precision: str | int, stop: Event) -> None:
    from .tables.write import write_table

    with outputs.open(path) as stream:
        write_table(stream, columns, suffix, precision=precision, stop=stop)


def check_appearance(appearance: Appearance, chosen: list[str], suffixes: Iterable[str] = ()) -> None:
    """Refuse, before any work, a colour column that will not be there, an unknown map, range, view or precision.

    suffixes: of the outputs, which may need libraries that are not installed.
    Errors: UsageError, MissingExtraError.
    """
    parse_view(appearance.picture.view)
    formats = [format for suffix, format in output_formats().items() if suffix in {*suffixes}]
    pictures = [
        output_format
        for output_format in formats
        if isinstance(output_format, DocumentFormat) and output_format.kind == "picture" and output_format.shows
    ]
    if pictures:
        count = max(_panels(picture, appearance, chosen) for picture in pictures)
        check_picture_options(
            appearance.picture,
            count,
            surface=any(picture.camera for picture in pictures),
            page=any(picture.page for picture in pictures),
        )
    for output_format in formats:
        output_format.require()
    if appearance.precision != "shortest":
        from .tables.write import parse_precision

        parse_precision(appearance.precision)
    if appearance.cmap is not None or appearance.value_range is not None:
        from .pictures.colors import colorize

        colorize(np.zeros(1), cmap=appearance.cmap, value_range=appearance.value_range)
    check_histograms(appearance, chosen)
    for name in appearance.color_by:
        quantity = colored_quantity(name, chosen)
        lacking = sorted(
            output_format.suffix
            for output_format in formats
            if output_format.shows is not None and not output_format.edges
        )
        if quantity.on == "edge" and lacking:
            raise UsageError(
                f"--color-by {name}: a column of edges, for which {lacking[0]} has no colours; use a picture (.png), "
                "a page (.html) or --table edges=PATH"
            )


def _panels(format: DocumentFormat, appearance: Appearance, chosen: list[str]) -> int:
    if format.panels is not None:
        return format.panels(appearance, chosen)
    return 0 if format.shows is None else len(list(format.shows(appearance, chosen)))


def check_histograms(appearance: Appearance, chosen: list[str]) -> None:
    """Errors: UsageError for a histogram of more than two columns, of edges, or of labels against a column."""
    for columns in appearance.histograms:
        named = f"--histogram {','.join(columns)}"
        if len(columns) > 2:
            raise UsageError(f"{named}: {len(columns)} columns, expected one, or two against each other")
        for name in columns:
            quantity = colored_quantity(name, chosen, "--histogram")
            if quantity.on == "edge":
                raise UsageError(f"{named}: {name} is a column of edges, expected columns of vertices")
            if quantity.labels and len(columns) > 1:
                raise UsageError(f"{named}: {name} has labels, expected numbers against each other")


def _write_mesh(stream: BinaryIO, analysis: Result, format: MeshFormat, appearance: Appearance) -> list[Notice]:
    from .meshes.write import beside_input

    format.require()
    surface, file = analysis.surface, analysis.surface.file
    painted = colors(analysis, appearance)
    full = format.properties
    ours: dict[str, Any] = vertex_properties(analysis) if full else {}
    if format.quality and appearance.quality and painted is not None:
        ours["quality"] = ours[painted[0]]
    inputs: dict[str, Any] = file.vertex_labels | file.vertex_properties if file is not None and full else {}
    per_face: dict[str, Any] = dict(file.polygon_properties) if file is not None else {}
    if file is not None and format.labels:
        per_face = file.polygon_labels | per_face
    properties, notices = beside_input(ours, inputs, colored=painted is not None)
    polygons = None
    if file is not None and file.sizes is not None:
        polygons = (file.corners, file.sizes)
    faces = file.corners.reshape(-1, 3) if file is not None and file.sizes is None else surface.faces
    lost = format.write(
        stream,
        surface.points,
        faces,
        polygons=polygons,
        vertex_colors=None if painted is None else painted[1].rgb,
        vertex_properties=properties,
        face_properties=per_face,
        comments=_comments(analysis, painted),
        triangles=surface.faces,
        active=None if painted is None else painted[0],
    )
    return [*notices, *lost]


def _comments(analysis: Result, painted: tuple[str, ColorScale] | None) -> list[str]:
    convention = "k1 + k2" if analysis.conventions.mean == "sum" else "(k1 + k2) / 2"
    comments = [f"curvcli: H = {convention}, positive where convex; NaN is undefined"]
    if painted is not None and painted[1].low is not None:
        name, scale = painted
        comments.append(f"colour: {name} from {scale.low!r} to {scale.high!r}, {scale.cmap}")
    if analysis.conventions.unit:
        comments.append(f"unit of length: {analysis.conventions.unit}")
    return comments
