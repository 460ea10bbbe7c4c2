"""Pictures of the coloured surface: pixels, or a page on which texts and lines stay texts and lines."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, BinaryIO

from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance


def shows(appearance: Appearance, chosen: list[str]) -> tuple[str, ...]:
    """The columns asked for, or the first of those that colour a mesh."""
    from ..coloring import COLOR_BY

    return appearance.color_by or tuple(name for name in (*COLOR_BY, "status") if name in chosen)[:1]


def write_as(suffix: str, stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Draw the surface; a line for each column, with its range."""
    from ..pictures.options import import_apart, require_pictures

    require_pictures()
    # On another stack: frames that such imports keep refer to those below, and these to the analysis.
    import_apart("matplotlib.figure", "pyvista.plotting")
    from ..coloring import colored
    from ..pictures.legend import sentence
    from ..pictures.picture import write_picture

    columns = [colored(analysis, name, appearance) for name in shows(appearance, analysis.chosen)]
    write_picture(stream, analysis, columns, appearance.picture, appearance.range_rule, suffix)
    return [sentence(column, appearance.range_rule, analysis.conventions.unit) for column in columns]


for place, suffix in enumerate((".png", ".pdf", ".svg")):
    page = suffix != ".png"
    register(
        DocumentFormat(
            suffix=suffix,
            kind="picture",
            description="picture of the coloured surface" + (", with text and lines as such" if page else ""),
            place=10 + place,
            write=partial(write_as, suffix),
            shows=shows,
            edges=True,
            camera=True,
            page=page,
        )
    )
