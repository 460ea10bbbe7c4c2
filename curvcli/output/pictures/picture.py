"""Picture of a surface: a panel per column, each with its colour bar and legend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ...analysis.scale_notices import STARS
from ...support.words import counted
from ..cells import MOST_FACES, Cells, own_cells
from .camera import screen
from .legend import Colored, about, mesh_name, sentence
from .options import PANEL, SMALL_PANEL, PictureOptions, arrange
from .panels import draw_bar, draw_title, legend
from .render import Color, Lines, Pixels, render
from .sheet import LINE, LegendEntry, Sheet

if TYPE_CHECKING:
    from ...analysis.result import Result

_NONMANIFOLD: Color = (0.9, 0.0, 0.47)
_MESH: Color = (0.1, 0.1, 0.1)
_PLAIN = (200, 200, 200)


def write_picture(
    stream: BinaryIO,
    analysis: Result,
    columns: Sequence[Colored],
    options: PictureOptions,
    value_range: str | None,
    suffix: str = ".png",
) -> None:
    """Write the surface, coloured by each of the columns; grey if there are none.

    On a page (.pdf, .svg) the surface is an image of `options.dpi`, everything else is text and lines.
    Boundary edges and edges of more than two faces are drawn as lines; undefined values are grey.
    Errors: MissingExtraError where the system cannot draw.
    """
    count = max(1, len(columns))
    across, down, size = arrange(count, options.size, PANEL if count == 1 else SMALL_PANEL)
    sheet = Sheet(size, options.background, suffix)
    edge_ink: Color = (0.97, 0.97, 0.97) if sheet.dark else (0.0, 0.0, 0.0)
    page = _Page(sheet, analysis, columns, value_range, across, down, edge_ink)
    surface = analysis.surface
    edges = np.stack([surface.edges.a, surface.edges.b], axis=1)
    finer = options.finer if sheet.vector else 1.0
    pixels_of = round(finer * page.picture[0]), round(finer * page.picture[1])
    thick = finer * max(1.5, min(page.picture) / 260)
    lines = [
        Lines(edges[surface.boundary_edges], edge_ink, thick),
        Lines(edges[surface.nonmanifold_edges], _NONMANIFOLD, thick),
    ]
    surface_color = np.broadcast_to(np.array(_PLAIN, np.uint8), (surface.n_vertices, 3))
    positions = screen(surface, options.view, options.up)
    settings: dict[str, Any] = {"background": sheet.background, "mesh_color": _MESH if options.edges else None}

    def draw(
        colorings: Sequence[NDArray[np.uint8]], lines: Sequence[Lines], cells: Cells | None = None
    ) -> list[Pixels]:
        return render(positions, surface.faces, colorings, pixels_of, lines=lines, cells=cells, **settings)

    blended = [place for place, column in enumerate(columns) if not page.cut(column) and column.quantity.on == "vertex"]
    pictures = draw([columns[place].scale.rgb for place in blended], lines)
    shown = dict(zip(blended, pictures, strict=True))
    for place, column in enumerate(columns):
        if column.quantity.on == "edge":
            bent = np.flatnonzero((column.scale.rgb != column.scale.undefined).any(axis=1) & page.unlike_0(column))
            bent = bent[np.argsort(np.abs(np.nan_to_num(analysis.edges[column.name][bent])), kind="stable")]
            tinted = Lines(edges[bent], edge_ink, 1.5 * thick, column.scale.rgb[bent])
            shown[place] = draw([surface_color], [*lines, tinted])[0]
        elif page.cut(column):
            cells = own_cells(positions, surface.faces, column.scale.rgb, page.flat(column))
            shown[place] = draw([], lines, cells)[0]
    for place, pixels in shown.items() if columns else enumerate(draw([surface_color], lines)):
        sheet.image(pixels, page.box(place))
    page.draw()
    sentences = [sentence(column, value_range, analysis.conventions.unit) for column in columns]
    stream.write(sheet.content(page.name, "\n".join(sentences)))


class _Page:
    """Layout of the sheet, with its texts."""

    def __init__(
        self,
        sheet: Sheet,
        analysis: Result,
        columns: Sequence[Colored],
        value_range: str | None,
        across: int,
        down: int,
        edge_ink: Color,
    ) -> None:
        self.sheet, self.columns, self.across = sheet, columns, across
        self.unit = analysis.conventions.unit
        panel = sheet.width / across, sheet.height / down
        self.font = font = sheet.font(*panel)
        self.small = max(0.85 * font, 8.0)
        self.margin = round(0.8 * font)
        self.name = mesh_name(analysis)
        few = analysis.surface.n_faces <= MOST_FACES
        self.creased = few and any(notice.code == "creased" for notice in analysis.notices)
        self.footer = sheet.flow(self._footer(analysis, edge_ink), sheet.width - 2 * self.margin, self.small)
        foot = len(self.footer) * LINE * self.small + self.margin
        self.panel = int(panel[0]), int((sheet.height - foot) / down)
        inner = self.panel[0] - 2 * self.margin
        self.legends = [sheet.flow(legend(column, value_range), inner, self.small) for column in columns]
        rows = max(map(len, self.legends), default=0)
        self.bar = any(column.scale.low is not None for column in columns)
        below = rows * LINE * self.small + (2.9 * font if self.bar else 0)
        self.above = 2.0 * font if columns else self.margin
        self.picture = inner, max(16, int(self.panel[1] - self.above - below - 0.4 * font))

    def cut(self, column: Colored) -> bool:
        """True if a column is painted in the cells of its vertices: a density of stars on a creased mesh."""
        return self.creased and column.quantity.name in STARS and column.scale.low is not None

    def flat(self, column: Colored) -> tuple[int, int, int]:
        """The colour of 0, which flat faces have between the cells; at the end of the map that is nearer to it."""
        scale = column.scale
        low, high = scale.low or 0.0, scale.high or 0.0
        share = min(max(-(low / 2) / (high / 2 - low / 2), 0.0), 1.0) if high > low else 0.5
        red, green, blue = scale.gradient[round(share * (len(scale.gradient) - 1))].tolist()
        return red, green, blue

    def unlike_0(self, column: Colored) -> NDArray[np.bool_]:
        """(n,) whose colour is not that of 0."""
        different: NDArray[np.bool_] = (column.scale.rgb != np.array(self.flat(column), np.uint8)).any(axis=1)
        return different

    def box(self, place: int) -> tuple[int, int, int, int]:
        """Left, top, width and height in pixels of the picture in a panel."""
        left, top = self._origin(place)
        return left + self.margin, int(top + self.above), *self.picture

    def draw(self) -> None:
        """Titles, colour bars and legends of all panels, and the line at the foot."""
        sheet = self.sheet
        for place, column in enumerate(self.columns):
            left, top = self._origin(place)
            corner = (left + self.margin, top + 1.1 * self.font)
            draw_title(sheet, [column], self.unit, corner, self.font, self.picture[0])
            at = top + self.above + self.picture[1] + 0.4 * self.font
            if column.scale.low is not None:
                inset = 0.06 * self.picture[0]
                box = (left + self.margin + inset, at, self.picture[0] - 2 * inset, 0.9 * self.font)
                draw_bar(self.sheet, column, box, self.font)
                at += 2.9 * self.font
            self.sheet.draw(self.legends[place], left + self.margin, at, self.small)
        foot = len(self.footer) * LINE * self.small
        self.sheet.draw(self.footer, self.margin, self.sheet.height - foot - 0.5 * self.margin, self.small)

    def _origin(self, place: int) -> tuple[int, int]:
        row, column = divmod(place, self.across)
        return column * self.panel[0], row * self.panel[1]

    def _footer(self, analysis: Result, edge_ink: Color) -> list[LegendEntry]:
        surface = analysis.surface
        items = []
        boundary, crowded = (int(mask.sum()) for mask in (surface.boundary_edges, surface.nonmanifold_edges))
        if boundary:
            items.append(LegendEntry(counted(boundary, "boundary edge"), "line", edge_ink))
        if crowded:
            items.append(LegendEntry(f"{counted(crowded, 'edge')} of more than two faces", "line", _NONMANIFOLD))
        if any(map(self.cut, self.columns)):
            items.append(LegendEntry("creased: a vertex colours its own cell, flat faces between have the colour of 0"))
        return [*items, *map(LegendEntry, about(analysis, [column.quantity for column in self.columns]))]
