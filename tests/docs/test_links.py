"""Links within the documentation lead somewhere, and to every page."""

from __future__ import annotations

import re

import pytest

from tests.docs.pages import NAMES, ROOT, blocks, text

LINK = re.compile(r"\]\((?!https?://)([^)#\s]*)(#[^)]*)?\)")


def prose(name: str) -> str:
    """A page without its blocks of code."""
    return re.sub(r"^```.*?^```$", "", text(name), flags=re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("name", NAMES)
def test_links_lead_somewhere(name: str) -> None:
    for target, anchor in LINK.findall(prose(name)):
        page = (ROOT / name).parent / target if target else ROOT / name
        assert page.exists(), target
        if anchor:
            headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
            slugs = {"#" + re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
            assert anchor in slugs, anchor


def test_every_page_is_linked_from_the_start() -> None:
    linked = {target for target, _ in LINK.findall(text("docs/index.md"))}
    pages = {str(page.relative_to(ROOT / "docs")) for page in (ROOT / "docs").glob("**/*.md")}
    assert pages - linked == {"index.md"}


FILE = re.compile(r"\b(?:tests|benchmarks|curvcli|docs)/[\w./-]*\w")
OUTSIDE = ("README.md", "SECURITY.md", "CONTRIBUTING.md", "benchmarks/README.md", *NAMES)


@pytest.mark.parametrize("name", sorted(set(OUTSIDE)))
def test_files_that_pages_name_exist(name: str) -> None:
    """Except files that a block of the page writes."""
    written = {block.title.removeprefix("Write ") for block in blocks(name)}
    named = set(FILE.findall(re.sub(r"https?://\S+", "", text(name)))) - written
    assert [path for path in sorted(named) if not (ROOT / path).exists()] == []
