"""Report as Markdown: short enough for a pull request, in the dialect of GitHub."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ..analysis.configuration import sentence
from ..checks.catalogue import identities
from ..support.words import escape_text
from .conclusion import conclusion
from .model import Report
from .phrases import RESULTS, SHOWN_ROWS, conventions, failing_first, number, shape, verdict

_TOPOLOGY = {
    "vertices": "vertices",
    "edges": "edges",
    "faces": "faces",
    "euler_characteristic": "χ",
    "components": "components",
    "boundary_loops": "boundary loops",
    "genus": "genus",
    "crosscaps": "crosscaps",
}


def markdown(report: Report, command: str | None = None) -> str:
    """One line of verdict; checks, failing first; warnings with hints; topology, totals, conventions, command."""
    failed = any(row.status == "fail" for row in report.checks)
    name = _code({None: "arrays in memory", "-": "stdin"}.get(report.input.path, str(report.input.path)))
    sections = [
        f"### curvcli: {name}",
        f"**{'FAIL' if failed else 'pass'}** · {verdict(report)} · {shape(report.topology)}",
        "\n".join(_warnings(report)),
        _checks(report),
        _text(conclusion(report)),
        _text(sentence(report.configuration) or ""),
        _topology(report),
        _folded(
            "Totals and conventions",
            _table(("total", "value"), ((_code(key), number(value, 10)) for key, value in report.totals.items())),
            "\n".join(f"* {key}: {_text(value)}" for key, value in conventions(report).items()),
        ),
    ]
    if command is not None:
        sections.append(_fenced(command))
    sections.append(f"<sub>curvcli {report.curvcli}{_hash(report)}</sub>")
    return "\n\n".join(part for part in sections if part) + "\n"


def _checks(report: Report) -> str:
    """Table of the checks of the whole, and of all that fail; the rest is counted."""
    shown = [row for row in report.checks if row.scope == "whole" or row.status == "fail"]
    rows = [
        (
            RESULTS[row.status] if row.status != "fail" else "**fails**",
            _code(row.name),
            "whole" if row.scope == "whole" else _code(row.scope),
            number(row.residual, 3) if row.status != "not_applicable" else "",
            number(row.tolerance, 3) if row.status != "not_applicable" else "",
            _text(row.detail if row.status == "not_applicable" else _statement(row.name)),
        )
        for row in failing_first(shown)
    ]
    table = _table(("result", "check", "on", "residual", "allowed", "identity"), rows[:SHOWN_ROWS])
    more = len(report.checks) - min(len(rows), SHOWN_ROWS)
    return f"{table}\n\n{more:,} more checks of components and regions are in the JSON report." if more else table


def _statement(name: str) -> str:
    known = identities()
    return known[name].statement.split("\n")[0] if name in known else ""


def _warnings(report: Report) -> Iterable[str]:
    for remark in report.warnings:
        first = f" (first: {_text(', '.join(map(str, remark.examples[:3])))})" if remark.examples else ""
        hint = f"; {_text(remark.hint)}" if remark.hint else ""
        yield f"* **{remark.code}**: {remark.count:,} {_text(remark.message)}{first}{hint}"


def _topology(report: Report) -> str:
    counts = {label: getattr(report.topology, key) for key, label in _TOPOLOGY.items()}
    known = {label: number(value) for label, value in counts.items() if value is not None}
    return _table(known, [known.values()])


def _folded(summary: str, *sections: str) -> str:
    return "\n\n".join([f"<details><summary>{summary}</summary>", *sections, "</details>"])


def _table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    body = [f"| {' | '.join(map(_cell, row))} |" for row in rows]
    names = list(header)
    return "\n".join([f"| {' | '.join(names)} |", "|" + " --- |" * len(names), *body]) if body else ""


def _cell(text: str) -> str:
    """Cell of a table; a pipe is escaped, in code too."""
    return re.sub(r"(?<!\\)[|]", r"\|", text)


def _text(text: str) -> str:
    """Sentence for Markdown, HTML and tables: it creates no mention, no issue reference and no link.

    Text between backticks is code.
    """
    segments = escape_text(text).split("`")
    if len(segments) % 2 == 0:
        return _escaped(text)
    return "".join(_code(part) if k % 2 else _escaped(part) for k, part in enumerate(segments))


def _escaped(text: str) -> str:
    escaped = re.sub(r"([\\`*_{}\[\]<>|~&$])", r"\\\1", escape_text(text))
    return re.sub(r"[@#:](?=[\w/])", r"\g<0><!-- -->", escaped)


def _code(text: str) -> str:
    """Name as code, with any characters."""
    fence = "`" * (1 + max((len(run) for run in re.findall("`+", text)), default=0))
    inner = escape_text(text)
    return f"{fence} {inner} {fence}" if "`" in inner or inner != inner.strip() else f"{fence}{inner}{fence}"


def _fenced(command: str) -> str:
    command = escape_text(command)
    longest = max((len(run) for run in re.findall("`+", command)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}sh\n{command}\n{fence}"


def _hash(report: Report) -> str:
    return f" · sha256 `{report.input.sha256[:16]}…`" if report.input.sha256 else ""
