"""`curvcli passes`: list every quantity, or explain one."""

from __future__ import annotations

import click

from ..support.words import escape_text
from . import candidates, options
from .talk import put


@click.command("passes", short_help="List every quantity, or explain one.")
@click.argument("name", required=False, shell_complete=candidates.quantities)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--markdown", is_flag=True, help="Print the documentation page of all quantities.")
@options.schema
def command(name: str | None, as_json: bool, markdown: bool) -> None:
    """List every quantity with its symbol, formula, kind and unit, and advice for choosing one; or explain NAME.

    Measures (K, H_vec, A) are exact in sum. At a point of a smooth surface take K_fit and h_fit on clean irregular
    meshes, K_density, h or *_corrected on regular grids, K_corrected and h_corrected on folded shapes and, at a radius
    above the noise, on scans; K_ring and h_ring average the measures.
    `curvcli help estimates` has five sentences and one table on when to use each.
    """
    if markdown:
        from ..report.quantities import page

        put("\n".join(map(escape_text, page().split("\n"))))
    elif as_json:
        from ..report.model import encode
        from ..report.quantities import as_data

        put(encode(as_data(name)))
    else:
        from ..report.terminal.quantities import describe, listing

        describe(name) if name else listing()
