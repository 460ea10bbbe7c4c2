"""Legend texts of a column: its unit, the ends of its range, and the values beyond them."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...curvatures.quantity import Quantity
from ...curvatures.registry import passes
from ...support.words import counted, format_exponent, typeset_number
from ..appearance import COMMON
from .colors import ColorScale, parse_range

if TYPE_CHECKING:
    from ...analysis.result import Result

_BOLD = str.maketrans("", "", "*")


@dataclass(frozen=True)
class Colored:
    """Column with its colours, for one panel of a picture; energy: the unit of energies, None for κ."""

    name: str
    quantity: Quantity
    scale: ColorScale
    energy: str | None = None

    def unit(self, length: str | None) -> str:
        """Unit with raised exponents, empty for a pure number or labels."""
        if self.quantity.energy:
            return self.quantity.unit(length, self.energy)
        exponent = self.quantity.length_exponent
        if exponent == 0:
            return ""
        return (length or "length") + ("" if exponent == 1 else format_exponent(exponent))

    @property
    def symbol(self) -> str:
        """Symbol, empty if it equals the name."""
        symbol = self.quantity.symbol.translate(_BOLD)
        if self.quantity.vector:
            symbol = f"{self.name[-1]} of {symbol}"
        return "" if symbol == self.name else symbol


def range_words(value_range: str | None, signed: bool) -> str:
    """Rule that chose the ends of a colour map."""
    low, _, central = parse_range(value_range)
    if low is not None:
        return "common to all meshes" if value_range and value_range.startswith(COMMON) else "range as asked"
    if signed:
        return f"p{98 if central is None else central:g} of |values|"
    share = 96 if central is None else central
    return f"p{50 - share / 2:02g} to p{50 + share / 2:02g}"


def range_text(scale: ColorScale, value_range: str | None, unit: str = "") -> str:
    """Range of a column's colours, the rule that chose it, and the number of values outside it."""
    if scale.low is None or scale.high is None:
        return "undefined at every vertex"
    behind = f" {unit}" if unit else ""
    clipped = ((scale.clipped_below, "below"), (scale.clipped_above, "above"))
    cut = [f"{count:,} {where}" for count, where in clipped if count]
    if scale.low == scale.high and not cut:
        of = " within rounding" if scale.rounded is not None else ""
        return f"{typeset_number(scale.low)}{behind}{of} wherever defined"
    digits = next((d for d in range(4, 17) if typeset_number(scale.low, d) != typeset_number(scale.high, d)), 17)
    ends = f"{typeset_number(scale.low, digits)} to {typeset_number(scale.high, digits)}{behind}"
    # Percentiles cut off values, unless the values differ by rounding only: then the range has all of them.
    rule = range_words(value_range, scale.signed) if cut or value_range is not None else "all values"
    settled = "" if scale.rounded is None else f", {int(scale.rounded.sum()):,} are 0 within rounding"
    return f"{ends} ({rule}), cuts {' and '.join(cut) or 'nothing'}{settled}"


def sentence(colored: Colored, value_range: str | None, length: str | None) -> str:
    """One line for the terminal: the range of a column, the rule that chose it, and the values outside it."""
    scale = colored.scale
    if scale.categories:
        return f"{colored.name}: " + ", ".join(f"{category.count:,} {category.name}" for category in scale.categories)
    undefined = f"; {scale.nulls:,} undefined" if scale.nulls and scale.low is not None else ""
    return f"{colored.name}: {range_text(scale, value_range, colored.unit(length))}{undefined}"


def mesh_name(analysis: Result) -> str:
    """Name of the mesh's file without its folder."""
    file = analysis.surface.file
    return os.path.basename(file.path) if file is not None and file.path not in (None, "-") else "mesh"


def about(analysis: Result, quantities: Sequence[Quantity]) -> list[str]:
    """Mesh, and conventions that the columns shown depend on."""
    surface = analysis.surface
    vertices = counted(int(surface.referenced.sum()), "vertex", "vertices")
    shape = f"{mesh_name(analysis)}: {vertices}, {counted(surface.n_faces, 'face')}"
    return [shape, *conventions(analysis, quantities)]


def conventions(analysis: Result, quantities: Sequence[Quantity]) -> list[str]:
    """Conventions that the columns shown depend on; labels of regions depend on none."""
    chosen = analysis.conventions
    choices = []
    quantities = [quantity for quantity in quantities if quantity.kind != "label"]
    if any(quantity.mean_degree for quantity in quantities):
        choices.append("H = κ₁ + κ₂" if chosen.mean == "sum" else "H = (κ₁ + κ₂)/2")
    if any(quantity.signed and quantity.mean_degree for quantity in quantities):
        choices[-1] += ", positive where convex"
    if any(analysis.depends_on_area(quantity.name) for quantity in quantities):
        choices.append(f"area {chosen.area}")
    if chosen.settings is not None and any(passes.provider(quantity.name).settings for quantity in quantities):
        choices.append(chosen.settings)
    if chosen.weld != "none":
        choices.append(f"weld {chosen.weld}")
    return choices


def ticks(low: float, high: float, room: int, whole: bool = False) -> tuple[list[float], list[str], int]:
    """Positions and labels of about `room` ticks from low to high, in units of 10 to the power that comes third.

    whole: only at whole numbers, written in full.
    """
    from matplotlib.ticker import MaxNLocator

    size = max(abs(low), abs(high))
    if low == high:
        return [low], [typeset_number(low, 6)], 0
    if high / 2 - low / 2 < 1e-4 * size and not whole:
        return [low, high], [typeset_number(low, 6), f"+{typeset_number(high - low, 2)}"], 0
    power = 0 if whole or 1e-2 <= size < 1e4 else max(-300, 3 * math.floor(math.log10(size) / 3))
    first, last = low / 10.0**power, high / 10.0**power
    locator = MaxNLocator(room, steps=[1, 2, 2.5, 5, 10], integer=whole)
    steps = [float(place) for place in locator.tick_values(first, last)]
    step = steps[1] - steps[0]
    digits = next(d for d in range(20) if d == 19 or abs(round(step, d) - step) < 1e-9 * step)
    slack = 1e-9 * step
    positions = [round(place, digits) + 0.0 for place in steps if first - slack <= place <= last + slack]
    labels = [f"{place:.{digits}f}".replace("-", "−") for place in positions]
    return [place * 10.0**power for place in positions], labels, power
