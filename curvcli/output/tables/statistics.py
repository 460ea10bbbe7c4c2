"""Long table of statistics: a row per region, column and statistic, as statistics programs read it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...mesh.file import Labels
from ...support.words import escape_text

if TYPE_CHECKING:
    from ...analysis.result import Result


def statistics_table(analysis: Result) -> dict[str, Any]:
    """Columns mesh, region (null for the whole surface), column (also the key of a total), statistic and value.

    Rows: of the whole and then of each region, for each column its total, its share and its statistics.
    """
    from ...report.entries import entries, measured

    file = analysis.surface.file
    mesh = "" if file is None or file.path is None else escape_text(file.path)
    by_column: dict[tuple[str | None, str], list[tuple[str, float | int | None]]] = {}
    for region, column, statistic, value in entries(measured(analysis)):
        by_column.setdefault((region, column), []).append((statistic, value))
    names: tuple[dict[str | None, int], ...] = ({None: -1}, {}, {})
    codes: list[tuple[int, ...]] = []
    values: list[float] = []
    for (region, column), numbers in by_column.items():
        for statistic, value in numbers:
            row = zip(names, (region, column, statistic), strict=True)
            codes.append(tuple(known.setdefault(name, len(known) - (None in known)) for known, name in row))
            values.append(np.nan if value is None else float(value))
    code_table = np.array(codes, np.int32).reshape(-1, 3)
    table: dict[str, Any] = {"mesh": Labels(np.zeros(len(values), np.int32), (mesh,))}
    for key, known, codes_of_column in zip(("region", "column", "statistic"), names, code_table.T, strict=True):
        table[key] = Labels(np.ascontiguousarray(codes_of_column), tuple(name for name in known if name is not None))
    return table | {"value": np.array(values, np.float64)}
