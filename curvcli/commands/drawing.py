"""Options of pictures, histograms and tables, and the appearance that they describe."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from . import candidates
from .options import together

if TYPE_CHECKING:
    from ..output.appearance import Appearance

drawing = together(
    click.option(
        "--color-by",
        metavar="COLUMN[,COLUMN]",
        shell_complete=candidates.columns,
        help="Columns of pictures and histograms, a panel each; the first one colours meshes and pages.",
    ),
    click.option(
        "--histogram",
        "histograms",
        metavar="COLUMN[,COLUMN]",
        shell_complete=candidates.columns,
        multiple=True,
        help="Column of a histogram, or two against each other, such as kappa_1,kappa_2; repeatable, a panel each.  "
        "[default: --color-by, else every number]",
    ),
    click.option(
        "--bins",
        type=click.IntRange(1, 1000),
        help="Bins of histograms within their range, per column.  [default: 2 ∛n for n values, from 10 to 60]",
    ),
    click.option(
        "--columns",
        metavar="NAME[,NAME]",
        help="Columns of the tables of --table, in this order, such as region,area,h_area_mean.",
    ),
    click.option("--cmap", metavar="NAME", help="Colour map, such as crameri:vik or viridis."),
    click.option(
        "--range",
        "value_range",
        metavar="LO:HI|pNN|common",
        help="Ends of the colour map, or a central percentage; common: one range over all meshes of a batch.",
    ),
    click.option(
        "--view",
        metavar="iso|front|top|fit|AZ,EL",
        default="iso",
        show_default=True,
        help="Direction of view of a picture: azimuth and elevation in degrees; fit: along the direction in which "
        "the surface is thinnest.",
    ),
    click.option(
        "--up",
        type=click.Choice(["y", "z"]),
        default="z",
        show_default=True,
        help="Axis that points up in a picture.",
    ),
    click.option("--size", metavar="WxH", help="Pixels of a picture.  [default: 1200x900, more for several panels]"),
    click.option(
        "--background",
        metavar="COLOR",
        default="white",
        show_default=True,
        help="Background of a picture: a name or #rrggbb.",
    ),
    click.option(
        "--dpi",
        type=click.IntRange(30, 1200),
        default=300,
        show_default=True,
        help="Pixels per inch of the surface in .pdf and .svg, where 100 pixels of --size are an inch.",
    ),
    click.option("--edges-on", is_flag=True, help="Draw the edges of all faces in a picture."),
    click.option("--quality", is_flag=True, help="Also write the colouring column of .ply as `quality`, for MeshLab."),
)


def _listed(text: str) -> tuple[str, ...]:
    """Names of a comma list."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def appearance_of(settings: dict[str, Any], precision: str = "shortest") -> Appearance:
    """Appearance of outputs from the options of `drawing`, which are removed from the settings.

    Errors: UsageError for an invalid size.
    """
    from ..output.appearance import Appearance
    from ..output.pictures.options import PictureOptions, parse_size

    columns = tuple(dict.fromkeys(_listed(settings.pop("color_by") or "")))
    view, up, size, background, edges = (settings.pop(key) for key in ("view", "up", "size", "background", "edges_on"))
    cmap, value_range, quality = (settings.pop(key) for key in ("cmap", "value_range", "quality"))
    picture = PictureOptions(view, up, parse_size(size), background, edges, settings.pop("dpi"))
    histograms = tuple(dict.fromkeys(names for names in map(_listed, settings.pop("histograms")) if names))
    bins, table_columns = settings.pop("bins"), _listed(settings.pop("columns") or "")
    return Appearance(columns, cmap, value_range, precision, quality, histograms, bins, table_columns, (), picture)
