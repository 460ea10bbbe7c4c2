"""The comparison of two groups, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.table import Table

from ...support.words import counted, format_rounded
from .console import escape, report_console, show_configuration
from .tables import fitting, plain_table, roomy_table

if TYPE_CHECKING:
    from ..groups.model import GroupComparison, GroupDifference

# Rows of the summary; all with -v.
_SHOWN = 40
_NAME = 24
_TESTS = {"welch": "Welch's t test", "permutation": "permutation test of the difference of means"}
_CORRECTIONS = {
    "bh": "false discovery rate by Benjamini-Hochberg",
    "by": "false discovery rate by Benjamini-Yekutieli",
    "none": "not corrected for the number of tests",
}
_STATUS = {"same": "same up to rounding", "no_variation": "no variation", "too_few": "too few values"}


def show(report: GroupComparison, verbose: int = 0) -> None:
    """Print the summary to stdout, the smallest q first; rich where it is a terminal, plain text in a pipe."""
    console = report_console(120)
    for name, side in (("A", report.group_a), ("B", report.group_b)):
        console.print(f"{name} [bold]{escape(side.path)}[/bold] ({counted(len(side.meshes), 'mesh', 'meshes')})")
    for note in report.notes:
        console.print(f"[yellow]note[/yellow] {escape(note)}")
    show_configuration(console, report.configuration)
    console.print(fitting(console, _tables(report, verbose)))
    test = report.test
    permutations = "" if test.seed is None else f", {test.resamples:,} resamples, seed {test.seed}"
    console.print(
        f"difference: B − A, with its {100 * (1 - test.alpha):g} % interval (Welch); g: Hedges' g; p: "
        f"{_TESTS[test.name]}{permutations}; q: {_CORRECTIONS[test.correction]}"
    )
    color = "bold" if report.significant else "green"
    console.print(
        f"[{color}]{report.significant:,} of {counted(report.tested, 'difference')} tested "
        f"{'is' if report.significant == 1 else 'are'} significant[/{color}] (q ≤ {test.alpha:g})"
    )


def _tables(report: GroupComparison, verbose: int) -> Iterator[Table]:
    """A row for each number; on a narrow terminal the means are below its name."""
    wide, narrow = roomy_table(), plain_table("number", fold=_NAME)
    for header in ("number", "n", "mean A", "mean B", "difference", "interval", "g", "p", "q"):
        wide.add_column(header, overflow="fold")
    for header in ("difference", "g", "q"):
        narrow.add_column(header, no_wrap=True)
    rows = sorted(report.differences, key=_order)
    for row in rows[: None if verbose else _SHOWN]:
        wide.add_row(*_cells(row))
        cells = _cells(row)
        narrow.add_row(f"{cells[0]}\n  A {cells[2]}\n  B {cells[3]}", cells[4], cells[6], cells[8])
    if len(rows) > _SHOWN and not verbose:
        for table in (wide, narrow):
            table.add_row(f"[dim]… {len(rows) - _SHOWN:,} more: -v[/dim]")
    yield wide
    yield narrow


def _order(row: GroupDifference) -> tuple[float, float]:
    return (2.0 if row.q is None else row.q, 2.0 if row.p is None else row.p)


def _cells(row: GroupDifference) -> list[str]:
    missing = row.missing_a + row.missing_b
    count = f"{row.n_a}+{row.n_b}" + (f" ({missing} missing)" if missing else "")
    means = [_with_deviation(row.mean_a, row.std_a), _with_deviation(row.mean_b, row.std_b)]
    interval = "" if row.ci_low is None else f"{format_rounded(row.ci_low, 3)} … {format_rounded(row.ci_high, 3)}"
    p = _STATUS.get(row.status, "") if row.p is None else format_rounded(row.p, 2)
    mark = ("[bold]", "[/bold]") if row.significant else ("", "")
    return [
        f"{mark[0]}{escape(row.key)}{mark[1]}",
        count,
        *means,
        format_rounded(row.difference, 4, ""),
        interval,
        format_rounded(row.hedges_g, 3, ""),
        p,
        format_rounded(row.q, 2, ""),
    ]


def _with_deviation(mean: float | None, deviation: float | None) -> str:
    return format_rounded(mean, 5) + ("" if deviation is None else f" ± {format_rounded(deviation, 2)}")
