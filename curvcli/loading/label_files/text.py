"""Labels as text: a number or a word per line, or a table with a header and a column of vertices or faces."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...mesh.file import Labels
from ...support.words import escape_text
from .base import LabelFile, LabelledElement

_INDEX: dict[str, LabelledElement] = {
    "vertex": "vertex",
    "vertex_index": "vertex",
    "vertex_id": "vertex",
    "vno": "vertex",
}
_INDEX |= {"face": "face", "face_index": "face", "face_id": "face", "triangle": "face", "polygon": "polygon"}
_LABEL = ("label", "region", "parcel", "name")
_STARTS: tuple[tuple[str, LabelledElement], ...] = (
    ("vert", "vertex"),
    ("face", "face"),
    ("tria", "face"),
    ("poly", "polygon"),
)


def read_text(data: bytes) -> LabelFile:
    """Read labels from text.

    One column: a number or a word per line; a first line that is no number before numbers is a header, which may begin
    with `vertex` or `face`. Several: the header names the columns, `vertex` or `face` the element of each row, `label`,
    `region`, `parcel` or `name` the label; any name will do for the only other column. An empty cell is no label.
    Errors: InputError for other tables; ValueError for text that is not UTF-8.
    """
    text = data.decode("utf-8-sig")
    filled = filter(None, map(str.strip, io.StringIO(text, newline=None)))
    first, second = next(filled, ""), next(filled, "").split()
    separator = next((character for character in "\t,;" if character in first), None)
    indexed = len(second) > 1 and _is_number(second[0])
    if separator is None and indexed and first.split()[0].lower() in _INDEX and " " in first:
        return _table([line.split() for line in io.StringIO(text, newline=None) if line.strip()])
    if separator is None:
        numbers = _numbers(text)
        return _label_lines(text) if numbers is None else numbers
    try:
        rows = [row for row in csv.reader(io.StringIO(text, newline=""), delimiter=separator) if row]
    except csv.Error as error:
        raise InputError(f"{error}; a table expected") from None
    return _table(rows)


def _numbers(text: str) -> LabelFile | None:
    """Lines of numbers, behind a header or not; None for words."""
    lines = io.StringIO(text, newline=None)
    filled = filter(None, map(str.strip, lines))
    first, header = next(filled, ""), ""
    if not _is_number(first):
        header, first = first, next(filled, "")
    element = _element(header)
    if not _is_number(first):
        return None if first else LabelFile(np.empty(0), element)
    try:
        table = np.loadtxt(chain([first], lines), comments=None, ndmin=2)
        if table.shape[1] == 1:
            return LabelFile(table[:, 0], element)
    except ValueError:
        pass
    # Numbers that only Python accepts, or a word amid numbers.
    try:
        rest = list(filter(None, map(str.strip, io.StringIO(text, newline=None))))[bool(header) :]
        return LabelFile(np.array([float(line) for line in rest]), element)
    except ValueError:
        return None


def _element(header: str) -> LabelledElement | None:
    return next((element for start, element in _STARTS if header.strip('"').lower().startswith(start)), None)


def _label_lines(text: str) -> LabelFile:
    """Lines of words: all of them labels, or all but the first; quotes of CSV are removed."""
    lines = [line.strip() for line in io.StringIO(text, newline=None)]
    _refuse_mixed(lines, 1, "line")
    row = next((line.split() for line in lines if line), [])
    if len(row) > 1 and all(map(_is_number, row)):
        raise InputError(
            f"{len(row)} numbers in a line found, one label expected",
            hint="a first line `vertex label` makes it a table",
        )
    names = [line[1:-1].replace('""', '"') if line[:1] == line[-1:] == '"' else line for line in lines if line]
    return LabelFile(labels_of(names), _element(names[0]), header=True)


def _refuse_mixed(cells: list[str], begin: int, name: str) -> None:
    """Refuse numbers amid words: one of them is a slip. The first cell may be a header."""
    numbers = [_is_number(cell) for cell in cells]
    filled = [place for place, cell in enumerate(cells) if cell and place]
    if any(numbers[place] for place in filled) and not all(numbers[place] for place in filled):
        wrong = next(place for place in filled if not numbers[place])
        problem = f"{escape_text(cells[wrong])[:40]!r}, expected one whole number as elsewhere, or words everywhere"
        raise InputError(problem, place=f"{name} {wrong + begin}")


def labels_of(names: Iterable[str]) -> Labels:
    """Words as labels, in the order of first use; an empty word is no label."""
    number: dict[str, int] = {}
    codes = np.array([number.setdefault(name, len(number)) if name else -1 for name in names], np.int32)
    return Labels(codes, tuple(escape_text(name) for name in number))


def _table(rows: list[list[str]]) -> LabelFile:
    header = [cell.strip() for cell in rows[0]]
    names = [cell.lower() for cell in header]
    listed = escape_text(", ".join(header[:8]))[:80]
    if any(_is_number(cell) for cell in header):
        raise InputError(f"a table without a header found ({listed})", hint="`vertex,label` or `face,label` is one")
    for place, row in enumerate(rows):
        if len(row) != len(header):
            raise InputError(f"{len(row)} cells found, {len(header)} expected", place=f"row {place + 1}")
    index = next((name for name in _INDEX if name in names), None)
    others = [name for name in names if name not in _INDEX]
    label = next((name for name in _LABEL if name in others), others[0] if len(others) == 1 else None)
    if label is None:
        raise InputError(f"columns {listed} found", hint="name the column of labels `label`")
    cells = [row[names.index(label)].strip() for row in rows[1:]]
    values: NDArray[np.float64] | Labels
    if all(_is_number(cell) for cell in cells if cell):
        values = np.array([float(cell) if cell else -1 for cell in cells])
    else:
        _refuse_mixed(["", *cells], 1, "row")
        values = labels_of(cells)
    if index is None:
        return LabelFile(values)
    return LabelFile(values, _INDEX[index], _indices([row[names.index(index)] for row in rows[1:]], index))


def _indices(cells: list[str], name: str) -> NDArray[np.int64]:
    try:
        return np.array([int(cell) for cell in cells], np.int64)
    except (ValueError, OverflowError):
        row = next(
            place for place, cell in enumerate(cells) if not cell.strip().lstrip("+-").isdecimal() or len(cell) > 18
        )
        spelling = escape_text(cells[row])[:40]
        raise InputError(f"`{spelling}` found, a whole number of `{name}` expected", place=f"row {row + 2}") from None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
