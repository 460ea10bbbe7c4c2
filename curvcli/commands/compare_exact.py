"""Comparison of a mesh with a table of exact values: error norms of every column that has one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..errors import InputError, UsageError
from ..support.words import counted, format_rounded
from .compare_inputs import LoadedSide, analysed_side

if TYPE_CHECKING:
    from ..report.accuracy import Accuracy

_POSITION = ("x", "y", "z")
# Default passes where -p is not given.
_ESTIMATED = ("K_density", "h_signed", "kappa_1", "kappa_2", "estimates")


def is_exact(cells: Mapping[str, Any]) -> bool:
    """True for a table of `curvcli sample`: it has the normals of the smooth surface, and no other table does."""
    return "normal_x" in cells and "status" not in cells


def accuracy(
    path: str,
    exact: LoadedSide,
    conventions: Mapping[str, Any],
    limits: Mapping[str, Any],
    wanted: Callable[[str], bool],
    rtol: float | None,
    quiet: bool,
) -> Accuracy:
    """The report of the mesh at a path against exact values.

    Errors: InputError for a table of another length; UsageError where no column has an exact value.
    """
    import numpy as np

    from ..curvatures.catalogue import resolve
    from ..report.accuracy import model
    from ..report.compare.exact import error_norms, match

    cells = exact.cells or {}
    named = conventions["passes"] or _ESTIMATED
    only_possible = [] if conventions["passes"] else list(match(dict.fromkeys(resolve(named)), cells))
    settings = {**conventions, "passes": tuple(only_possible or resolve(named))}
    read, analysis = analysed_side(path, settings, limits, quiet)
    columns = {k: v for k, v in (read.cells or {}).items() if k not in (*_POSITION, "status", "welded_to")}
    surface = analysis.surface
    rows = len(next(iter(cells.values())))
    if rows != surface.n_vertices:
        raise InputError(
            f"{counted(rows, 'row')} found, {surface.n_vertices:,} expected, one for each vertex of {path}",
            path=exact.side.path,
            hint="`curvcli sample NAME -o MESH.ply -o EXACT.csv` writes both for the same vertices",
        )
    pairs = {name: partner for name, partner in match(columns, cells).items() if wanted(f"vertices.{name}")}
    if not pairs:
        raise UsageError(f"{exact.side.path} has exact values of none of the columns: {', '.join(columns) or 'none'}")
    notes = []
    if all(axis in cells for axis in _POSITION):
        given = np.array([cells[axis] for axis in _POSITION], np.float64)
        moved = float(np.nanmax(np.abs(given - surface.xyz_given)))
        if moved > 1e-6 * np.ptp(given[:, surface.referenced], axis=1).max():
            notes.append(
                f"the mesh's vertices are up to {format_rounded(moved, 3)} from where the exact values are known"
            )
    area = surface.in_file_unit(analysis.columns["star_area"], 2)
    errors = []
    for name, partner in pairs.items():
        reference = np.asarray(cells[partner], np.float64)
        if conventions["mean"] == "average" and partner in ("h", "h_signed"):
            reference = reference / 2
        errors.append(error_norms(name, partner, np.asarray(columns[name], np.float64), reference, area))
    unmatched = [name for name in columns if name not in pairs]
    return model(read.side, exact.side, analysis.conventions.scale, rtol, errors, unmatched, notes)
