"""Colour maps: one for signed and one for other columns, with a range robust against outliers."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import UsageError
from ...support.words import suggestion
from ..appearance import COMMON

DIVERGING, SEQUENTIAL, CATEGORICAL = "crameri:vik", "crameri:batlow", "tol:light"
CATEGORIES = 9
# An odd number, so that 0 in a symmetric range has the middle colour; every second one is a map's own of 256.
_STEPS = 511
# Colour of undefined values: mid grey, or a colour far from a map with greys.
_UNDEFINED = ((128, 128, 128), (255, 0, 255), (0, 255, 0))
_APART = 16
# Values that differ by less than this part of the largest are equal up to rounding.
_ALIKE = 16 * np.finfo(np.float64).eps


@dataclass(frozen=True)
class Category:
    """Label with its colour and the number of vertices that have it."""

    name: str
    color: tuple[int, int, int]
    count: int


@dataclass(frozen=True)
class ColorScale:
    """Colours of the vertices and the data of their legend.

    rgb: (V, 3) uint8. low, high: values at the ends of the map, None when no value is defined.
    gradient: (511, 3) uint8, the map from low to high. undefined: the colour of nulls, which is not in the map.
    clipped_below, clipped_above, nulls: numbers of values outside the range, or undefined.
    signed: true if 0 is the middle of the map. categories: the labels that occur, for a column without numbers.
    rounded: (V,) true for values other than 0 within their rounding, which have the colour of 0; None for none.
    """

    rgb: NDArray[np.uint8]
    low: float | None
    high: float | None
    cmap: str
    gradient: NDArray[np.uint8]
    undefined: tuple[int, int, int]
    clipped_below: int
    clipped_above: int
    nulls: int
    signed: bool = False
    categories: tuple[Category, ...] = ()
    rounded: NDArray[np.bool_] | None = None

    def settled(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values as coloured: rounding is 0, and a range of one value is that value up to its rounding."""
        if self.rounded is not None:
            values = np.where(self.rounded, 0.0, values)
        return values if self.low is None or self.high is None else _settled(values, self.low, self.high)


def colorize(
    values: NDArray[Any],
    *,
    cmap: str | None = None,
    value_range: str | None = None,
    signed: bool = False,
    ignore: NDArray[np.bool_] | None = None,
    floor: NDArray[np.float64] | None = None,
) -> ColorScale:
    """Colour one value per vertex; NaN and masked values get a colour that is not in the map.

    value_range: `LO:HI`, or `pNN` for the central NN % of the values (signed: symmetric about 0, the NN-th percentile
    of their size). Default: 2nd to 98th percentile; signed: symmetric about 0, the 98th percentile of their size.
    If only rounding lies between the percentiles, as of K of a finely divided cube, the range covers all values; values
    that differ by rounding only are one value.
    ignore: (V,) values that are left out of the choice of the range, unless there are no others.
    floor: (V,) sizes up to which values are rounding, and are coloured as 0; 0 where a value is exact.
    Errors: UsageError for an unknown map, with the nearest names, and for an invalid range.
    """
    values = _floats(values)
    rounded = None if floor is None else (np.abs(values) <= floor) & (floor > 0)
    if rounded is not None and rounded.any():
        values = np.where(rounded, 0.0, values)
    else:
        rounded = None
    name = cmap if cmap is not None else DIVERGING if signed else SEQUENTIAL
    gradient = color_map(name)
    undefined = _undefined(gradient)
    low, high = _range(values, value_range, signed, ignore)
    nulls = np.isnan(values)
    rgb = np.empty((len(values), 3), np.uint8)
    below = above = 0
    if low is not None and high is not None:
        values = _settled(values, low, high)
        rgb[:] = np.take(gradient, _positions(values, low, high), axis=0)
        below, above = int((values < low).sum()), int((values > high).sum())
    rgb[nulls] = undefined
    count = int(nulls.sum())
    return ColorScale(rgb, low, high, name, gradient, undefined, below, above, count, signed, rounded=rounded)


