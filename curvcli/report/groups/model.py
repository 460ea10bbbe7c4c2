"""Report of a comparison of two groups, as JSON and as a table."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any, Literal

import msgspec
import numpy as np

from ..._version import __version__
from ...analysis.configuration import Configured
from ...errors import UsageError
from ...support.arrays import Mask, or_none
from ...support.words import suggestion
from ..entries import TOTAL
from .means import TestOptions, adjusted, differences
from .members import Member, key_of

DifferenceStatus = Literal["tested", "same", "no_variation", "too_few"]

# Statistics that are compared where none are named.
_DEFAULT = (TOTAL, "area_mean")


class GroupSide(msgspec.Struct):
    """One group: its source and its meshes, in the order of their names."""

    path: str
    meshes: list[str]


class GroupDifference(msgspec.Struct):
    """Means of one number in both groups, and their difference B − A.

    status: `tested`; `same`: all values are equal up to rounding; `no_variation`: neither group varies, but they
    differ; `too_few`: a group has fewer than two values. std: of the sample. p: of the test; q: p corrected for the
    number of tests. ci_low, ci_high: of the difference. hedges_g: the difference in pooled standard deviations.
    """

    key: str
    region: str | None
    column: str
    statistic: str
    status: str
    n_a: int
    n_b: int
    missing_a: int
    missing_b: int
    mean_a: float | None
    mean_b: float | None
    std_a: float | None
    std_b: float | None
    difference: float | None
    ci_low: float | None
    ci_high: float | None
    t: float | None
    df: float | None
    p: float | None
    q: float | None
    hedges_g: float | None
    significant: bool


class GroupTest(msgspec.Struct):
    """Test and correction; resamples and seed of permutations, else null."""

    name: str
    alpha: float
    correction: str
    resamples: int | None
    seed: int | None


class GroupComparison(msgspec.Struct):
    """The report of `curvcli compare` for two groups of reports; significant: q is at most alpha."""

    schema_version: int
    curvcli: str
    group_a: GroupSide
    group_b: GroupSide
    test: GroupTest
    tested: int
    significant: int
    differences: list[GroupDifference]
    notes: list[str]
    configuration: Configured = msgspec.UNSET


NumberKey = tuple[str | None, str, str]


def compare_groups(
    a: tuple[str, Sequence[Member]],
    b: tuple[str, Sequence[Member]],
    options: TestOptions,
    wanted: Callable[[str], bool],
    statistics: Collection[str] = (),
) -> GroupComparison:
    """Compare two groups, each a source with its members. wanted: chooses dotted keys. statistics: of columns.

    Errors: UsageError for a statistic that no report has, or if nothing is left to compare.
    """
    members = [*a[1], *b[1]]
    keys = [key for key in dict.fromkeys(key for each in members for key in each.values) if wanted(key_of(*key))]
    known = dict.fromkeys(key[2] for key in keys)
    for name in statistics:
        if name not in known:
            raise UsageError(f"--stat {name}: the reports do not have it{suggestion(name, known)}")
    chosen = {*statistics, TOTAL} if statistics else {*_DEFAULT}
    keys = [key for key in keys if key[2] in chosen]
    if not keys:
        raise UsageError("nothing is left to compare; --only or --ignore leaves no number of the reports")
    first, second = values = [_values(side, keys) for side in (a[1], b[1])]
    varies = _varies(members, keys)
    compared = differences(first, second, varies, options)
    q = adjusted(compared.p, options.correction)
    rows = []
    for row, key in enumerate(keys):
        counts = [int(np.count_nonzero(~np.isnan(side[row]))) for side in values]
        numbers = {name: or_none(float(getattr(compared, name)[row])) for name in ("mean_a", "mean_b")}
        numbers |= {name: or_none(float(getattr(compared, name)[row])) for name in ("std_a", "std_b", "difference")}
        numbers |= {name: or_none(float(getattr(compared, name)[row])) for name in ("t", "df", "p")}
        status = _status(counts, bool(varies[row]), numbers["p"])
        rows.append(
            GroupDifference(
                key=key_of(*key),
                region=key[0],
                column=key[1],
                statistic=key[2],
                status=status,
                n_a=counts[0],
                n_b=counts[1],
                missing_a=len(a[1]) - counts[0],
                missing_b=len(b[1]) - counts[1],
                ci_low=or_none(float(compared.low[row])),
                ci_high=or_none(float(compared.high[row])),
                q=or_none(float(q[row])),
                hedges_g=or_none(float(compared.g[row])),
                significant=bool(q[row] <= options.alpha),
                **numbers,
            )
        )
    permuted = options.test == "permutation"
    return GroupComparison(
        schema_version=1,
        curvcli=__version__,
        group_a=GroupSide(a[0], [each.name for each in a[1]]),
        group_b=GroupSide(b[0], [each.name for each in b[1]]),
        test=GroupTest(
            options.test,
            options.alpha,
            options.correction,
            options.resamples if permuted else None,
            options.seed if permuted else None,
        ),
        tested=sum(row.p is not None for row in rows),
        significant=sum(row.significant for row in rows),
        differences=rows,
        notes=_notes(a[1], b[1]),
    )


def _values(members: Sequence[Member], keys: Sequence[NumberKey]) -> Any:
    """(K, n) values, NaN where a member has none."""
    return np.array(
        [[math.nan if each.values.get(key) is None else each.values[key] for each in members] for key in keys],
        np.float64,
    ).reshape(len(keys), len(members))


def _varies(members: Sequence[Member], keys: Sequence[NumberKey]) -> Mask:
    """(K,) true where values differ by more than the bound on their rounding."""
    varies = np.zeros(len(keys), bool)
    for row, key in enumerate(keys):
        values = [value for each in members if (value := each.values.get(key)) is not None]
        bound = max((each.rounding.get(key, 0.0) for each in members), default=0.0)
        varies[row] = bool(values) and max(values) / 2 - min(values) / 2 > bound
    return varies


def _status(counts: Sequence[int], varies: bool, p: float | None) -> DifferenceStatus:
    if min(counts) < 2:
        return "too_few"
    if not varies:
        return "same"
    return "no_variation" if p is None else "tested"


def _notes(a: Sequence[Member], b: Sequence[Member]) -> list[str]:
    known = [each.conventions for each in (*a, *b) if each.conventions]
    names = dict.fromkeys(name for conventions in known for name in conventions)
    differing = [name for name in names if len({str(conventions.get(name)) for conventions in known}) > 1]
    if not differing:
        return []
    return [f"the conventions of the reports differ ({', '.join(differing)}), so the numbers mean different things"]


def group_table(report: GroupComparison) -> dict[str, Any]:
    """The differences as columns of a table file."""
    from ...mesh.file import Labels

    table: dict[str, Any] = {}
    for name in GroupDifference.__struct_fields__:
        cells = [getattr(row, name) for row in report.differences]
        if name in ("key", "region", "column", "statistic", "status"):
            names = {cell: None for cell in cells if cell is not None}
            number = {cell: code for code, cell in enumerate(names)}
            table[name] = Labels(np.array([number.get(cell, -1) for cell in cells], np.int32), tuple(names))
        elif name == "significant":
            table[name] = np.array(cells, bool)
        elif name.startswith(("n_", "missing_")):
            table[name] = np.array(cells, np.int64)
        else:
            table[name] = np.array([math.nan if cell is None else cell for cell in cells], np.float64)
    return table
