"""Settings of estimators: scale (rings or radius), normals and noise."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from ..errors import UsageError
from ..support.words import pluralize

ScaleUnit = Literal["rings", "edges", "length"]

# Largest number of rings; beyond it a radius describes the same neighbourhood better.
MOST_RINGS = 100


@dataclass(frozen=True)
class Scale:
    """The size of the neighbourhood of a vertex.

    kind: `rings` of edges, a radius in mean `edges` of the mesh, or a radius as a `length` in the file's unit.
    Errors: UsageError for a size that is not positive, or rings that are no whole number.
    """

    kind: ScaleUnit
    size: float

    def __post_init__(self) -> None:
        known = math.isfinite(self.size) and self.size > 0
        if self.kind == "rings" and not (known and self.size == int(self.size) and self.size <= MOST_RINGS):
            raise UsageError(f"rings {self.size:g}: expected a whole number from 1 to {MOST_RINGS}")
        if not known:
            raise UsageError(f"radius {self.size:g}: expected a positive length or number of mean edge lengths")

    @property
    def name(self) -> str:
        """Suffix of columns at this scale: `3rings`, `2.5e` or `r0.1`; `parse` reads it back."""
        number = repr(int(self.size)) if self.size == int(self.size) and self.size < 1e15 else repr(self.size)
        return {"rings": f"{number}rings", "edges": f"{number}e", "length": f"r{number}"}[self.kind]

    def __str__(self) -> str:
        """The scale in words, for messages."""
        number = f"{self.size:g}"
        rings = pluralize(self.size, f"{number} [ring|rings]")
        edges = pluralize(self.size, f"radius of {number} mean edge [length|lengths]")
        return {"rings": rings, "edges": edges, "length": f"radius of {number}"}[self.kind]


def rings(count: int) -> Scale:
    """A scale of so many rings of edges."""
    return Scale("rings", count)


def parse_radius(text: str) -> Scale:
    """Parse a radius: `0.1` in the file's unit, `3e` in mean edge lengths.

    Errors: UsageError.
    """
    text = text.strip()
    number, kind = (text[:-1], "edges") if text[-1:] in ("e", "E") else (text, "length")
    try:
        size = float(number)
    except ValueError:
        size = math.nan
    if not (math.isfinite(size) and size > 0):
        raise UsageError(f"radius {text!r}: expected a positive length, or mean edge lengths such as 3e")
    return Scale("edges" if kind == "edges" else "length", size)


def parse_scales(
    ring_counts: str | int | Iterable[str | int] | None, radii: str | float | Iterable[str | float] | None
) -> tuple[Scale, ...]:
    """Parse lists, or texts with commas, of ring counts and radii into scales, in that order and without repeats.

    Errors: UsageError.
    """
    result = [rings(_count(text)) for text in _entries(ring_counts)]
    result += [parse_radius(text) for text in _entries(radii)]
    return tuple(dict.fromkeys(result))


def describe_scales(names: str) -> str:
    """Describe a comma list of names of scales, for messages."""
    given = options_of(names)
    return ", ".join(str(scale) for scale in parse_scales(given["rings"], given["radius"]))


def options_of(names: str) -> dict[str, str | None]:
    """The options `rings` and `radius` for a comma list of names of scales."""
    each = [name.strip() for name in names.split(",")]
    counts = [name.removesuffix("rings") for name in each if name.endswith("rings")]
    radii = [name.removeprefix("r") for name in each if not name.endswith("rings")]
    return {"rings": ",".join(counts) or None, "radius": ",".join(radii) or None}


def _entries(value: str | float | Iterable[str | float] | None) -> Iterable[str]:
    if value is None:
        return ()
    return map(str, value) if isinstance(value, Iterable) and not isinstance(value, str) else str(value).split(",")


def _count(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise UsageError(f"rings {text.strip()!r}: expected a whole number from 1 to {MOST_RINGS}") from None


# The default scale.
DEFAULT_SCALE = rings(2)


@dataclass(frozen=True)
class EstimatorSettings:
    """Values of the parameters of passes that are no quantities: `scale`, `normals`, `noise`.

    scales: each gives one column per estimator. normals: of the `mesh`, or those of the `file`.
    noise: standard deviation of each coordinate in the file's unit; None is the precision of the file.
    values: of the parameters that passes have of their own, by PASS.NAME; an array has one for each face.
    Errors: UsageError for a noise that is negative or no number.
    """

    scales: tuple[Scale, ...] = (DEFAULT_SCALE,)
    normals: Literal["mesh", "file"] = "mesh"
    noise: float | None = None
    values: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.noise is not None and not (math.isfinite(self.noise) and self.noise >= 0):
            raise UsageError(f"a noise of {self.noise:g}: expected the standard deviation of a coordinate, 0 or more")

    @property
    def scale(self) -> Scale:
        """The one scale, or the first of several."""
        return self.scales[0]


DEFAULTS = EstimatorSettings()

# Parameters of passes that `EstimatorSettings` provides.
PARAMETERS = ("scale", "normals", "noise")
