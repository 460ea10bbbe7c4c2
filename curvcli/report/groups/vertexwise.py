"""Vertex-wise comparison of two groups of meshes that share their faces: Welch's t and false discovery rates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec
import numpy as np

from ..._version import __version__
from ...analysis.configuration import Configured
from ...analysis.moments_of_meshes import VertexMoments
from ...support.arrays import Floats, or_none
from .means import Correction, adjusted

# Columns of the map for each column of the meshes, behind its name.
PARTS = ("mean_a", "mean_b", "difference", "t", "p", "q", "n_a", "n_b")


class VertexwiseColumn(msgspec.Struct):
    """One column over all vertices: how many are tested and significant, and the vertex of the largest |t|."""

    column: str
    tested: int
    significant: int
    t_max: float | None
    vertex: int | None


class VertexwiseReport(msgspec.Struct):
    """The report of `curvcli compare --vertexwise`; difference: B − A; significant: q is at most alpha."""

    schema_version: int
    curvcli: str
    path_a: str
    path_b: str
    meshes_a: list[str]
    meshes_b: list[str]
    alpha: float
    correction: str
    vertices: int
    vertexwise: list[VertexwiseColumn]
    configuration: Configured = msgspec.UNSET


def vertex_map(
    a: VertexMoments, b: VertexMoments, bounds: Mapping[str, float], correction: Correction
) -> dict[str, Floats]:
    """(V,) mean of either group, difference B − A, Welch's t, its p and q, and the numbers of values, for each column.

    bounds: of the rounding of each column; a vertex whose values differ by less has neither t nor p, and so has one
    with fewer than two values in a group. q corrects for the number of vertices that are tested.
    """
    from scipy.stats import ttest_ind_from_stats

    columns: dict[str, Floats] = {}
    for name, bound in bounds.items():
        mean = [side.mean_of(name) for side in (a, b)]
        deviation = [side.deviation_of(name) for side in (a, b)]
        low, high = np.fmin(a.low[name], b.low[name]), np.fmax(a.high[name], b.high[name])
        size = np.fmax(np.abs(low), np.abs(high))
        with np.errstate(invalid="ignore", divide="ignore"):
            varies = high / 2 - low / 2 > bound + 256 * np.finfo(np.float64).eps * size
            tested = varies & (deviation[0] + deviation[1] > 0)
            t, p = ttest_ind_from_stats(
                mean[1], deviation[1], b.count[name], mean[0], deviation[0], a.count[name], equal_var=False
            )
        t, p = (np.where(tested, values, np.nan) for values in (t, p))
        statistics = (*mean, mean[1] - mean[0], t, p, adjusted(p, correction), a.count[name], b.count[name])
        columns |= {
            f"{name}_{statistic}": np.asarray(values, np.float64)
            for statistic, values in zip(PARTS, statistics, strict=True)
        }
    return columns


def build(
    sides: tuple[tuple[str, list[str]], tuple[str, list[str]]],
    columns: Mapping[str, Floats],
    alpha: float,
    correction: str,
) -> VertexwiseReport:
    """The report of a map. sides: source and meshes of either group."""
    names = [key.removesuffix("_t") for key in columns if key.endswith("_t")]
    summaries = []
    for name in names:
        t, q = columns[f"{name}_t"], columns[f"{name}_q"]
        known = np.isfinite(t)
        vertex = int(np.nanargmax(np.abs(t))) if known.any() else None
        largest = None if vertex is None else or_none(float(t[vertex]))
        significant = int(np.count_nonzero(q <= alpha))
        summaries.append(VertexwiseColumn(name, int(np.count_nonzero(known)), significant, largest, vertex))
    (path_a, meshes_a), (path_b, meshes_b) = sides
    count = len(next(iter(columns.values())))
    return VertexwiseReport(1, __version__, path_a, path_b, meshes_a, meshes_b, alpha, correction, count, summaries)


def table(positions: Floats, columns: Mapping[str, Any]) -> dict[str, Any]:
    """The map as a table: vertex, mean position of group A, and the columns."""
    count = len(positions)
    return {"vertex": np.arange(count, dtype=np.int32), **dict(zip("xyz", positions.T, strict=True)), **columns}
