"""Tables in LaTeX: `tabular` with rules, without packages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from ..._version import __version__
from ...curvatures.derived import derived
from ...curvatures.registry import passes
from ...errors import OutputError
from ...mesh.file import Labels
from ..pictures.legend import mesh_name
from ..tables.write import parse_precision
from .text import DIGITS, UNDEFINED, escape_latex, typeset, unit

if TYPE_CHECKING:
    import jinja2

    from ...analysis.result import Result
    from ..appearance import Appearance

# Rows of a table that somebody may still typeset.
MOST_ROWS = 10_000


def write_table(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int) -> None:
    """Write a table, one row per row, with its names as they are.

    precision: significant digits; `shortest` is 5, as a paper shows. Undefined cells are dashes.
    Errors: OutputError for more than 10,000 rows.
    """
    digits = parse_precision(precision) or DIGITS
    count = max((len(each.codes if isinstance(each, Labels) else each) for each in columns.values()), default=0)
    if count > MOST_ROWS:
        raise OutputError(f"{count:,} rows in a LaTeX table, at most {MOST_ROWS:,}; .csv and .parquet hold them")
    cells = [_cells(each, digits) for each in columns.values()]
    align = ["l" if isinstance(each, Labels) else "r" for each in columns.values()]
    rows = zip(*cells, strict=True) if cells else ()
    stream.write(_rendered([], align, [escape_latex(name) for name in columns], rows))


def _cells(column: Any, digits: int) -> list[str]:
    if isinstance(column, Labels):
        return [UNDEFINED if word is None else escape_latex(word) for word in column.words()]
    mask = np.ma.getmaskarray(column) if isinstance(column, np.ma.MaskedArray) else None
    values = np.ma.getdata(column).tolist()
    return [
        UNDEFINED if mask is not None and mask[place] else typeset(value, digits) for place, value in enumerate(values)
    ]


def write_totals(stream: BinaryIO, analysis: Result, appearance: Appearance) -> None:
    """Write the totals of the whole surface with their units; comments name the mesh and the conventions."""
    from ...report.build import whole_piece

    digits = parse_precision(appearance.precision) or DIGITS
    rows = [
        (escape_latex(name), _value(value, digits), _unit_of(analysis, name))
        for name, value in whole_piece(analysis).totals.items()
    ]
    chosen = analysis.conventions
    comments = [
        f"curvcli {__version__}: {mesh_name(analysis)}",
        f"mean {chosen.mean}, area {chosen.area}, orient {chosen.orient}, weld {chosen.weld}",
    ]
    stream.write(_rendered(comments, ["l", "r", "l"], ["total", "value", "unit"], rows))


def _value(value: Any, digits: int) -> str:
    if isinstance(value, Sequence):
        return f"({', '.join(typeset(component, digits) for component in value)})"
    return typeset(value, digits)


def _unit_of(analysis: Result, name: str) -> str:
    quantity = {each.total: each for each in passes.totals()}.get(name.partition("@")[0])
    if quantity is not None:
        return unit(analysis.conventions.unit_of(quantity))
    exponent = derived[name].length_exponent if name in derived else 3 if name == "volume" else 0
    return "" if exponent == 0 else unit(f"{analysis.conventions.unit or 'length'}^{exponent}".removesuffix("^1"))


def _rendered(about: Iterable[str], align: Sequence[str], head: Sequence[str], rows: Iterable[Sequence[str]]) -> bytes:
    from ...support.words import escape_text

    text = _template().render(about=map(escape_text, about), align=align, head=head, rows=rows)
    return text.encode("utf-8", "backslashreplace")


@cache
def _template() -> jinja2.Template:
    import jinja2

    engine = jinja2.Environment(
        loader=jinja2.PackageLoader("curvcli.output.latex"),
        autoescape=False,
        keep_trailing_newline=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        block_start_string="<%",
        block_end_string="%>",
        variable_start_string="<<",
        variable_end_string=">>",
        comment_start_string="<#",
        comment_end_string="#>",
    )
    return engine.get_template("table.tex")
