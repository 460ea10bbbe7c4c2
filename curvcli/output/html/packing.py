"""Arrays as text in a page: float32 or integers, little-endian, in planes of bytes, deflated, base64."""

from __future__ import annotations

import base64
import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

# Limits of float32: larger numbers overflow, smaller ones lose digits.
_LARGEST, _SMALLEST = 1e37, 1e-30
# If the spread of values is this many times smaller than their size, float32 has too few digits to separate them.
_NARROW = 256.0


class Scaled(NamedTuple):
    """Numbers as 2**exponent · (values + rest): values alone are the numbers to float32.

    The exponent is 0 within the range of float32; the rest is None if the values separate the numbers.
    """

    values: NDArray[np.float32]
    rest: NDArray[np.float32] | None
    exponent: int

    @property
    def columns(self) -> NDArray[np.float32]:
        """(n,) or (n, 2) values, with the rest if there is one."""
        return self.values if self.rest is None else np.stack([self.values, self.rest], axis=1)


def scaled(numbers: NDArray[np.float64]) -> Scaled:
    """Numbers for a page to the precision of float32, at any scale; NaN stays."""
    known = numbers[~np.isnan(numbers)]
    if not len(known):
        return Scaled(numbers.astype(np.float32), None, 0)
    low, high = float(known.min()), float(known.max())
    size = max(abs(low), abs(high))
    exponent = 0 if size == 0 or _SMALLEST < size < _LARGEST else int(np.frexp(size)[1]) - 1
    mantissas = np.ldexp(numbers, -exponent) if exponent else numbers
    values = mantissas.astype(np.float32)
    narrow = 0 < high / 2 - low / 2 < size / (2 * _NARROW)
    return Scaled(values, (mantissas - values).astype(np.float32) if narrow else None, exponent)


def packed(array: NDArray[Any]) -> str:
    """Array as text: component after component, each as planes of bytes, which deflate better than mixed ones."""
    flat = np.ascontiguousarray(array.T).ravel()
    little = flat.astype(flat.dtype.newbyteorder("<"), copy=False)
    planes = little.view(np.uint8).reshape(-1, flat.dtype.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 1)).decode("ascii")


def differences(ascending: NDArray[np.integer[Any]]) -> NDArray[np.uint32]:
    """Ascending list as its first number and the steps."""
    return np.diff(ascending, prepend=0).astype(np.uint32)


def steps(indices: NDArray[np.integer[Any]]) -> NDArray[np.uint32]:
    """(n, k) indices as differences: each row's first from the last row's first, the others from the one before.

    Small ones of either sign become small numbers: 0, −1, 1, −2, … are 0, 1, 2, 3, …
    """
    wide = indices.astype(np.int64)
    delta = np.diff(wide, axis=1, prepend=0)
    delta[:, 0] = np.diff(wide[:, 0], prepend=0)
    return np.where(delta < 0, -2 * delta - 1, 2 * delta).astype(np.uint32)
