"""Appearance of tables, coloured meshes and pictures."""

from __future__ import annotations

from dataclasses import dataclass, field

from .pictures.options import PictureOptions

REGION = "region"
"""Name of the labels of `--regions` among the columns of `color_by`."""


@dataclass(frozen=True)
class Appearance:
    """Options for the appearance of tables, coloured meshes and pictures.

    color_by: the columns of a picture; the first of them colours a mesh. quality: true if `.ply` also has that column
    as `quality`, the name that MeshLab colours by. histograms: one column, or two against each other, for each of them;
    none for `color_by`. bins: of every histogram, None for a number by the rule of `distributions.axis`. columns: of
    the tables of `--table`, none for all.
    """

    color_by: tuple[str, ...] = ()
    cmap: str | None = None
    value_range: str | None = None
    precision: str | int = "shortest"
    quality: bool = False
    histograms: tuple[tuple[str, ...], ...] = ()
    bins: int | None = None
    columns: tuple[str, ...] = ()
    picture: PictureOptions = field(default_factory=PictureOptions)


DEFAULT = Appearance()
