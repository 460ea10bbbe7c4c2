"""Triangles of regular parameter domains: tables of vertex numbers and disks of rings."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .model import FloatArray, IntArray, demand

Integers = NDArray[np.signedinteger]


def split(size: int, ratio: float, *, least: int = 3) -> tuple[int, int]:
    """Rows and columns with about `size` crossings and rows/columns about `ratio`, neither below `least`."""
    columns = max(least, round(math.sqrt(max(size, 1) / ratio)))
    rows = max(least, round(size / columns))
    return rows, max(least, round(size / rows))


def table(rows: int, columns: int) -> IntArray:
    """Vertex numbers 0, 1, ... row by row: (rows, columns)."""
    return np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)


def looped(numbers: IntArray, axis: int) -> IntArray:
    """The table with its first row (axis 0) or column (axis 1) repeated at the end, which closes the surface up."""
    return np.concatenate([numbers, np.take(numbers, [0], axis=axis)], axis=axis)


def triangles(numbers: IntArray) -> IntArray:
    """Two triangles for each square of a table of vertex numbers; where a square has shrunk to a triangle, one.

    The normal of (i, j), (i + 1, j), (i + 1, j + 1) is along (d/drow) x (d/dcolumn).
    """
    a, b, c, d = numbers[:-1, :-1], numbers[1:, :-1], numbers[1:, 1:], numbers[:-1, 1:]
    faces = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], axis=-2).reshape(-1, 3)
    first, second, third = faces.T
    whole = (first != second) & (second != third) & (third != first)
    return np.ascontiguousarray(faces[whole], np.int32)


def closed_grid(rows: int, columns: int) -> IntArray:
    """Faces of a grid that closes up in both directions."""
    return triangles(looped(looped(table(rows, columns), 0), 1))


def shaken(count: int, jitter: float, seed: int) -> FloatArray:
    """Random shifts (count, 2), uniform in [-jitter, jitter], in steps of a grid; below 1/2 no two vertices pass."""
    demand(0 <= jitter < 0.5, f"jitter must be at least 0 and below 0.5, not {jitter!r}")
    demand(seed >= 0, f"seed must not be negative, not {seed!r}")
    return np.random.default_rng(seed).uniform(-jitter, jitter, (count, 2))


def revolve(radius: FloatArray, height: FloatArray, columns: int) -> tuple[FloatArray, IntArray, IntArray]:
    """A profile (radius, height), upwards, turned about the z axis; an end of radius zero is one vertex, a pole.

    Returns points, faces (normal away from the axis) and the place in the profile that each vertex stands on.
    """
    sides = np.where(radius > 0, columns, 1)
    row = np.repeat(np.arange(len(radius)), sides)
    start = np.cumsum(sides) - sides
    numbers = start[:, None] + np.where(radius[:, None] > 0, np.arange(columns), 0)
    phi = 2 * np.pi * (np.arange(len(row)) - start[row]) / columns
    points = np.stack([radius[row] * np.cos(phi), radius[row] * np.sin(phi), height[row]], axis=1)
    return points, triangles(looped(numbers.astype(np.int32), 1).T), row.astype(np.int32)


def rings_for(size: int, *, least: int = 2) -> int:
    """Number n of rings that give a disk of about `size` = 1 + 3 n (n + 1) vertices."""
    return max(least, round(math.sqrt(max(size, 1) / 3) - 0.5))


def disk(rings: int) -> tuple[FloatArray, FloatArray, IntArray]:
    """A disk of nearly equilateral triangles: a centre and rings k = 1, 2, ... of 6 k vertices.

    Returns the polar coordinates rho = k / rings and phi of each vertex, and the faces, counterclockwise.
    """
    ring = np.repeat(np.arange(rings + 1), np.maximum(6 * np.arange(rings + 1), 1))
    place = np.arange(len(ring)) - _ring_start(ring)
    phi = 2 * np.pi * place / np.maximum(6 * ring, 1)
    # Outward pointing triangles stand on each edge of ring k; inward pointing ones hang on each edge of ring k - 1.
    k, t = ring[1:], place[1:]
    sector, step = t // k, t % k
    below = _on_ring(k - 1, sector * (k - 1) + step)
    here, ahead = _on_ring(k, t), _on_ring(k, t + 1)
    standing = np.stack([below, here, ahead], axis=1)
    hangs = step < k - 1
    beside = _on_ring(k - 1, sector * (k - 1) + step + 1)
    hanging = np.stack([below, ahead, beside], axis=1)[hangs]
    return ring / rings, phi, np.concatenate([standing, hanging]).astype(np.int32)


def _ring_start(ring: Integers) -> Integers:
    """Index of the first vertex of ring k of a disk."""
    return np.asarray(np.where(ring > 0, 1 + 3 * ring * (ring - 1), 0))


def _on_ring(ring: Integers, place: Integers) -> Integers:
    return np.asarray(_ring_start(ring) + place % np.maximum(6 * ring, 1))