def _settled(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    """Values; in a range of a single value, those that differ from it by rounding only are equal to it."""
    if low != high:
        return values
    return np.where(np.abs(values - low) <= _ALIKE * abs(low), low, values)


def categorize(
    codes: NDArray[np.integer[Any]], names: tuple[str, ...], own: NDArray[np.uint8] | None = None
) -> ColorScale:
    """Colour labels, each with its own colour; beyond the colours of the map, colours repeat.

    codes: (V,) places in `names`, negative for none. own: (n, 3) colours of the names, instead of those of the map.
    """
    gradient = color_map(CATEGORICAL, CATEGORIES)
    undefined = _undefined(gradient)
    named = np.resize(gradient, (len(names), 3)) if own is None else own
    colors = np.concatenate([named, [undefined]]).astype(np.uint8)
    indices = np.where(codes < 0, len(names), codes)
    counts = np.bincount(indices, minlength=len(colors)).tolist()
    listed = zip(names, colors.tolist(), counts, strict=False)
    categories = tuple(Category(name, (rgb[0], rgb[1], rgb[2]), count) for name, rgb, count in listed if count)
    return ColorScale(
        np.take(colors, indices, axis=0),
        None,
        None,
        CATEGORICAL,
        gradient,
        undefined,
        0,
        0,
        counts[-1],
        categories=categories,
    )


def _positions(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.intp]:
    """Index of each value in the gradient; the middle where the range is a single value."""
    # Halves, because the width of a range may exceed the largest double.
    width = high / 2 - low / 2
    if width == 0:
        place = np.select([values < low, values > high], [0.0, 1.0], 0.5)
    else:
        place = (np.clip(values, low, high) / 2 - low / 2) / width
    steps: NDArray[np.intp] = np.nan_to_num(np.rint(place * (_STEPS - 1))).astype(np.intp)
    return steps


def _range(
    values: NDArray[np.float64], value_range: str | None, signed: bool, ignore: NDArray[np.bool_] | None
) -> tuple[float | None, float | None]:
    low, high, central = parse_range(value_range)
    if low is not None:
        return low, high
    defined = np.isfinite(values)
    chosen = defined if ignore is None else defined & ~ignore
    if not chosen.any():
        chosen = defined
    sample = values[chosen]
    if not len(sample):
        return None, None
    largest = float(np.abs(sample).max())
    # A power of two keeps the largest doubles within the range of the interpolation and changes no digit.
    scale = 0.25 if largest > 1e300 else 1.0
    alike = _ALIKE * largest
    if signed:
        size = float(np.percentile(np.abs(sample) * scale, 98.0 if central is None else central)) / scale
        size = size if size > alike else largest
        return 0.0 - size, size
    share = 96.0 if central is None else central
    first, last = (np.percentile(sample * scale, [50 - share / 2, 50 + share / 2]) / scale).tolist()
    if last / 2 - first / 2 > alike / 2:
        return first, last
    least, most = float(sample.min()), float(sample.max())
    if most / 2 - least / 2 > alike / 2:
        return least, most
    middle = float(np.median(sample * scale)) / scale
    return middle, middle


def _floats(values: NDArray[Any]) -> NDArray[np.float64]:
    """Values with NaN for masked ones."""
    if isinstance(values, np.ma.MaskedArray):
        return np.where(np.ma.getmaskarray(values), np.nan, np.ma.getdata(values)).astype(np.float64, copy=False)
    return values.astype(np.float64, copy=False)


def parse_range(value_range: str | None) -> tuple[float | None, float | None, float | None]:
    """Parse `--range`: (low, high, None) for LO:HI, (None, None, percent) for pNN, all None for the default."""
    if value_range is None:
        return None, None, None
    text = value_range.strip().removeprefix(f"{COMMON}:")
    if text == COMMON:
        raise UsageError("--range common: one range over the meshes of a batch; `curvcli batch` computes it")
    problem = f"--range {value_range}: expected LO:HI with LO < HI, as -1:1, or pNN with 0 < NN <= 100, as p95"
    try:
        if re.match("[pP]", text):
            percent = float(text[1:])
            if not 0 < percent <= 100:
                raise UsageError(problem)
            return None, None, percent
        low, high = map(float, text.split(":"))
    except ValueError:
        raise UsageError(problem) from None
    if not (np.isfinite([low, high]).all() and low < high):
        raise UsageError(problem)
    return low, high, None


@cache
def color_map(name: str, steps: int = _STEPS) -> NDArray[np.uint8]:
    """Colours of a map by its name in the `cmap` catalogue; a trailing `_r` reverses it."""
    from cmap import Catalog, Colormap

    catalog, stripped = Catalog(), name.strip()
    forward = stripped[:-2] if stripped.lower().endswith("_r") else stripped
    try:
        # The full name: for a short one that two collections share, cmap prints a warning on stderr.
        chosen = Colormap(catalog.resolve(forward))
    except KeyError:
        raise UsageError(f"--cmap {name}: no such colour map{suggestion(forward, catalog)}") from None
    colors = (chosen if forward == stripped else chosen.reversed()).lut(steps)
    gradient: NDArray[np.uint8] = np.rint(colors[:, :3] * 255).astype(np.uint8)
    gradient.flags.writeable = False
    return gradient


def _undefined(gradient: NDArray[np.uint8]) -> tuple[int, int, int]:
    for color in _UNDEFINED:
        if np.abs(gradient.astype(np.int16) - color).max(axis=1).min() >= _APART:
            return color
    return _UNDEFINED[0]
