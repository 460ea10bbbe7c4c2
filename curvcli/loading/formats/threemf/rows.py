"""Numbers in the attributes of many like elements of XML: vertices and triangles."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ...text import read_columns

_FIRST = re.compile(rb"\s*<([\w.:-]+)((?:\s+[\w.:-]+\s*=\s*\"[^\"<]*\")+)\s*/>\s*")
_ATTRIBUTE = re.compile(rb"\s+([\w.:-]+)\s*=\s*\"([^\"]*)\"")


def read_rows(
    text: bytes, element: str, names: Sequence[str], optional: Sequence[str], dtype: type[np.generic]
) -> tuple[list[NDArray[Any]], dict[str, list[str | None]]]:
    """The numbers of the named attributes of every element of a name, and the texts of optional attributes.

    Elements that are all spelt as the first are read as columns of a table, others one by one.
    Errors: InputError with the element that lacks an attribute or has one that is no number.
    """
    if not text.strip():
        return [np.empty(0, dtype)] * len(names), {}
    even = _even(text, element, names, dtype)
    return (even, {}) if even is not None else _one_by_one(text, element, names, optional, dtype)


def _even(text: bytes, element: str, names: Sequence[str], dtype: type[np.generic]) -> list[NDArray[Any]] | None:
    """Columns of elements spelt alike, with the named attributes only; None if any differs."""
    first = _FIRST.match(text)
    if first is None or first[1].rpartition(b":")[2] != element.encode():
        return None
    attributes = list(_ATTRIBUTE.finditer(first[2]))
    attribute_names = [match[1].decode("ascii", "replace") for match in attributes]
    if sorted(attribute_names) != sorted(names):
        return None
    # Text before the first value, between two values, and from the last value to the first of the next element.
    begin, starts = first.start(2), [match.start(2) for match in attributes]
    ends = [match.end(2) for match in attributes]
    head = text[: begin + starts[0]]
    between = [text[begin + end : begin + start] for end, start in zip(ends, starts[1:], strict=False)]
    turn = text[begin + ends[-1] : first.end()] + head.lstrip()
    close = text[begin + ends[-1] : first.end()].rstrip()
    rest = text.rstrip()
    if not rest.endswith(close):
        return None
    lines = rest[len(head) : len(rest) - len(close)].replace(turn, b"\n")
    for separator in between:
        lines = lines.replace(separator, b" ")
    columns = None if b"_" in lines else read_columns(lines + b"\n", len(names), dtype)
    return None if columns is None else [columns[attribute_names.index(name)] for name in names]


def _one_by_one(
    text: bytes, element: str, names: Sequence[str], optional: Sequence[str], dtype: type[np.generic]
) -> tuple[list[NDArray[Any]], dict[str, list[str | None]]]:
    # Prefixes are declared at the root of the document, which is not here: each tag keeps its local name only.
    local = re.sub(rb"<(/?)[\w.-]+:", rb"<\1", text)
    local = re.sub(rb"(\s)[\w.-]+:([\w.-]+\s*=)", rb"\1\2", local)
    try:
        rows = [row for row in ElementTree.fromstring(b"<_>" + local + b"</_>") if row.tag == element]
    except ElementTree.ParseError as error:
        raise InputError(f"damaged XML found ({error})", place=f"elements `{element}`") from None
    columns = []
    for name in names:
        texts = [row.get(name, "") for row in rows]
        try:
            column = np.array(texts, np.float64 if texts else dtype)
            if any("_" in word for word in texts) or (dtype is np.int32 and (column % 1 != 0).any()):
                raise ValueError
        except ValueError:
            kind = "whole number" if dtype is np.int32 else "number"
            number, word = next((k, word) for k, word in enumerate(texts) if not _is_number(word, dtype))
            problem = f"`{name}` is {word[:40]!r}, a {kind} expected"
            raise InputError(problem, place=f"{element} {number}") from None
        columns.append(column)
    return columns, {name: [row.get(name) for row in rows] for name in optional}


def _is_number(word: str, dtype: type[np.generic]) -> bool:
    try:
        value = float(word)
    except ValueError:
        return False
    return "_" not in word and (dtype is not np.int32 or value % 1 == 0)
