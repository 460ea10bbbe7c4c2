"""Pages with the report and a 3D view of the surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from ..appearance import REGION
from ..registry import DocumentFormat, register

if TYPE_CHECKING:
    from ...analysis.result import Result
    from ..appearance import Appearance


def shows(appearance: Appearance, chosen: list[str]) -> list[str]:
    """All numbers, and the columns asked for."""
    from ..distributions import vertex_quantities

    numbers = [name for name, quantity in vertex_quantities(chosen).items() if not quantity.labels]
    return [*numbers, *appearance.color_by]


def write(stream: BinaryIO, analysis: Result, appearance: Appearance, command: str | None) -> list[str]:
    """Write one file without references."""
    from ..coloring import COLOR_BY
    from ..html.page import page

    first = (
        tuple(name for name in appearance.color_by if name != REGION)
        or tuple(name for name in COLOR_BY if name in analysis.chosen)[:1]
    )
    stream.write(page(analysis, appearance, first, command))
    return []


register(
    DocumentFormat(
        suffix=".html",
        kind="page",
        description="report as one page with a 3D view of the surface, HTML",
        place=1,
        write=write,
        shows=shows,
        edges=True,
    )
)
