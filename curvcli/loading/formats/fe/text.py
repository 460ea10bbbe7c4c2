"""Text of the Surface Evolver: comments removed, lines joined, sections apart."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ...text import NEWLINE, drop_empty_lines, plain_lines, tidy

_COMMENT = re.compile(rb"\"[^\"\n]*+\"|/\*.*?(?:\*/|\Z)|//[^\n]*+", re.DOTALL)
_SECTION = re.compile(rb"^(vertices|edges|facetedges|facets|faces|bodies|read) ?:?$", re.IGNORECASE | re.MULTILINE)


@dataclass(frozen=True)
class SectionLines:
    """Tidy lines of a section. numbers: of each in the file, from 0."""

    text: bytes
    numbers: NDArray[np.int64]

    def place(self, row: int) -> str:
        """A line as errors name it."""
        return f"line {int(self.numbers[row]) + 1}"


def split_sections(data: bytes) -> dict[str, SectionLines]:
    """The lines of each section by its name; those before the first are `header`, `facets` are `faces`.

    Errors: InputError for a section that stands twice.
    """
    text, numbers = _joined(_without_comments(plain_lines(data)))
    sections: dict[str, SectionLines] = {}
    name, at, line = "header", 0, 0
    for mark in (*_SECTION.finditer(text), None):
        end = len(text) if mark is None else mark.start()
        stop = len(numbers) if mark is None else line + text.count(b"\n", at, end)
        if name in sections:
            raise InputError(
                f"a second section `{name}` found, one expected", place=f"line {int(numbers[line - 1]) + 1}"
            )
        sections[name] = SectionLines(text[at:end], numbers[line:stop])
        if mark is None or name == "read":
            break
        name = mark[1].decode().lower().replace("facets", "faces")
        at, line = mark.end() + 1, stop + 1
        if name == "read":
            sections[name] = SectionLines(text[at:], numbers[line:])
            break
    return sections


def _without_comments(text: bytes) -> bytes:
    def blank(match: re.Match[bytes]) -> bytes:
        comment = match[0]
        if comment[:1] == b'"':
            return comment
        return b" " + b"\n" * comment.count(b"\n") if b"\n" in comment else b" "

    cleaned = _COMMENT.sub(blank, text) if b"/*" in text or b"//" in text else text
    return cleaned if cleaned.endswith(b"\n") else cleaned + b"\n"


def _joined(text: bytes) -> tuple[bytes, NDArray[np.int64]]:
    """Tidy lines without empty ones, continued lines joined, and the number of each in the file."""
    text, numbers = drop_empty_lines(tidy(text))
    if b"\\\n" not in text:
        return text, numbers
    letters = np.frombuffer(text, np.uint8)
    ends = np.flatnonzero(letters == NEWLINE)
    continued = letters[np.maximum(ends, 1) - 1] == ord("\\")
    first = np.concatenate(([True], ~continued[:-1]))
    text = tidy(text.replace(b"\\\n", b" "))
    text, kept = drop_empty_lines(text if text.endswith(b"\n") else text + b"\n")
    return text, numbers[first][kept]
