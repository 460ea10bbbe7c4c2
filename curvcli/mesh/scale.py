"""What estimators are told beside the surface: at which scale they look, whose normals and which noise they assume."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from ..errors import UsageError
from ..support.words import pluralize

Kind = Literal["rings", "edges", "length"]

# Beyond this many rings neighbourhoods are counted in edges more than in detail; a radius says the same better.
MOST_RINGS = 100


@dataclass(frozen=True)
class Scale:
    """How far the neighbourhood of a vertex reaches.

    kind: `rings` of edges, a radius in mean `edges` of the mesh, or a radius as a `length` in the file's unit.
    Errors: UsageError for a size that is not positive, or rings that are no whole number.
    """

    kind: Kind
    size: float

    def __post_init__(self) -> None:
        known = math.isfinite(self.size) and self.size > 0
        if self.kind == "rings" and not (known and self.size == int(self.size) and self.size <= MOST_RINGS):
            raise UsageError(f"rings {self.size:g}: expected a whole number from 1 to {MOST_RINGS}")
        if not known:
            raise UsageError(f"radius {self.size:g}: expected a positive length or number of mean edge lengths")

    @property
    def name(self) -> str:
        """What columns at this scale are called after it: `3rings`, `2.5e` or `r0.1`; `parse` reads it back."""
        number = repr(int(self.size)) if self.size == int(self.size) and self.size < 1e15 else repr(self.size)
        return {"rings": f"{number}rings", "edges": f"{number}e", "length": f"r{number}"}[self.kind]

    def __str__(self) -> str:
        """For people."""
        number = f"{self.size:g}"
        rings = pluralize(self.size, f"{number} [ring|rings]")
        edges = pluralize(self.size, f"radius of {number} mean edge [length|lengths]")
        return {"rings": rings, "edges": edges, "length": f"radius of {number}"}[self.kind]


def rings(count: int) -> Scale:
    """All that is reached over so many edges."""
    return Scale("rings", count)


def parse_radius(text: str) -> Scale:
    """A radius as written by the user: `0.1` in the file's unit, `3e` in mean edge lengths.

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
    """The scales of lists, or of texts with commas, of ring counts and of radii, in that order and without repeats.

    Errors: UsageError.
    """
    found = [rings(_count(text)) for text in _entries(ring_counts)]
    found += [parse_radius(text) for text in _entries(radii)]
    return tuple(dict.fromkeys(found))


def describe_scales(names: str) -> str:
    """A comma list of the names of scales, for people."""
    given = options_of(names)
    return ", ".join(str(scale) for scale in parse_scales(given["rings"], given["radius"]))


def options_of(names: str) -> dict[str, str | None]:
    """The options `rings` and `radius` that give the scales of a comma list of their names."""
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


# Where none is asked for.
DEFAULT_SCALE = rings(2)


@dataclass(frozen=True)
class Settings:
    """What passes may ask for by a parameter that is no quantity: `scale`, `normals`, `noise`.

    scales: each gives one column per estimator. normals: of the `mesh`, or those of the `file`.
    noise: standard deviation of each coordinate in the file's unit; None is the precision of the file.
    Errors: UsageError for a noise that is negative or no number.
    """

    scales: tuple[Scale, ...] = (DEFAULT_SCALE,)
    normals: Literal["mesh", "file"] = "mesh"
    noise: float | None = None

    def __post_init__(self) -> None:
        if self.noise is not None and not (math.isfinite(self.noise) and self.noise >= 0):
            raise UsageError(f"a noise of {self.noise:g}: expected the standard deviation of a coordinate, 0 or more")

    @property
    def scale(self) -> Scale:
        """The one scale, or the first of several."""
        return self.scales[0]


DEFAULTS = Settings()

# Parameters of passes that `Settings` answers.
PARAMETERS = ("scale", "normals", "noise")
