"""Pages that a command makes are what the command makes now."""

from __future__ import annotations

from pathlib import Path

from curvcli.report.quantities import page, public

ROOT = Path(__file__).parent.parent.parent


def test_the_page_of_quantities_is_current() -> None:
    """`curvcli passes --markdown > docs/quantities.md` makes it again."""
    assert (ROOT / "docs" / "quantities.md").read_text(encoding="utf-8") == page()


def test_every_quantity_says_what_it_is() -> None:
    for quantity in public():
        assert quantity.description.endswith("."), quantity.name
        assert quantity.symbol, quantity.name
        assert quantity.formula, quantity.name
        assert quantity.boundary, quantity.name
        assert quantity.source, quantity.name
