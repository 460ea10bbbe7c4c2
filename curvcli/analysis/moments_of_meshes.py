"""Means and variances of columns at every vertex over meshes that share their faces, one mesh at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..support.arrays import Floats, Ints


class VertexMoments:
    """Running count, mean and sum of squared deviations at each vertex (Welford), and the extremes.

    Memory does not grow with the number of meshes. NaN is left out and counted.
    """

    def __init__(self, names: Sequence[str], vertices: int) -> None:
        self.meshes = 0
        self.positions = np.zeros((vertices, 3))
        self.count: dict[str, Ints] = {name: np.zeros(vertices, np.int64) for name in names}
        self.mean: dict[str, Floats] = {name: np.zeros(vertices) for name in names}
        self.squares: dict[str, Floats] = {name: np.zeros(vertices) for name in names}
        self.low: dict[str, Floats] = {name: np.full(vertices, np.inf) for name in names}
        self.high: dict[str, Floats] = {name: np.full(vertices, -np.inf) for name in names}

    def add(self, positions: Floats, columns: Mapping[str, Floats]) -> None:
        """Count one mesh. positions: (V, 3). columns: (V,) each."""
        self.meshes += 1
        self.positions += (positions - self.positions) / self.meshes
        for name, values in columns.items():
            known = np.isfinite(values)
            count = self.count[name]
            count += known
            change = np.where(known, values - self.mean[name], 0.0)
            self.mean[name] += change / np.maximum(count, 1)
            self.squares[name] += np.where(known, change * (values - self.mean[name]), 0.0)
            np.fmin(self.low[name], values, out=self.low[name])
            np.fmax(self.high[name], values, out=self.high[name])

    def mean_of(self, name: str) -> Floats:
        """(V,) means, NaN where no mesh has a value."""
        return np.where(self.count[name] > 0, self.mean[name], np.nan)

    def deviation_of(self, name: str) -> Floats:
        """(V,) standard deviations of the sample, NaN below two values."""
        with np.errstate(divide="ignore", invalid="ignore"):
            variance = np.maximum(self.squares[name], 0.0) / (self.count[name] - 1)
        return np.where(self.count[name] > 1, np.sqrt(variance), np.nan)
