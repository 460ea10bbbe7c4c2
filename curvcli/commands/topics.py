"""Topics of `curvcli help`: pages of text in the package, and pages generated from the declarations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files

from ..errors import EXIT_CODES


@dataclass(frozen=True)
class Topic:
    """summary: one line for the list. text: makes the page; its first line is the title."""

    summary: str
    text: Callable[[], str]


def _page(name: str) -> Callable[[], str]:
    return lambda: files("curvcli.commands").joinpath("data", "topics", f"{name}.txt").read_text(encoding="utf-8")


def _table(title: str, rows: list[tuple[str, str]]) -> str:
    """A title and two columns; long text continues below its column."""
    from textwrap import wrap

    width = max(len(left) for left, _ in rows) + 2
    lines = [f"# {title}", ""]
    for left, right in rows:
        first, *rest = wrap(right, 100 - width) or [""]
        lines += [f"{left:{width}}{first}", *(" " * width + more for more in rest)]
    return "\n".join(lines) + "\n"


def _exit_codes() -> str:
    note = "\nWith several inputs the worst code is used, in the order 70, 4, 3, 1, 0. A closed pipe ends with 0.\n"
    return _table("Exit codes", [(str(code), meaning) for code, meaning in EXIT_CODES.items()]) + note


def _formats() -> str:
    from ..loading.registry import input_formats
    from ..output.registry import output_formats

    inputs = [
        (f".{end}", f"{format.title}, also .{end}.gz") for format in input_formats().values() for end in format.endings
    ]
    outputs = [(suffix, format.description) for suffix, format in output_formats().items()]
    return (
        _table("Formats that are read", inputs)
        + "\n`-` reads a stream; --input-format names its format.\n\n"
        + _table("Formats that are written, by suffix (-o, --table)", outputs)
        + "\n`-o -` writes to stdout; --format names the format. Doubles are written by the shortest text that reads\n"
        "back to the same number, unless --precision N. Schemas of JSON: `curvcli help schemas`.\n"
    )


def _checks() -> str:
    from ..checks.catalogue import identities
    from ..checks.requirements.catalogue import SETS, requirements
    from ..curvatures.catalogue import load_passes

    load_passes()
    stated = [(name, " ".join(rule.statement.split("\n\n")[0].split())) for name, rule in identities().items()]
    required = [(each.usage + (" *" if each.default else ""), each.statement) for each in requirements().values()]
    return (
        _table("Identities, which hold on every mesh up to rounding", stated)
        + "\nTolerances are derived rounding-error bounds, not chosen constants. A pass proves the arithmetic and the\n"
        "counting. Use requirements to check that the mesh is sound, and the one you intend.\n\n"
        + _table("Requirements (check --require, --allow); * required by default", required)
        + "\n"
        + _table("Sets of requirements (check --require)", [(name, ", ".join(SETS[name])) for name in SETS])
    )


def _quantities() -> str:
    from ..report.quantities import facts, public

    rows = []
    for quantity in public():
        shown = facts(quantity)
        rows.append((shown["name"], f"{shown['symbol']}: {shown['formula']} ({shown['on']}, {shown['kind']})"))
    return _table("Quantities; `curvcli passes NAME` explains one", rows)


def _estimates() -> str:
    from ..report.advice import as_text

    return as_text()


def _schemas() -> str:
    from .schemas import SCHEMAS

    rows = [(name, schema.command) for name, schema in SCHEMAS.items()]
    note = "\nThe files are in curvcli/commands/data/schemas; --schema prints them with the names of all columns.\n"
    return _table("JSON Schemas", rows) + note


TOPICS: dict[str, Topic] = {
    "conventions": Topic("signs, factors, units, undefined values", _page("conventions")),
    "quantities": Topic("every column in one line", _quantities),
    "estimates": Topic("choosing a curvature: measures, averages, corrected curvatures, fits", _estimates),
    "checks": Topic("identities and requirements, and the meaning of a pass", _checks),
    "formats": Topic("files that are read and written", _formats),
    "schemas": Topic("JSON Schemas of everything written as JSON", _schemas),
    "regions": Topic("labels of faces", _page("regions")),
    "configuration": Topic("curvcli.toml and pyproject.toml", _page("configuration")),
    "exit-codes": Topic("meaning of the exit codes", _exit_codes),
    "python": Topic("the same from Python", _page("python")),
}
