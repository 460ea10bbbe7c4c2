"""Pictures of the coloured surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance


def shows(appearance: Appearance, chosen: list[str]) -> tuple[str, ...]:
    """The columns asked for, or the first of those that colour a mesh."""
    from ..coloring import COLOR_BY

    return appearance.color_by or tuple(name for name in (*COLOR_BY, "status") if name in chosen)[:1]


def write(stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Draw the surface; a line for each column, with its range."""
    from ..pictures.options import import_apart, require_pictures

    require_pictures()
    # On another stack: frames that such imports keep refer to those below, and these to the analysis.
    import_apart("matplotlib.figure", "pyvista.plotting")
    from ..coloring import colored
    from ..pictures.legend import sentence
    from ..pictures.picture import write_picture

    columns = [colored(analysis, name, appearance) for name in shows(appearance, analysis.chosen)]
    write_picture(stream, analysis, columns, appearance.picture, appearance.value_range)
    return [sentence(one, appearance.value_range, analysis.conventions.unit) for one in columns]


register(
    DocumentFormat(
        suffix=".png",
        kind="picture",
        description="picture of the coloured surface",
        place=1,
        write=write,
        shows=shows,
        edges=True,
        camera=True,
    )
)
