"""Every output of one analysis, by suffix: tables, coloured meshes and the report."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from threading import Event
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from ..declare import Quantity, passes
from ..errors import Notice, UsageError
from ..memory import require_polars
from ..nearest import suggestion
from ..tables import ROWS_IN_A_FRAME, TABLES, Table, vertex_properties, vertex_table
from .atomic import Outputs
from .formats import Format, format_of
from .look import Look, check_look, import_apart, parse_view, require_pictures, require_vtk

if TYPE_CHECKING:
    from ..analysis import Analysis
    from .colors import ColorScale
    from .legend import Colored

# What colours a mesh when nothing is asked for: the first of these that was computed.
_COLOR_BY = ("K_density", "h_signed", "h", "K", "A")


@dataclass(frozen=True)
class Appearance:
    """How tables, coloured meshes and pictures look.

    color_by: the columns of a picture; the first of them colours a mesh. quality: whether `.ply` has that column once
    more as `quality`, the name that MeshLab colours by.
    """

    color_by: tuple[str, ...] = ()
    cmap: str | None = None
    value_range: str | None = None
    precision: str | int = "shortest"
    quality: bool = False
    look: Look = field(default_factory=Look)


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
    with Outputs(paths, force) as outputs:
        return write_into(outputs, analysis, paths, appearance, stream_format)


def write_into(
    outputs: Outputs,
    analysis: Analysis,
    paths: Iterable[str],
    appearance: Appearance,
    stream_format: str | None = None,
    tables: Iterable[tuple[str, str]] = (),
    tell: Callable[[str], None] = lambda line: None,
    command: str | None = None,
    meanwhile: Callable[[], None] = lambda: None,
) -> list[Notice]:
    """Write the vertex table, mesh, picture or report that each path's suffix names into outputs that are open already.

    tables: pairs of a kind (`edges`, `faces`, …) and a path. tell: takes what a picture leaves out, a line at a time.
    command: what makes these outputs, for the pages that say so. meanwhile: work that the reports need, done while the
    tables are written: polars formats them outside the interpreter.
    """
    notices: list[Notice] = []
    formats = {path: format_of(path, name=stream_format if path == "-" else None) for path in paths}
    tables = list(tables)
    if tables or any(found.kind == "table" for found in formats.values()):
        require_polars(64 * min(analysis.surface.n_vertices, ROWS_IN_A_FRAME))
    stop = Event()
    with ThreadPoolExecutor(1) as other:
        try:
            written = [
                other.submit(_write_table, outputs, path, columns, suffix, appearance.precision, stop)
                for path, columns, suffix in _tables(analysis, formats, tables, stream_format)
            ]
            for path in (path for path, found in formats.items() if found.kind == "mesh"):
                with outputs.open(path) as stream:
                    notices += _write_mesh(stream, analysis, formats[path].suffix, appearance)
            meanwhile()
            for path, found in formats.items():
                if found.kind in ("table", "mesh"):
                    continue
                with outputs.open(path) as stream:
                    if found.kind == "picture":
                        for line in _write_picture(stream, analysis, found.suffix, appearance):
                            tell(f"{path}: {line}")
                    elif found.kind == "page":
                        _write_page(stream, analysis, found.suffix, appearance, command)
                    else:
                        from ..report.build import model
                        from ..report.model import encode

                        stream.write(encode(model(analysis)))
            for table in written:
                table.result()
        except BaseException:
            stop.set()
            raise
    return notices


def _tables(
    analysis: Analysis, formats: Mapping[str, Format], others: Iterable[tuple[str, str]], stream_format: str | None
) -> Iterator[tuple[str, Table, str]]:
    """Path, columns and suffix of every table that is wanted."""
    for kind, path in others:
        suffix = format_of(path, name=stream_format if path == "-" else None, kinds=["table"]).suffix
        yield path, TABLES[kind](analysis), suffix
    wanted = [path for path, found in formats.items() if found.kind == "table"]
    columns = vertex_table(analysis) if wanted else {}
    yield from ((path, columns, formats[path].suffix) for path in wanted)


def _write_table(outputs: Outputs, path: str, columns: Table, suffix: str, precision: str | int, stop: Event) -> None:
    from .tables import write_table

    with outputs.open(path) as stream:
        write_table(stream, columns, suffix, precision=precision, stop=stop)


def check_appearance(appearance: Appearance, chosen: list[str], suffixes: Iterable[str] = ()) -> None:
    """Refuse, before any work, a colour column that will not be there, an unknown map, range, view or precision.

    suffixes: of the outputs, which may need libraries that are not installed.
    Errors: UsageError, MissingExtraError.
    """
    parse_view(appearance.look.view)
    suffixes = set(suffixes)
    pictures = suffixes & {".png", ".hist.png"}
    if pictures:
        panels = max(len(_panels(appearance, chosen, suffix)) for suffix in pictures)
        check_look(appearance.look, panels, surface=".png" in pictures)
    if suffixes & {".vtp", ".vtu"}:
        require_vtk()
    if appearance.precision != "shortest":
        from .tables import parse_precision

        parse_precision(appearance.precision)
    if appearance.cmap is not None or appearance.value_range is not None:
        from .colors import colorize

        colorize(np.zeros(1), cmap=appearance.cmap, value_range=appearance.value_range)
    for name in appearance.color_by:
        quantity = _colored_column(name, chosen)
        elsewhere = sorted(suffixes & {".ply", ".obj", ".glb", ".vtp", ".vtu", ".hist.png"})
        if quantity.on == "edge" and elsewhere:
            raise UsageError(
                f"--color-by {name}: a column of edges, for which {elsewhere[0]} has no colours; a picture (.png) and "
                "a page (.html) show it, --table edges=PATH holds it"
            )


def _columns(chosen: list[str]) -> dict[str, Quantity]:
    """The vertex columns that were computed, each with its quantity."""
    return {column: q for q in map(passes.quantity, chosen) for column in q.columns if q.on == "vertex"}


def along_edges() -> dict[str, Quantity]:
    """The numbers of edges, each with its quantity."""
    return {column: q for q in passes.quantities("edge") for column in q.columns if not q.vector}


def _colored_column(name: str, chosen: list[str]) -> Quantity:
    """The quantity whose column colours the mesh, or its edges: these are computed with every table of edges."""
    columns = _columns(chosen)
    along = along_edges()
    if name in along and name not in columns:
        return along[name]
    if name not in columns:
        offered = _columns([quantity.name for quantity in passes.quantities("vertex")])
        if name in offered:
            raise UsageError(f"--color-by {name}: is not computed; -p core,{offered[name].name} adds it")
        way_out = suggestion(name, [*offered, *along], "`curvcli passes` lists them")
        raise UsageError(f"--color-by {name}: no such column of vertices{way_out}")
    return columns[name]


def colored(analysis: Analysis, name: str, appearance: Appearance) -> Colored:
    """A column with the colours that it has in every output."""
    from .colors import categorize, colorize
    from .floor import edge_floor, floor
    from .legend import Colored

    quantity = _colored_column(name, analysis.chosen)
    if quantity.on == "edge":
        values, theta = (analysis.edges[key].astype(np.float64) for key in (name, "theta"))
        flat = edge_floor(analysis, theta) if quantity.signed else None
        cmap, value_range = appearance.cmap, appearance.value_range
        scale = colorize(values, cmap=cmap, value_range=value_range, signed=quantity.signed, floor=flat)
        return Colored(name, quantity, scale)
    if quantity.labels:
        return Colored(name, quantity, categorize(analysis.columns[name], quantity.labels))
    values = np.where(analysis.surface.referenced, analysis.vertices[name].astype(np.float64), np.nan)
    scale = colorize(
        values,
        cmap=appearance.cmap,
        value_range=appearance.value_range,
        signed=quantity.signed or quantity.vector,
        ignore=analysis.surface.boundary,
        floor=floor(analysis, quantity, values),
    )
    return Colored(name, quantity, scale)


def colors(analysis: Analysis, appearance: Appearance) -> tuple[str, ColorScale] | None:
    """The column that colours the surface and its colours; None when no column was computed."""
    chosen = (
        tuple(name for name in appearance.color_by if name in _columns(analysis.chosen))[:1]
        or tuple(name for name in _COLOR_BY if name in analysis.chosen)[:1]
    )
    return (chosen[0], colored(analysis, chosen[0], appearance).scale) if chosen else None


def _panels(appearance: Appearance, chosen: list[str], suffix: str) -> tuple[str, ...]:
    """The columns that a picture shows: those asked for, else all numbers in histograms and one column elsewhere."""
    if appearance.color_by:
        return appearance.color_by
    if suffix == ".hist.png":
        return tuple(name for name, q in _columns(chosen).items() if not q.vector and not q.labels)
    return tuple(name for name in (*_COLOR_BY, "status") if name in chosen)[:1]


def _write_picture(stream: BinaryIO, analysis: Analysis, suffix: str, appearance: Appearance) -> list[str]:
    """Draw the surface or the histograms; what is to be said of each column, a line each."""
    from .legend import sentence

    require_pictures(suffix != ".hist.png")
    # What such imports leave behind refers to the frames below it, and those here to the analysis.
    import_apart("matplotlib.figure", *(() if suffix == ".hist.png" else ("pyvista.plotting",)))
    shown = [colored(analysis, name, appearance) for name in _panels(appearance, analysis.chosen, suffix)]
    if suffix == ".hist.png":
        from .histogram import write_histograms

        write_histograms(stream, analysis, shown, appearance.look, appearance.value_range)
    else:
        from .picture import write_picture

        write_picture(stream, analysis, shown, appearance.look, appearance.value_range)
    return [sentence(one, appearance.value_range, analysis.conventions.unit) for one in shown]


def _write_page(stream: BinaryIO, analysis: Analysis, suffix: str, appearance: Appearance, command: str | None) -> None:
    """Write the report for people."""
    if suffix == ".md":
        from ..report.build import model
        from ..report.markdown import markdown

        stream.write(markdown(model(analysis), command).encode("utf-8"))
    else:
        from .html.page import page

        first = appearance.color_by or tuple(name for name in _COLOR_BY if name in analysis.chosen)[:1]
        stream.write(page(analysis, appearance, first, command))


def _write_mesh(stream: BinaryIO, analysis: Analysis, suffix: str, appearance: Appearance) -> list[Notice]:
    from .meshes import beside_input, write_mesh

    if suffix in (".vtp", ".vtu"):
        require_vtk()
    surface, file = analysis.surface, analysis.surface.file
    painted = colors(analysis, appearance)
    full = suffix in (".ply", ".vtp", ".vtu")
    ours: dict[str, Any] = vertex_properties(analysis) if full else {}
    if suffix == ".ply" and appearance.quality and painted is not None:
        ours["quality"] = ours[painted[0]]
    inputs = file.vertex_properties if file is not None and full else {}
    properties, notices = beside_input(ours, inputs, colored=painted is not None)
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
        vertex_colors=None if painted is None else painted[1].rgb,
        vertex_properties=properties,
        face_properties=file.polygon_properties if file is not None else {},
        comments=_comments(analysis, painted),
        triangles=surface.faces,
        active=None if painted is None else painted[0],
    )
    return [*notices, *lost]


def _comments(analysis: Analysis, painted: tuple[str, ColorScale] | None) -> list[str]:
    convention = "k1 + k2" if analysis.conventions.mean == "sum" else "(k1 + k2) / 2"
    told = [f"curvcli: H = {convention}, positive where convex; NaN is undefined"]
    if painted is not None and painted[1].low is not None:
        name, scale = painted
        told.append(f"colour: {name} from {scale.low!r} to {scale.high!r}, {scale.cmap}")
    return told
