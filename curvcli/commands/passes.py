"""`curvcli passes`: every quantity, or all about one."""

from __future__ import annotations

import click

from . import options


@click.command("passes", short_help="List every quantity, or explain one.")
@click.argument("name", required=False)
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
@click.option("--markdown", is_flag=True, help="The documentation page of all quantities.")
@options.schema
def command(name: str | None, as_json: bool, markdown: bool) -> None:
    """Every quantity with its symbol, formula, kind and unit; with NAME, all that is known about one."""
    from ..report.quantities import describe, listing

    if markdown:
        from ..report.quantities import page

        click.echo(page(), nl=False)
    elif as_json:
        from ..report.model import encode
        from ..report.quantities import as_data

        click.echo(encode(as_data(name)), nl=False)
    elif name is None:
        listing()
    else:
        describe(name)
