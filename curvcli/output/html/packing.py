"""Arrays as text in a page: float32 or integers, little-endian, in planes of bytes, deflated, base64."""

from __future__ import annotations

import base64
import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

# Beyond these float32 has no number, or not all its digits.
_LARGEST, _SMALLEST = 1e37, 1e-30
# An offset is taken out of values whose spread is this many times smaller: float32 would keep too little of it.
_OFFSET = 64.0


class Scaled(NamedTuple):
    """Numbers as base + 2**exponent · values; base and exponent are 0 where float32 alone is as good."""

    values: NDArray[np.float32]
    base: float
    exponent: int


def scaled(numbers: NDArray[np.float64]) -> Scaled:
    """Numbers for a page to the precision of float32, at any scale and at any offset; NaN stays."""
    known = numbers[~np.isnan(numbers)]
    if not len(known):
        return Scaled(numbers.astype(np.float32), 0.0, 0)
    low, high = float(known.min()), float(known.max())
    size, half = max(abs(low), abs(high)), high / 2 - low / 2
    base = low / 2 + high / 2 if 0 < half < size / (2 * _OFFSET) else 0.0
    rest = numbers - base
    size = max(abs(low - base), abs(high - base))
    exponent = 0 if size == 0 or _SMALLEST < size < _LARGEST else int(np.frexp(size)[1])
    return Scaled(np.ldexp(rest, -exponent).astype(np.float32), base, exponent)


def packed(array: NDArray[Any]) -> str:
    """An array as text: component after component, each as planes of bytes, which deflate better than mixed ones."""
    flat = np.ascontiguousarray(array.T).ravel()
    little = flat.astype(flat.dtype.newbyteorder("<"), copy=False)
    planes = little.view(np.uint8).reshape(-1, flat.dtype.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 1)).decode("ascii")


def differences(ascending: NDArray[np.integer[Any]]) -> NDArray[np.uint32]:
    """An ascending list as its first number and the steps."""
    return np.diff(ascending, prepend=0).astype(np.uint32)


def steps(indices: NDArray[np.integer[Any]]) -> NDArray[np.uint32]:
    """(n, k) indices as differences, of each row's first to the last row's first, of the others to the one before.

    Small ones of either sign become small numbers: 0, −1, 1, −2, … are 0, 1, 2, 3, …
    """
    wide = indices.astype(np.int64)
    delta = np.diff(wide, axis=1, prepend=0)
    delta[:, 0] = np.diff(wide[:, 0], prepend=0)
    return np.where(delta < 0, -2 * delta - 1, 2 * delta).astype(np.uint32)
