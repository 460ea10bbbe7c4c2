"""Lines of an OBJ file by keyword, with comments and continuations removed where necessary."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ...text import BLANK, NEWLINE, Records, Untidy, line_starts, pick_lines, read_records, tidy, without_comments


@dataclass(frozen=True)
class ObjLines:
    """An OBJ text, its line starts, the first two bytes of each line, and the line's number in the file (from 0).

    tidied: True for a tidy text, in which a malformed number is an error.
    """

    data: bytes
    starts: NDArray[np.int64]
    kind: NDArray[np.uint16]
    numbers: NDArray[np.int64] | None
    tidied: bool

    def of(self, letter: str) -> NDArray[np.bool_]:
        """Mask of the lines whose keyword is one letter."""
        lines: NDArray[np.bool_] = self.kind == ord(letter) + 256 * BLANK
        alone = self.kind == ord(letter) + 256 * NEWLINE
        return lines | alone if alone.any() else lines

    def place(self, line: int) -> str:
        """A line as errors name it."""
        return f"line {int(line if self.numbers is None else self.numbers[line]) + 1}"

    def text(self, line: int) -> bytes:
        """One line without its end."""
        return self.data[self.starts[line] : self.starts[line + 1]].strip()

    def records(self, lines: NDArray[np.bool_], dtype: type[np.generic], expected: str) -> Records:
        """The numbers in these lines.

        Errors: Untidy if the text must be tidied first, InputError with the line if it is tidy.
        """
        try:
            return read_records(pick_lines(self.data, self.starts, lines), dtype)
        except Untidy as untidy:
            if not self.tidied:
                raise
            line = int(np.flatnonzero(lines)[untidy.row])
            token = untidy.token.decode("utf-8", "backslashreplace")
            raise InputError(f"`{token}` found, {expected} expected", place=self.place(line)) from None


def split_lines(data: bytes, numbers: NDArray[np.int64] | None = None, *, tidied: bool = False) -> ObjLines:
    """Split a text that ends with a line end."""
    text = np.frombuffer(data, np.uint8)
    starts = line_starts(text)
    first, second = text[starts[:-1]], text.take(starts[:-1] + 1, mode="clip")
    kind = second.astype(np.uint16)
    kind <<= np.uint16(8)
    kind |= first
    if not tidied and ((first == BLANK).any() or (b"\\" in data and b"\\\n" in data)):
        raise Untidy
    return ObjLines(data, starts, kind, numbers, tidied)


def tidy_lines(data: bytes) -> ObjLines:
    """Remove comments and join continued lines."""
    data = tidy(data)
    if b"#" in data:
        data = tidy(without_comments(data))
    if b"\\\n" not in data:
        return split_lines(data, tidied=True)
    text = np.frombuffer(data, np.uint8)
    ends = np.flatnonzero(text == NEWLINE)
    joined = (text[np.maximum(ends, 1) - 1] == ord("\\")) & (ends > 0)
    numbers = np.flatnonzero(np.concatenate(([True], ~joined[:-1])))
    data = tidy(data.replace(b"\\\n", b" "))
    return split_lines(data if data.endswith(b"\n") else data + b"\n", numbers, tidied=True)
