"""The outcome of `curvcli check` for people: what fails first, one line each, then what holds."""

from __future__ import annotations

from collections.abc import Iterator
from io import StringIO
from typing import TextIO

from rich import box
from rich.markup import escape
from rich.table import Table

from ..printable import shown
from .check import ERROR, FAIL, INPUT, NOT_APPLICABLE, PASS, CheckedMesh, CheckReport, sentence
from .console import MARKS, report_console
from .fitting import add_numbers, fitting, plain_table, roomy_table

# The least width of a column of sentences, or of paths.
_MESSAGE = 24
_ORDER = (ERROR, FAIL, PASS, NOT_APPLICABLE)


def write_text(report: CheckReport, verbose: int = 0) -> bytes:
    """The same as plain text."""
    stream = StringIO()
    show(report, verbose, stream)
    return stream.getvalue().encode("utf-8", "backslashreplace")


def show(report: CheckReport, verbose: int = 0, stream: TextIO | None = None) -> None:
    """Print the report, to stdout unless told otherwise; rich where that is a terminal, plain text elsewhere."""
    console = report_console(100, stream)
    for mesh in report.meshes:
        for outcome in mesh.trouble:
            # Never folded: one line, one failure, for grep and for eyes.
            console.print(f"{MARKS[outcome.status]} {escape(sentence(mesh, outcome))}", soft_wrap=True)
    for mesh in report.meshes:
        if verbose:
            for remark in mesh.warnings:
                text = f"{shown(mesh.path)}: {remark.code}: {remark.count:,} {shown(remark.message)}"
                console.print(f"[yellow]warning[/yellow] {escape(text)}", soft_wrap=True)
        if (verbose or len(report.meshes) == 1) and mesh.status != ERROR:
            console.print(fitting(console, _outcomes(mesh)))
    if len(report.meshes) > 1:
        console.print(fitting(console, _meshes(report)))
    console.print(escape(summary(report)), soft_wrap=True)
    if any(mesh.status == PASS for mesh in report.meshes) and any(rule.name == "gauss_bonnet" for rule in report.rules):
        console.print("[dim]Gauss–Bonnet certifies the curvatures and χ, not that the mesh is sound.[/dim]")


def summary(report: CheckReport) -> str:
    """How many meshes and checks passed, in one line."""
    total = len(report.meshes)
    passed = sum(mesh.status == PASS for mesh in report.meshes)
    outcomes = [outcome for mesh in report.meshes for outcome in mesh.outcomes if outcome.kind != INPUT]
    counts = {status: sum(outcome.status == status for outcome in outcomes) for status in _ORDER}
    meshes = (
        f"{passed:,} of {total:,} meshes pass" if total > 1 else f"the mesh {'passes' if passed else 'does not pass'}"
    )
    return f"{meshes}: {counts[PASS]:,} checks hold, {counts[FAIL]:,} fail, {counts[NOT_APPLICABLE]:,} do not apply"


def _outcomes(mesh: CheckedMesh) -> Iterator[Table]:
    """Failing first; with little room the names stand before the sentences."""
    listed = sorted(mesh.outcomes, key=lambda outcome: _ORDER.index(outcome.status))
    wide = roomy_table("check", "scope", "status")
    wide.add_column(shown(mesh.path), overflow="fold", min_width=_MESSAGE)
    narrow = plain_table("status")
    narrow.add_column(shown(mesh.path), overflow="fold")
    for outcome in listed:
        name, scope, message = (escape(shown(text)) for text in (outcome.name, outcome.scope, outcome.message))
        wide.add_row(name, scope, MARKS[outcome.status], message)
        narrow.add_row(MARKS[outcome.status], f"{escape(shown(outcome.label))}: {message}")
    yield wide
    yield narrow


def _meshes(report: CheckReport) -> Iterator[Table]:
    for counts in (("hold", "fail", "do not apply", "warnings"), ("fail",)):
        table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
        table.add_column("mesh", overflow="fold", min_width=_MESSAGE)
        table.add_column("status", no_wrap=True)
        add_numbers(table, *counts)
        for mesh in sorted(report.meshes, key=lambda mesh: _ORDER.index(mesh.status)):
            told = {
                "hold": mesh.count(PASS),
                "fail": mesh.count(FAIL),
                "do not apply": mesh.count(NOT_APPLICABLE),
                "warnings": len(mesh.warnings),
            }
            row = ("" if mesh.status == ERROR else f"{told[name]:,}" for name in counts)
            table.add_row(escape(shown(mesh.path)), MARKS[mesh.status], *row)
        yield table
