"""The pages of the documentation and the blocks of code in them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]
NAMES = [page.relative_to(ROOT).as_posix() for page in PAGES]

_FENCE = re.compile(r"^(`{3,})([^\n`]*)\n(.*?)^\1$", re.MULTILINE | re.DOTALL)
_NOT_RUN = re.compile(r'title="Not run by the tests: ([^"]+)"')


@dataclass(frozen=True)
class Block:
    """One block of code; reason: why it cannot run, which is written above it for readers."""

    language: str
    code: str
    line: int
    reason: str
    title: str


def text(name: str) -> str:
    """A page by its path from the root."""
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(name: str) -> list[Block]:
    """The blocks of a page in their order."""
    page = text(name)
    found = []
    for fence in _FENCE.finditer(page):
        language, _, rest = fence[2].partition(" ")
        reason = _NOT_RUN.search(rest)
        title = re.search(r'title="([^"]*)"', rest)
        line = page.count("\n", 0, fence.start()) + 2
        found.append(Block(language, fence[3], line, reason[1] if reason else "", title[1] if title else ""))
    return found
