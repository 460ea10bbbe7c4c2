"""Phrases of the report, shared by all texts and pages about a mesh."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..support.words import counted, escape_text, format_rounded

if TYPE_CHECKING:
    from ..checks.base import Check
    from .model import Report, Topology

_RANK = {"fail": 0, "pass": 1, "not_applicable": 2}
RESULTS = {"fail": "fails", "pass": "holds", "not_applicable": "does not apply"}

# Limits of the rows of passing checks on pieces, and of rows of pieces, on a page; beyond them it names the table.
SHOWN_ROWS = 100


def verdict(report: Report) -> str:
    """Numbers of identities that hold, fail and do not apply, and of warnings, in one line."""
    counts = {status: sum(row.status == status for row in report.checks) for status in _RANK}
    clauses = []
    if counts["fail"]:
        clauses.append(counted(counts["fail"], "identity fails", "identities fail"))
    clauses.append(counted(counts["pass"], "identity holds", "identities hold"))
    if counts["not_applicable"]:
        clauses.append(f"{counts['not_applicable']:,} not applicable")
    clauses.append(counted(len(report.warnings), "warning") if report.warnings else "no warnings")
    return ", ".join(clauses)


def shape(topology: Topology) -> str:
    """Shape of the surface: its pieces, its boundary, its genus."""
    clauses = [
        "closed" if topology.closed else counted(topology.boundary_edges, "boundary edge"),
        "manifold" if topology.manifold else "not manifold",
        "orientable" if topology.orientable else "not orientable",
    ]
    if topology.components > 1:
        clauses.insert(0, counted(topology.components, "component"))
    if topology.genus is not None:
        clauses.append(f"genus {topology.genus}")
    for count, name in ((topology.crosscaps, "crosscap"), (topology.boundary_loops, "boundary loop")):
        if count:
            clauses.append(counted(count, name))
    return ", ".join(clauses)


def conventions(report: Report) -> dict[str, str]:
    """Options chosen, in words; of options that only some columns depend on, those that were used."""
    chosen = report.conventions
    turned = "closed patches that were inside out are turned" if chosen["orient"] == "outward" else "as the file has it"
    sentences = {
        "mean curvature": ("H = κ₁ + κ₂, 2/r on a sphere" if chosen["mean"] == "sum" else "H = (κ₁ + κ₂)/2")
        + "; positive where the surface is convex seen from the side its normals point to",
        "area of K_density": str(chosen["area"]),
        "orientation": turned,
        "welding": {"none": "none", "exact": "vertices at exactly one place are merged"}.get(
            chosen["weld"] or "none", f"vertices within {chosen['weld']} of the bounding-box diagonal are merged"
        ),
        "unit of length": chosen["unit"] or "that of the file",
        "undefined": "null: neither 0 nor left out of a count",
    }
    described = ("mean", "area", "orient", "weld", "unit", "bending_rigidity")
    if chosen.get("bending_rigidity") is not None:
        sentences["energies"] = f"times the bending rigidity κ = {chosen['bending_rigidity']}"
    return sentences | {key: str(value) for key, value in chosen.items() if key not in described and value is not None}


def failing_first(rows: Iterable[Check]) -> list[Check]:
    """Checks by severity, failing first."""
    return sorted(rows, key=lambda row: _RANK[row.status])


def listed(rows: Sequence[Check]) -> list[Check]:
    """Checks, failing first; those that pass on pieces are cut at `SHOWN_ROWS` rows in all."""
    kept = [row for row in rows if row.scope == "whole" or row.status == "fail"]
    rest = [row for row in rows if row.scope != "whole" and row.status != "fail"]
    return failing_first([*kept, *rest[: max(0, SHOWN_ROWS - len(kept))]])


def number(value: Any, digits: int = 6) -> str:
    """Number, vector or word of a table; `undefined` for null."""
    if value is None:
        return "undefined"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return "(" + ", ".join(number(part, digits) for part in value) + ")"
    if isinstance(value, int):
        return f"{value:,}"
    return format_rounded(value, digits) if isinstance(value, float) else escape_text(str(value))


def shell_quoted(arguments: Iterable[str]) -> str:
    """Arguments as a line for a shell; unprintable ones are in $'…' with escapes."""
    return " ".join(map(_quoted, arguments))


def _quoted(argument: str) -> str:
    if argument.isprintable():
        return shlex.quote(argument)
    escaped = "".join(chr(byte) if 32 <= byte < 127 else f"\\x{byte:02x}" for byte in _escaped(argument))
    return f"$'{escaped}'"


def _escaped(argument: str) -> bytes:
    return argument.replace("\\", r"\\").replace("'", r"\'").encode("utf-8", "surrogateescape")
