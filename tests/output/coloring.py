"""The colours of one column, with the quantities that they are made from."""

from __future__ import annotations

from curvcli.api import Analysis
from curvcli.output import coloring
from curvcli.output.appearance import Appearance
from curvcli.output.coloring import color_needs
from curvcli.output.pictures.legend import Colored


def colored(analysis: Analysis, name: str) -> Colored:
    """The column with the colours that outputs give it."""
    analysis.include(color_needs(name, analysis.chosen))
    return coloring.colored(analysis, name, Appearance())
