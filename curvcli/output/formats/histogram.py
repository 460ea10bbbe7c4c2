"""Histograms of columns, one column or two against each other."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, BinaryIO

from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance
    from ..distributions import MeshSamples


def shows(appearance: Appearance, chosen: list[str]) -> tuple[str, ...]:
    """The columns of all histograms."""
    from ..distributions import histogram_columns

    return histogram_columns(appearance, chosen)


def panels(appearance: Appearance, chosen: list[str]) -> int:
    """The number of panels."""
    from ..distributions import histograms

    return len(histograms(appearance, chosen))


def write_as(suffix: str, stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Draw the histograms; a line for each column, with its range."""
    from ..pictures.options import import_apart, require_pictures

    require_pictures(False)
    # On another stack: frames that such imports keep refer to those below, and these to the analysis.
    import_apart("matplotlib.figure")
    from ..distributions import samples_of

    return write_several(suffix, stream, samples_of(analysis, appearance), appearance)


def write_several(suffix: str, stream: BinaryIO, samples: MeshSamples, appearance: Appearance) -> list[str]:
    """Draw the histograms of one mesh or several; a line for each column, with its range."""
    from ..pictures.histogram import write_histograms

    return write_histograms(stream, samples, appearance, suffix)


for place, suffix in enumerate((".hist.png", ".hist.pdf", ".hist.svg")):
    register(
        DocumentFormat(
            suffix=suffix,
            kind="picture",
            description="histogram and area-weighted distribution of columns",
            place=20 + place,
            write=partial(write_as, suffix),
            shows=shows,
            panels=panels,
            several=partial(write_several, suffix),
        )
    )
