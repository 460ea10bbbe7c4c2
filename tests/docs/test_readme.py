"""The README is short, shows the output of its first command, and its links can be made absolute."""

from __future__ import annotations

import re
import tomllib

from tests.docs.pages import ROOT, blocks, text
from tests.docs.shown import OUTPUT

RELATIVE = re.compile(r"\]\((?!https?://)[^)]*\)")


def test_the_readme_is_short() -> None:
    assert len(text("README.md").splitlines()) <= 70
    assert len(text("README.md").split()) <= 500


def test_the_first_command_has_its_output_beside_it() -> None:
    """`test_blocks.py` compares it with what the command prints."""
    first, second = blocks("README.md")[:2]
    assert first.language == "sh"
    assert second.title == OUTPUT


def test_links_can_be_made_absolute_for_a_package_index() -> None:
    """The substitution under *Release* in CONTRIBUTING.md leaves no relative link."""
    settings = next(block for block in blocks("CONTRIBUTING.md") if block.language == "toml")
    (rule,) = tomllib.loads(settings.code)["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]["substitutions"]
    assert RELATIVE.search(text("README.md"))
    absolute = re.sub(rule["pattern"], rule["replacement"], text("README.md"))
    assert RELATIVE.findall(absolute) == []
    for target in re.findall(r"\]\(https://github\.com/OWNER/curvcli/raw/[^/]+/([^)]*)\)", absolute):
        assert (ROOT / target).exists(), target
