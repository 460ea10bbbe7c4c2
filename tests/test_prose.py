"""Prose of the repository: docstrings begin with a noun or a verb, messages have no blank before a comma."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = ("curvcli", "tests", "benchmarks", "docs")
SOURCES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py"))
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)

RELATIVE = r"(?:What|Which|Who|Whose|Whom|Whether|How|Where)\b"
BEGINS = re.compile(rf"\W*{RELATIVE}")
# A sentence after another one, or after a colon; a question may begin with any word.
SENTENCE = re.compile(rf"(?<=[.:;] ){RELATIVE}[^.?]*\.")


def trees(folder: str) -> Iterator[tuple[str, ast.Module]]:
    for path in SOURCES:
        if path.relative_to(ROOT).parts[0] == folder:
            yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("folder", FOLDERS)
def test_docstrings_begin_with_a_noun_or_a_verb(folder: str) -> None:
    offending = [
        f"{path}:{getattr(node, 'lineno', 1)} {text}"
        for path, tree in trees(folder)
        for node in ast.walk(tree)
        if isinstance(node, DOCUMENTED) and BEGINS.match(text := ast.get_docstring(node) or "")
    ]
    assert offending == []


def test_texts_have_no_blank_before_a_comma() -> None:
    """Of strings that are sentences; ` , ` separates words in no list of the package."""
    texts = (
        (path, node)
        for path, tree in trees("curvcli")
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
    assert [f"{path}:{node.lineno}" for path, node in texts if re.search(r"\w\]? , \w", str(node.value))] == []
