"""Prose of the repository: docstrings begin with a noun or a verb, messages have no blank before a comma."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = ("curvcli", "tests", "benchmarks", "docs")
SOURCES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py"))
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)

RELATIVE = r"(?:Wh(?:at|ich|o|ere)(?:ever)?|Whose|Whom|Whether|How)\b"
BEGINS = re.compile(rf"\W*{RELATIVE}")
# A sentence, or a clause after a colon, that begins with one and is no question.
SENTENCE = re.compile(rf"(?:^|[.;:] ){RELATIVE}[^.?]*(?:\.|$)")
# Verbs without their subject, and programs that act like persons.
PHRASE = re.compile(r"\b(?:is|are|was|were) (?:told|looked for|let go)\b|\bnobody wanted\b")
BLANK = re.compile(r"\w\]? , \w")
SUSPECT = re.compile(rf"{RELATIVE}|{BLANK.pattern}")
TITLES = {"What happens when you run `curvcli analyze`", "How-to"}


@cache
def trees(folder: str) -> list[tuple[str, ast.Module]]:
    """Sources with a word or a blank that may offend; to parse them all would take ten seconds."""
    paths = [path for path in SOURCES if path.relative_to(ROOT).parts[0] == folder]
    sources = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}
    return [(path, ast.parse(text)) for path, text in sources.items() if SUSPECT.search(text)]


@pytest.mark.parametrize("folder", FOLDERS)
def test_docstrings_begin_with_a_noun_or_a_verb(folder: str) -> None:
    offending = [
        f"{path}:{getattr(node, 'lineno', 1)} {text}"
        for path, tree in trees(folder)
        for node in ast.walk(tree)
        if isinstance(node, DOCUMENTED) and BEGINS.match(text := ast.get_docstring(node) or "")
    ]
    assert offending == []


def texts(path: str, tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Places and texts: docstrings and all other strings."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield f"{path}:{node.lineno}", " ".join(node.value.split())


def test_sentences_begin_with_their_subject() -> None:
    found = [place for path, tree in trees("curvcli") for place, text in texts(path, tree) if SENTENCE.search(text)]
    assert found == []


def test_pages_begin_sentences_with_their_subject() -> None:
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]
    found = []
    for page in pages:
        prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
        for paragraph in re.split(r"\n\n+|\n(?=[*|#] ?)|\n(?=\d+\. )", prose):
            text = " ".join(paragraph.split()).lstrip("*#|0123456789. ")
            if text not in TITLES and (SENTENCE.search(text) or PHRASE.search(text)):
                found.append(f"{page.relative_to(ROOT)}: {text[:80]}")
    assert found == []


def test_phrases_have_a_subject() -> None:
    sources = [path for path in SOURCES if path.relative_to(ROOT).parts[0] == "curvcli"]
    assert [path for path in sources if PHRASE.search(path.read_text(encoding="utf-8"))] == []


def test_texts_have_no_blank_before_a_comma() -> None:
    """Of strings that are sentences; ` , ` separates words in no list of the package."""
    found = [place for path, tree in trees("curvcli") for place, text in texts(path, tree) if BLANK.search(text)]
    assert found == []
