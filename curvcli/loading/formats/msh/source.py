"""Numbers of a section of a Gmsh file, as text or as bytes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....support.words import number_of
from ...vtk.decode import numbers_of_text


@dataclass
class MshSection:
    """Consecutive numbers. values: of a text. order: byte order of a binary section. word: bytes of a large count."""

    name: str
    data: bytes
    at: int
    end: int
    order: str = "<"
    word: int = 8
    values: NDArray[np.float64] | None = None

    @classmethod
    def of_text(cls, name: str, data: bytes, begin: int, end: int) -> MshSection:
        """The section of a text file. Errors: InputError for a word that is no number."""
        text = data[begin:end]
        try:
            values = numbers_of_text(text, np.dtype(np.float64), None)
        except InputError as error:
            error.place = f"${name}"
            raise
        return cls(name, data, 0, len(values), values=values)

    def integers(self, count: int) -> NDArray[np.int64]:
        """The next whole numbers of 32 bits."""
        return self._integers(count, 4)

    def sizes(self, count: int) -> NDArray[np.int64]:
        """The next counts or tags, in the word size of the file."""
        return self._integers(count, self.word)

    def reals(self, count: int) -> NDArray[np.float64]:
        """The next fractions."""
        if self.values is not None:
            return self._of_text(count)
        return np.frombuffer(self._bytes(8 * count), f"{self.order}f8").astype(np.float64, copy=False)

    def rows(self, count: int, reals: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The next rows of a whole number and so many fractions."""
        if self.values is not None:
            table = self._of_text(count * (1 + reals)).reshape(count, 1 + reals)
            return self._whole(table[:, 0]), table[:, 1:]
        kind = np.dtype([("tag", f"{self.order}i4"), ("reals", f"{self.order}f8", (reals,))])
        records: NDArray[Any] = np.frombuffer(self._bytes(count * kind.itemsize), kind)
        return records["tag"].astype(np.int64), records["reals"].astype(np.float64)

    @property
    def left(self) -> int:
        """Numbers of a text, or bytes, that are left."""
        return self.end - self.at

    def _integers(self, count: int, width: int) -> NDArray[np.int64]:
        if self.values is not None:
            return self._whole(self._of_text(count))
        return np.frombuffer(self._bytes(width * count), f"{self.order}i{width}").astype(np.int64, copy=False)

    def _of_text(self, count: int) -> NDArray[np.float64]:
        assert self.values is not None
        self._check(count, "number")
        self.at += count
        return self.values[self.at - count : self.at]

    def _bytes(self, count: int) -> memoryview:
        self._check(count, "byte")
        self.at += count
        return memoryview(self.data)[self.at - count : self.at]

    def _check(self, count: int, what: str) -> None:
        if not 0 <= count <= self.left:
            problem = f"{number_of(count, what)} announced, {self.left} found"
            raise InputError(problem, place=f"${self.name}", hint="the file was cut off, or a count is wrong")

    def _whole(self, values: NDArray[Any]) -> NDArray[np.int64]:
        with np.errstate(invalid="ignore"):
            whole = values.astype(np.int64)
        wrong = np.flatnonzero(whole != values)
        if len(wrong):
            raise InputError(f"`{values[wrong[0]]:g}` found, a whole number expected", place=f"${self.name}")
        return whole
