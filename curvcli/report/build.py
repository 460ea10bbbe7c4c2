"""Reports from analyses."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from .._version import __version__
from ..analysis.configuration import configured
from ..checks.area_fractions import area_fractions
from ..checks.special import competing_normals, constant_mean_curvature, steiner
from ..mesh.counts import classify, count_groups, duplicate_faces, duplicate_vertices
from ..mesh.groups import Groups
from ..mesh.surface import Surface
from ..support.arrays import numbers_or_none
from ..support.cache import cached
from .model import (
    CONVENTIONS,
    Cmc,
    Fractions,
    Minimal,
    Normals,
    Piece,
    Report,
    Steiner,
    Topology,
    as_dict,
    input_of,
    vector,
)
from .statistics import ColumnStatistics, Statistics, described, listed_statistics, statistics

if TYPE_CHECKING:
    from ..analysis.result import Result

# Regions in a report that have the default statistics of their columns: 7 MB of JSON with the core columns.
MOST_REGIONS = 1000


def build(analysis: Result) -> dict[str, Any]:
    """Build the report as plain Python values."""
    return as_dict(model(analysis))


def model(analysis: Result) -> Report:
    """Build the report of an analysis."""
    surface = analysis.surface
    whole = whole_piece(analysis)
    conventions = analysis.conventions
    return Report(
        schema_version=1,
        curvcli=__version__,
        input=input_of(surface.file, surface.n_vertices, surface.n_faces),
        conventions={key: getattr(conventions, key) for key in CONVENTIONS},
        topology=whole.topology,
        totals=whole.totals,
        steiner=whole.steiner,
        cmc=whole.cmc,
        minimal=whole.minimal,
        normals=whole.normals,
        fractions=whole.fractions,
        components=_components(analysis),
        loops=loops(analysis),
        regions=region_statistics(analysis),
        columns=column_statistics(analysis),
        checks=analysis.checks,
        warnings=analysis.notices,
        timings=analysis.timings,
        configuration=configured(analysis.configuration),
    )


def pieces(analysis: Result, groups: Groups, columns: Sequence[dict[str, Statistics]] | None = None) -> list[Piece]:
    """Topology, totals and further values of each group of a surface. columns: the statistics of each group."""
    counts = topology_of(analysis, groups)
    totals = {key: _json_list(values) for key, values in analysis.totals_of(groups).items()}
    extras = _extras(analysis, groups)
    return [
        Piece(
            Topology(**{key: values[group] for key, values in counts.items()}),
            {key: values[group] for key, values in totals.items()},
            columns=msgspec.UNSET if columns is None else columns[group],
            name=groups.names[group] if groups.names else msgspec.UNSET,
            **{key: make(group) for key, make in extras.items()},
        )
        for group in range(groups.count)
    ]


@cached
def whole_piece(analysis: Result) -> Piece:
    """Topology, totals and further values of the whole surface."""
    return pieces(analysis, analysis.surface.whole)[0]


@cached
def _components(analysis: Result) -> list[Piece]:
    """Components of a surface; a single one from the surface itself, but for the vertices that no face uses.

    Their columns only if statistics are named: there may be very many components.
    """
    names, components = analysis.request.statistics, analysis.surface.components
    columns = listed_statistics(analysis, components, names) if names else None
    if components.count == 1:
        whole = whole_piece(analysis)
        topology = replace(whole.topology, unreferenced_vertices=0)
        return [replace(whole, topology=topology, columns=columns[0] if columns else msgspec.UNSET)]
    return pieces(analysis, components, columns)


@cached
def region_statistics(analysis: Result) -> list[Piece]:
    """The regions with the statistics of their columns; of more than `MOST_REGIONS` only if statistics are named."""
    if analysis.cut is None:
        return []
    names, groups, listed = analysis.request.statistics, analysis.cut_groups, region_pieces(analysis)
    if groups.count > MOST_REGIONS and not names:
        return listed
    each = listed_statistics(analysis.cut, groups, names)
    return [replace(piece, columns=columns) for piece, columns in zip(listed, each, strict=True)]


def region_pieces(analysis: Result) -> list[Piece]:
    """Topology, totals, shares and further values of each region."""
    if analysis.cut is None:
        return []
    shares = {key: _json_list(values) for key, values in analysis.shares_of_regions().items()}
    return [
        replace(piece, shares={key: values[region] for key, values in shares.items()})
        for region, piece in enumerate(pieces(analysis.cut, analysis.cut_groups))
    ]


@cached
def loops(analysis: Result) -> list[dict[str, Any]]:
    """One row per boundary loop, vectors as lists."""
    if not len(analysis.surface.boundary_half_edges):
        return []
    from ..curves.loops import loop_table

    columns = {
        key: _json_list(column) if column.dtype.kind == "f" else column.tolist()
        for key, column in loop_table(analysis.surface).items()
    }
    for stem in ("vector_area", "force", "torque"):
        axes = [columns.pop(f"{stem}_{axis}") for axis in "xyz"]
        columns[stem] = [vector(each) for each in zip(*axes, strict=True)]
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _extras(analysis: Result, groups: Groups) -> dict[str, Callable[[int], Any]]:
    """Values that need certain passes: for each key a function from the group to its value."""
    surface, columns = analysis.surface, analysis.columns
    factor = 0.5 if analysis.conventions.mean == "average" else 1.0
    signs = {key: _json_list(values) for key, values in area_fractions(surface, groups, columns).items()}
    extras: dict[str, Callable[[int], Any]] = {
        "fractions": lambda group: Fractions(**{key: values[group] for key, values in signs.items()})
    }
    if columns.keys() >= {"H_vec", "A_vec"}:
        bent = constant_mean_curvature(surface, groups, columns)
        exponents = {"H": -1, "residual_max": 1, "residual_density_max": -1, "H_vec_max": 1, "H_vec_density_max": -1}
        shown = {key: _json_list(surface.in_file_unit(values, exponents[key]) * factor) for key, values in bent.items()}
        extras["cmc"] = lambda group: Cmc(**{key: shown[key][group] for key in Cmc.__struct_fields__})
        extras["minimal"] = lambda group: Minimal(**{key: shown[key][group] for key in Minimal.__struct_fields__})
    if columns.keys() >= {"H_vec", "star_vector"}:
        angles = {key: _json_list(values) for key, values in competing_normals(surface, groups, columns).items()}
        extras["normals"] = lambda group: Normals(angles["angle_max"][group], angles["angle_mean"][group])
    if columns.keys() >= {"face_area", "H_theta", "K", "K_minus"}:
        polynomial = steiner(surface, groups, columns)
        rows = _json_list(polynomial["coefficients"])
        extras["steiner"] = lambda group: Steiner(rows[group], bool(polynomial["convex"][group]))
    return extras


def topology_of(analysis: Result, groups: Groups) -> dict[str, list[Any]]:
    """The columns of the topology table, one entry per group."""
    surface = analysis.surface
    kinds = classify(surface, groups)
    classified = {
        key: [None if math.isnan(value) else round(value) for value in getattr(kinds, key)]
        for key in ("boundary_loops", "genus", "crosscaps")
    }
    counted = {key: column.tolist() for key, column in vars(count_groups(surface, groups)).items()}
    counted |= {"components": kinds.components.tolist()} | classified | _defects(analysis, groups)
    return {key: counted[key] for key in Topology.__struct_fields__}


def _defects(analysis: Result, groups: Groups) -> dict[str, list[int]]:
    """Counts per group that need more than the edges."""
    surface = analysis.surface
    faces, vertices = np.zeros(surface.n_faces, bool), np.zeros(surface.n_vertices, bool)
    faces[duplicate_faces(surface)] = True
    vertices[duplicate_vertices(surface)] = True
    loose = surface.n_vertices - int(np.count_nonzero(surface.referenced)) - merged(surface)
    return {
        "degenerate_faces": groups.faces.count_true(analysis.columns["degenerate_face"]).tolist(),
        "duplicate_faces": groups.faces.count_true(faces).tolist(),
        "unreferenced_vertices": [loose if groups.kind == "whole" else 0] * groups.count,
        "duplicate_vertices": groups.vertices.count_true(vertices).tolist(),
    }


def merged(surface: Surface) -> int:
    """Number of rows whose values are in the row they were welded to."""
    welded = surface.file.welded_to if surface.file is not None else None
    return 0 if welded is None else int(np.count_nonzero(welded >= 0))


@cached
def column_statistics(analysis: Result) -> dict[str, ColumnStatistics]:
    """Statistics of every column of the whole surface."""
    area, used = analysis.columns["star_area"], analysis.surface.referenced
    return {
        column: statistics(quantity, values, area, used, analysis.conventions.unit_of(quantity))
        for quantity, column, values in described(analysis)
    }


def _json_list(values: Any) -> list[Any]:
    """Lists for JSON, with None for an undefined number, or a vector with an undefined component."""
    listed = numbers_or_none(np.asarray(values))
    return [vector(row) for row in listed] if np.ndim(values) > 1 else listed
