"""Pages that follow from the code are what the code makes now, and those written by hand name all there is."""

from __future__ import annotations

import re

import pytest
from click import Context

from curvcli.analysis.maps import SurfaceMap
from curvcli.checks.catalogue import identities
from curvcli.checks.requirements.catalogue import requirements
from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS
from curvcli.curves.collect import curves_of_surface
from curvcli.curves.measure import CurveMeasures
from curvcli.errors import EXIT_CODES
from curvcli.report.quantities import public
from curvcli.samples import names
from docs.pages import PAGES, PARTS, current
from tests.docs.pages import NAMES, ROOT, text
from tests.helpers import meshes


@pytest.mark.parametrize("name", [name for name in NAMES if name != "README.md"])
def test_a_page_is_current(name: str) -> None:
    """`python -m docs.pages docs` makes it again."""
    assert current(name.removeprefix("docs/"), text(name)) == text(name)


def test_every_page_and_part_is_shown() -> None:
    assert {f"docs/{name}" for name in PAGES} <= set(NAMES)
    for part in PARTS:
        assert any(f"<!-- made: {part} -->" in text(name) for name in NAMES), part


def test_the_readme_counts_the_samples() -> None:
    assert f" {len(names())} test surfaces" in text("README.md")


def test_every_quantity_says_what_it_is() -> None:
    for quantity in public():
        assert quantity.description.endswith("."), quantity.name
        assert quantity.symbol, quantity.name
        assert quantity.formula, quantity.name
        assert quantity.boundary, quantity.name
        assert quantity.source, quantity.name


def test_every_check_says_what_it_is() -> None:
    for rule in identities().values():
        assert all((rule.statement, rule.gap, rule.applies, rule.bound, rule.failure)), rule.name
    for kind in requirements().values():
        assert kind.statement, kind.name
        assert kind.remedy, kind.name


def test_the_checks_of_curves_and_maps_have_a_line() -> None:
    """All that a curve or a map is tested for is named."""
    surface = meshes.cap().surface()
    names = {identity.name for identity in CurveMeasures(curves_of_surface(surface)).identities}
    names |= {check.name for check in SurfaceMap(surface, surface.points).checks}
    assert len(names) == 6
    assert {name for name in names if f"| `{name}` | " not in text("docs/checks.md")} == set()


def test_every_option_of_every_command_is_on_the_page() -> None:
    page = text("docs/command-line.md")
    for name in COMMANDS:
        command = cli.get_command(Context(cli), name)
        assert command is not None
        section = page.partition(f"## `curvcli {name}`\n")[2].partition("\n## ")[0]
        for parameter in command.params:
            assert all(option in section for option in parameter.opts if option.startswith("--")), parameter.name


def test_every_warning_has_a_line() -> None:
    page = text("docs/formats.md")
    codes = {
        code
        for path in (ROOT / "curvcli").glob("**/*.py")
        for code in re.findall(r'Notice(?:\.at)?\(\s*"(\w+)"', path.read_text(encoding="utf-8"))
    }
    assert "degenerate_faces" in codes
    assert {code for code in codes if f"`{code}`" not in page} == set()


def test_every_line_has_a_warning() -> None:
    table = text("docs/formats.md").partition("| code | meaning |")[2].partition("\n\n")[0]
    codes = [
        code for cell in re.findall(r"^\| (`[^|]*) \|", table, re.MULTILINE) for code in re.findall(r"`(\w+)`", cell)
    ]
    assert len(codes) == len(set(codes)) > 30
    sources = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "curvcli").glob("**/*.py"))
    assert [code for code in codes if f'"{code}"' not in sources] == []


def test_every_exit_code_has_a_line() -> None:
    for code in EXIT_CODES:
        assert f"\n| {code} | " in text("docs/formats.md")
