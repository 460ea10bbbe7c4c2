"""Appearance of tables, coloured meshes and pictures."""

from __future__ import annotations

from dataclasses import dataclass, field

from .pictures.options import PictureOptions

COMMON = "common"
"""Value of `--range` for one range over all meshes of a batch, and the sign of such a range."""

REGION = "region"
"""Name of the labels of `--regions` among the columns of `color_by`."""


@dataclass(frozen=True)
class Appearance:
    """Options for the appearance of tables, coloured meshes and pictures.

    color_by: the columns of a picture; the first of them colours a mesh. quality: true if `.ply` also has that column
    as `quality`, the name that MeshLab colours by. histograms: one column, or two against each other, for each of them;
    none for `color_by`. bins: of every histogram, None for a number by the rule of `distributions.axis`. columns: of
    the tables of `--table`, none for all. ranges: column, low and high of ranges that are common to the meshes of a
    batch; they take the place of `value_range`.
    """

    color_by: tuple[str, ...] = ()
    cmap: str | None = None
    value_range: str | None = None
    precision: str | int = "shortest"
    quality: bool = False
    histograms: tuple[tuple[str, ...], ...] = ()
    bins: int | None = None
    columns: tuple[str, ...] = ()
    ranges: tuple[tuple[str, float, float], ...] = ()
    picture: PictureOptions = field(default_factory=PictureOptions)

    def range_of(self, name: str) -> str | None:
        """Range of the colours of one column, as `--range`."""
        for column, low, high in self.ranges:
            if column == name:
                return f"{COMMON}:{low!r}:{high!r}"
        return self.value_range

    @property
    def range_rule(self) -> str | None:
        """A range whose rule is that of all columns, for legends."""
        return f"{COMMON}:0:1" if self.ranges else self.value_range


DEFAULT = Appearance()
