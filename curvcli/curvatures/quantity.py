"""Quantity: the declaration of one column, and the protocols of passes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

from ..mesh.scale import PARAMETERS
from .setting import Setting

Element = Literal["vertex", "edge", "face"]
QuantityKind = Literal["measure", "density", "angle", "length", "direction", "ratio", "count", "label", "flag"]
Parity = Literal["even", "odd"]

# Parameters that are no quantity: the surface, its masks of vertices, and the area chosen by `--area`.
SURFACE, MASKS, CELL_AREA = "surface", ("interior", "boundary", "referenced", "without_orientation"), "cell_area"
# `EstimatorSettings` provides the others; a quantity at one of several scales is named `NAME@SCALE`.
NO_QUANTITIES = (SURFACE, *MASKS, *PARAMETERS)
AT_SCALE = "@"
CELL_AREAS = {"barycentric": "A", "mixed": "A_mixed", "voronoi": "A_voronoi"}


@dataclass(frozen=True)
class FlagNotice:
    """The notice of the elements that a hidden flag marks.

    code: stable, for programs. message, hint: `[one|many]` in them follows the number of elements, and `{scale}` is the
    scale of the flag in brackets where there are several. after: the code of the notice before it among those of flags.
    select: indices of the elements from the surface and the columns; by default all that the flag marks.
    """

    code: str
    message: str
    hint: str
    after: str | None = None
    select: Callable[[Any, Any], Any] | None = None


@dataclass(frozen=True)
class Quantity:
    """Declaration of one column.

    name: of the column. symbol, formula, preserves, boundary, source: for people. on: its element.
    kind: `measure` is integrated, `density` is per area or pointwise. length_exponent: how it scales with length.
    mean_degree: 0, 1 or 2, how it scales with the convention for H. parity: under reversal of the orientation; what is
    odd is null on patches that have none. vector: (3, n). public: whether it is a column of the table.
    total: the key of its sum in the report. signed: whether 0 is the middle of its range. labels: what codes stand for.
    column: its name in the table of its element where that is not its own, which is unique among all elements.
    partner: the quantity it changes places with under reversal, as the larger curvature does with the smaller.
    line: a direction without a sign, ±d are the same. rooted: a root of a difference, of which rounding takes half of
    the digits; None is rooted where something it needs is. energy: a multiple of the bending rigidity κ, which
    `--bending-rigidity` turns into k_BT or J. after: the column that it follows in the table of its element, "" for the
    first; None comes last. total_after: the total that its total follows in the report. notice: of a hidden flag.
    """

    name: str
    symbol: str = ""
    formula: str = ""
    on: Element = "vertex"
    kind: QuantityKind = "measure"
    length_exponent: int = 0
    mean_degree: int = 0
    parity: Parity = "even"
    preserves: str = ""
    boundary: str = ""
    source: str = ""
    vector: bool = False
    public: bool = True
    total: str | None = None
    signed: bool = False
    labels: tuple[str, ...] = ()
    description: str = ""
    column: str = ""
    partner: str = ""
    line: bool = False
    rooted: bool | None = None
    energy: bool = False
    after: str | None = None
    total_after: str | None = None
    notice: FlagNotice | None = None

    @property
    def stem(self) -> str:
        """Its name in the table of its element."""
        return self.column or self.name

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its scalar columns: three for a vector."""
        return tuple(f"{self.stem}_{axis}" for axis in "xyz") if self.vector else (self.stem,)

    def unit(self, length: str | None, energy: str | None = None) -> str:
        """Its unit in terms of the units of length and of energy, `1` for a pure number."""
        if self.energy:
            return energy or "κ"
        exponent = self.length_exponent
        base = length or "length"
        return "1" if exponent == 0 else base if exponent == 1 else f"{base}^{exponent}"


class Configurable(Protocol):
    """Protocol of an object that settings configure by its name."""

    @property
    def name(self) -> str: ...
    @property
    def settings(self) -> tuple[Setting, ...]: ...


class Step(Configurable, Protocol):
    """Protocol of a pass for the engine; `registry.Pass` describes the members."""

    @property
    def compute(self) -> Callable[..., Any]: ...
    @property
    def provides(self) -> tuple[Quantity, ...]: ...
    @property
    def needs(self) -> tuple[str, ...]: ...
    @property
    def pointwise(self) -> bool: ...
    @property
    def of_faces(self) -> Callable[..., tuple[Any, Any]] | None: ...


class Provider(Protocol):
    """Protocol of a registry of passes, see `registry.Registry`."""

    def provider(self, quantity: str) -> Step: ...
    def depends_on_scale(self, name: str) -> bool: ...
    def looks_around(self, name: str) -> bool: ...
