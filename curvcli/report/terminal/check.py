"""Outcome of `curvcli check` for the terminal: failures, one line each, warnings, then a summary of the passes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import StringIO
from typing import TextIO

from rich import box
from rich.table import Table

from ...support.words import counted
from ..check.lines import FIRST, MOST, WARNINGS, all_failures, by_name, meshes_pass, scopes, warning, warnings
from ..check.model import ERROR, FAIL, IDENTITY, INPUT, NOT_APPLICABLE, PASS, CheckedMesh, CheckReport, Outcome
from .console import MARKS, Console, escape, report_console, show_configuration
from .tables import add_numbers, fitting, plain_table, roomy_table

# Minimum width of a column of sentences, or of paths.
_MESSAGE = 24
# Rows of the table of several meshes without -v.
_ROWS = 20
_EXPLANATION = re.compile(r"[:;] ")
_ORDER = (ERROR, FAIL, PASS, NOT_APPLICABLE)


def write_text(report: CheckReport, verbose: int = 0) -> bytes:
    """Report as plain text."""
    stream = StringIO()
    show(report, verbose, stream)
    return stream.getvalue().encode("utf-8", "backslashreplace")


def show(report: CheckReport, verbose: int = 0, stream: TextIO | None = None) -> None:
    """Print the report, by default to stdout; rich on a terminal, plain text elsewhere.

    The length is bounded: passes are summarised, and failures are cut after the first of each check; verbose: all.
    """
    console = report_console(100, stream)
    _show_trouble(console, report, verbose)
    for mesh in report.meshes:
        if (verbose or len(report.meshes) == 1) and mesh.status != ERROR:
            console.print(fitting(console, _outcomes(mesh, verbose)))
    if len(report.meshes) > 1:
        console.print(fitting(console, _meshes(report, verbose)))
    console.print(escape(summary(report)), soft_wrap=True)
    show_configuration(console, report.configuration)
    if any(mesh.status == PASS for mesh in report.meshes) and any(rule.name == "gauss_bonnet" for rule in report.rules):
        console.print("[dim]Gauss–Bonnet certifies the curvatures and χ, not that the mesh is sound.[/dim]")


def _show_trouble(console: Console, report: CheckReport, verbose: int) -> None:
    """Failures and warnings, one line each and never folded, for grep."""
    first, most, remarks = (None, None, None) if verbose else (FIRST, MOST, WARNINGS)
    listed, others = all_failures(report.meshes, first, most)
    for line in listed:
        console.print(f"{MARKS[line.outcome.status]} {escape(line.text)}", soft_wrap=True)
    if others:
        console.print(f"{MARKS[FAIL]} {others}; -v lists all of them", soft_wrap=True)
    shown_warnings, left_out = warnings(report.meshes, remarks)
    for mesh, remark in shown_warnings:
        console.print(f"[yellow]warning[/yellow] {escape(warning(mesh, remark))}", soft_wrap=True)
    if left_out:
        console.print(f"[yellow]warning[/yellow] {counted(left_out, 'more warning')}; -v lists all of them")


def summary(report: CheckReport) -> str:
    """Number of meshes and checks that passed, in one line."""
    outcomes = [outcome for mesh in report.meshes for outcome in mesh.outcomes if outcome.kind != INPUT]
    counts = {status: sum(outcome.status == status for outcome in outcomes) for status in _ORDER}
    numbers = f"{counts[PASS]:,} checks hold, {counts[FAIL]:,} fail, {counts[NOT_APPLICABLE]:,} do not apply"
    return f"{meshes_pass(report.meshes)}: {numbers}"


def _outcomes(mesh: CheckedMesh, verbose: int) -> Iterator[Table]:
    """A row per check and status, failing first, or with -v per outcome; on a narrow terminal names stand before
    sentences."""
    listed = sorted(mesh.outcomes, key=lambda outcome: _ORDER.index(outcome.status))
    groups = [[outcome] for outcome in listed] if verbose else by_name(listed)
    wide = roomy_table("check", "scope", "status")
    wide.add_column(escape(mesh.path), overflow="fold", min_width=_MESSAGE)
    narrow = plain_table("status")
    narrow.add_column(escape(mesh.path), overflow="fold")
    for group in groups:
        first, scope = group[0], scopes(group)
        name, where, message = (escape(text) for text in (first.name, scope, _message(group, verbose)))
        wide.add_row(name, where, MARKS[first.status], message)
        label = name if scope == "whole" else f"{name} ({where})"
        narrow.add_row(MARKS[first.status], f"{label}: {message}")
    yield wide
    yield narrow


def _message(group: list[Outcome], verbose: int) -> str:
    """Sentence of the first outcome; for an identity that holds, its formula without the explanation."""
    first = group[0]
    if first.kind == IDENTITY and first.status == PASS and not verbose:
        return _EXPLANATION.split(first.message, maxsplit=1)[0]
    return first.message if len({outcome.message for outcome in group}) == 1 else f"first: {first.message}"


def _meshes(report: CheckReport, verbose: int) -> Iterator[Table]:
    """A row per mesh, failing first, and one for the rest."""
    listed = sorted(report.meshes, key=lambda mesh: _ORDER.index(mesh.status))
    # A count is no shorter than one more row.
    most = len(listed) if verbose or len(listed) <= _ROWS + 1 else _ROWS
    for counts in (("hold", "fail", "do not apply", "warnings"), ("fail",)):
        table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
        table.add_column("mesh", overflow="fold", min_width=_MESSAGE)
        table.add_column("status", no_wrap=True)
        add_numbers(table, *counts)
        for mesh in listed[:most]:
            numbers = _numbers([mesh])
            row = ("" if mesh.status == ERROR else f"{numbers[name]:,}" for name in counts)
            table.add_row(escape(mesh.path), MARKS[mesh.status], *row)
        for status in _ORDER:
            if rest := [mesh for mesh in listed[most:] if mesh.status == status]:
                numbers = _numbers(rest)
                row = ("" if status == ERROR else f"{numbers[name]:,}" for name in counts)
                label = counted(len(rest), "more mesh", "more meshes")
                table.add_row(f"[dim]{label}[/dim]", MARKS[status], *row)
        yield table


def _numbers(meshes: list[CheckedMesh]) -> dict[str, int]:
    """Sums of the counts of some meshes, by the headers of the table."""
    statuses = {"hold": PASS, "fail": FAIL, "do not apply": NOT_APPLICABLE}
    numbers = {name: sum(mesh.count(status) for mesh in meshes) for name, status in statuses.items()}
    return {**numbers, "warnings": sum(len(mesh.warnings) for mesh in meshes)}
