"""Content of a file of labels, and its recognition."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from numpy.typing import NDArray

from ...mesh.file import Labels

LabelledElement = Literal["vertex", "face", "polygon"]


@dataclass(frozen=True, eq=False)
class LabelFile:
    """Labels of the elements of a mesh.

    values: (n,) numbers, or names by code. element: what they belong to, None if their number decides. index: (n,) the
    element of each label, None for all in order. header: the first of the words may be a header.
    """

    values: NDArray[Any] | Labels
    element: LabelledElement | None = None
    index: NDArray[Any] | None = None
    header: bool = False
