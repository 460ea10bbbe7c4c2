"""Histograms of columns."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, BinaryIO

from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance


def shows(appearance: Appearance, chosen: list[str]) -> tuple[str, ...]:
    """The columns asked for, or all numbers of vertices."""
    from ..coloring import vertex_quantities

    numbers = (name for name, q in vertex_quantities(chosen).items() if not q.vector and not q.labels)
    return appearance.color_by or tuple(numbers)


def write_as(suffix: str, stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Draw the histograms; a line for each column, with its range."""
    from ..pictures.options import import_apart, require_pictures

    require_pictures(False)
    # On another stack: frames that such imports keep refer to those below, and these to the analysis.
    import_apart("matplotlib.figure")
    from ..coloring import colored
    from ..pictures.histogram import write_histograms
    from ..pictures.legend import sentence

    columns = [colored(analysis, name, appearance) for name in shows(appearance, analysis.chosen)]
    write_histograms(stream, analysis, columns, appearance.picture, appearance.value_range, suffix)
    return [sentence(column, appearance.value_range, analysis.conventions.unit) for column in columns]


for place, suffix in enumerate((".hist.png", ".hist.pdf", ".hist.svg")):
    register(
        DocumentFormat(
            suffix=suffix,
            kind="picture",
            description="histogram and area-weighted distribution of columns",
            place=20 + place,
            write=partial(write_as, suffix),
            shows=shows,
        )
    )
