"""Numbered rows of a section: numbers, then attributes by name."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....support.words import number_of
from ...text import NEWLINE, read_columns, read_tokens, separates
from .text import SectionLines

COLOURS = (
    *("clear", "black", "blue", "green", "cyan", "red", "magenta", "brown", "lightgray", "darkgray", "lightblue"),
    *("lightgreen", "lightcyan", "lightred", "lightmagenta", "yellow", "white"),
)
"""Names of colours, from number -1 on."""
_EXPRESSION = "expressions are not evaluated; the Evolver's command `dump` writes numbers"
_BOUNDARY = "the Evolver's `unset vertex boundary N`, then `dump`, writes coordinates"


class ElementRows:
    """Rows of a section.

    id: (n,) number of each element. values: the numbers behind it, concatenated. sizes: how many, an int for all or
    (n,). attributed: rows with words behind their numbers.
    """

    def __init__(self, lines: SectionLines, name: str) -> None:
        self.lines, self.name = lines, name
        self.count = len(lines.numbers)
        self.attributed = 0
        self._starts: NDArray[np.int64] | None = None
        width = len(lines.text[: lines.text.find(b"\n")].split())
        columns = read_columns(lines.text, width, np.float64) if self.count and 1 < width < 20 else None
        if columns is None:
            self._read_words()
            return
        self.id = self._numbers_of_elements(np.asarray(columns[0]))
        self.sizes: int | NDArray[np.int64] = width - 1
        self.values: NDArray[np.float64] = np.stack(columns[1:], axis=1).reshape(-1).astype(np.float64, copy=False)

    def _read_words(self) -> None:
        if not self.count:
            self.id, self.sizes, self.values = np.empty(0, np.int64), 0, np.empty(0)
            return
        numbers, known = read_tokens(self.lines.text, np.float64)
        self._letters = np.frombuffer(self.lines.text, np.uint8)
        separators = np.flatnonzero(separates(self._letters))
        self._starts = np.concatenate(([0], separators[:-1] + 1))
        self._ends = np.flatnonzero(self._letters[separators] == NEWLINE) + 1
        self._numbers, self._known = np.asarray(numbers, np.float64), known
        begins = np.concatenate(([0], self._ends[:-1]))
        word_tokens = np.flatnonzero(~known)
        first = np.append(word_tokens, len(known))[np.searchsorted(word_tokens, begins)]
        behind = np.minimum(first, self._ends)
        self._refuse_expressions(behind)
        self.attributed = int(np.count_nonzero(behind < self._ends))
        self.sizes = behind - begins - 1
        self.id = self._numbers_of_elements(self._numbers[begins])
        inside = np.zeros(len(known) + 1, np.int8)
        inside[begins + 1] += 1
        inside[behind] -= 1
        self.values = self._numbers[np.cumsum(inside[:-1], dtype=np.int8).view(np.bool_)]

    def _refuse_expressions(self, behind: NDArray[np.int64]) -> None:
        """Refuse words behind the numbers of an element that do not begin like a name."""
        rows = np.flatnonzero(behind < self._ends)
        assert self._starts is not None
        letter = self._letters[self._starts[behind[rows]]] | 32
        odd = np.flatnonzero(~((letter >= ord("a")) & (letter <= ord("z"))) & (letter != ord("_") | 32))
        if len(odd):
            row = int(rows[odd[0]])
            self._refuse_boundary(row)
            problem = f"`{self._word(int(behind[row]))}` found, a number or an attribute expected"
            raise InputError(problem, place=self.lines.place(row), hint=_EXPRESSION)

    def _word(self, token: int) -> str:
        assert self._starts is not None
        begin = int(self._starts[token])
        return self.lines.text[begin : begin + 40].split()[0].decode("utf-8", "backslashreplace")

    def _numbers_of_elements(self, numbers: NDArray[np.float64]) -> NDArray[np.int64]:
        wrong = np.flatnonzero(~((numbers >= 1) & (numbers < 2**53) & (numbers % 1 == 0)))
        if len(wrong):
            raise InputError(
                f"no number of a {self.name} found, 1 or more expected", place=self.lines.place(int(wrong[0]))
            )
        return numbers.astype(np.int64)

    def require(self, least: int, most: int | None, expected: str) -> None:
        """Check how many numbers each row has. Errors: InputError with the first row of another number."""
        sizes = np.broadcast_to(np.asarray(self.sizes, np.int64), self.count)
        wrong = np.flatnonzero((sizes < least) | (sizes > (most or self.values.size)))
        if len(wrong):
            row = int(wrong[0])
            self._refuse_boundary(row)
            hint = _EXPRESSION if sizes[row] < least else None
            problem = f"{self.name} with {number_of(int(sizes[row]), 'number')} found, {expected} expected"
            raise InputError(problem, place=self.lines.place(row), hint=hint)

    def _refuse_boundary(self, row: int) -> None:
        """Refuse a vertex with parameters of a boundary instead of coordinates."""
        if row in self._rows_of(self._tokens("boundary")):
            problem = f"{self.name} on a boundary found, whose position is an expression; coordinates expected"
            raise InputError(problem, place=self.lines.place(row), hint=_BOUNDARY)

    def attribute(self, word: str) -> NDArray[np.float64] | None:
        """(n,) the number behind a word in each row, NaN for none; None if no row has it."""
        tokens = self._tokens(word)
        tokens = tokens[tokens + 1 < len(self._known)] if len(tokens) else tokens
        tokens = tokens[self._known[tokens + 1]] if len(tokens) else tokens
        if not len(tokens):
            return None
        rows = self._rows_of(tokens)
        same = rows == self._rows_of(tokens + 1)
        values = np.full(self.count, np.nan)
        values[rows[same]] = self._numbers[tokens[same] + 1]
        return values

    def colours(self) -> NDArray[np.int32] | None:
        """(n,) number of the colour of each row, 15 (white) for none; None if no row has one."""
        numbers = self.attribute("color")
        colour = (
            np.full(self.count, 15, np.int32)
            if numbers is None
            else np.nan_to_num(numbers, nan=15).clip(-1, 2**31 - 1).astype(np.int32)
        )
        color_tokens = self._tokens("color")
        if not len(color_tokens):
            return None
        for number, name in enumerate(COLOURS, -1):
            tokens = np.intersect1d(color_tokens + 1, self._tokens(name), assume_unique=True)
            colour[self._rows_of(tokens)] = number
        return colour

    def _rows_of(self, tokens: NDArray[Any]) -> NDArray[np.int64]:
        return np.searchsorted(self._ends, tokens, side="right") if len(tokens) else np.empty(0, np.int64)

    def _tokens(self, word: str) -> NDArray[np.int64]:
        """Tokens that are a word, in any case."""
        if self._starts is None:
            return np.empty(0, np.int64)
        candidates = np.flatnonzero(~self._known)
        at = self._starts[candidates]
        match = np.ones(len(at), np.bool_)
        for k, letter in enumerate(word.lower().encode()):
            letters = self._letters.take(at + k, mode="clip")
            match &= (letters | 32 if chr(letter).isalpha() else letters) == letter
        behind = self._letters.take(at + len(word), mode="clip")
        tokens: NDArray[np.int64] = candidates[match & separates(behind)]
        return tokens


def row_of_numbers(ids: NDArray[np.int64], wanted: NDArray[Any], rows: ElementRows, name: str) -> NDArray[np.int32]:
    """The row of each wanted number. Errors: InputError for a number that no element has, or that two have."""
    consecutive = bool(len(ids)) and bool((ids == np.arange(1, len(ids) + 1)).all())
    if consecutive and wanted.min(initial=1) >= 1 and wanted.max(initial=1) <= len(ids) and (wanted % 1 == 0).all():
        return wanted.astype(np.int32) - np.int32(1)
    order = np.argsort(ids, kind="stable")
    ordered = ids[order]
    twice = np.flatnonzero(ordered[1:] == ordered[:-1])
    if len(twice):
        raise InputError(f"two elements with the number {int(ordered[twice[0]])} found", place=f"section of {name}")
    at = np.searchsorted(ordered, wanted)
    known = at < len(ordered)
    known[known] = ordered[at[known]] == wanted[known]
    wrong = np.flatnonzero(~known)
    if len(wrong):
        row = int(
            np.searchsorted(np.cumsum(np.broadcast_to(np.asarray(rows.sizes), rows.count)), wrong[0], side="right")
        )
        problem = f"{rows.name} of {name} {wanted[wrong[0]]:g} found, which does not exist"
        raise InputError(problem, place=rows.lines.place(row))
    return order[at].astype(np.int32)
