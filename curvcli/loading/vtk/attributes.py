"""Arrays of points and cells as properties and labels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import Notice
from ...mesh.file import Labels
from ...support.words import escape_text, pluralize

_COLORS = {"rgb", "rgba", "color", "colors", "colour", "colours"}
_CHANNELS = ("red", "green", "blue", "alpha")


@dataclass(frozen=True)
class Attribute:
    """Values of points or cells: (n,), (n, k), or n words, None for none.

    names: of the k components, where the file gives them. role: `normals` or `texture`, or empty.
    """

    name: str
    values: NDArray[Any] | Sequence[str | None]
    role: str = ""
    names: tuple[str, ...] = ()

    @property
    def layout(self) -> int:
        """Number of components; 0 for words."""
        return 0 if not isinstance(self.values, np.ndarray) else self.values.shape[-1] if self.values.ndim > 1 else 1

    def columns(self) -> dict[str, NDArray[Any]]:
        """Numbers by name, one column per component: `_x`, `_y`, `_z` of three, colours, else by index."""
        if not isinstance(self.values, np.ndarray):
            return {}
        if self.values.ndim == 1 or self.values.shape[1] == 1:
            return {self.name: self.values.reshape(-1)}
        count = self.values.shape[1]
        if self.values.dtype == np.uint8 and count in (3, 4) and self.name.lower() in _COLORS:
            names: Iterable[str] = _CHANNELS[:count]
        elif len(set(self.names)) == count and all(self.names):
            names = [f"{self.name}_{part}" for part in self.names]
        else:
            names = [f"{self.name}_{part}" for part in ("xyz" if count == 3 else range(count))]
        return {name: np.ascontiguousarray(self.values[:, k]) for k, name in enumerate(names)}


def concatenate_attributes(pieces: Sequence[Sequence[Attribute]], notices: list[Notice]) -> list[Attribute]:
    """The arrays of consecutive pieces as one; an array that a piece lacks is dropped, with a notice."""
    if len(pieces) == 1:
        return list(pieces[0])
    by_name = [{attribute.name: attribute for attribute in piece} for piece in pieces]
    names = dict.fromkeys(name for piece in by_name for name in piece)
    kept, dropped = [], []
    for name in names:
        arrays = [piece[name] for piece in by_name if name in piece]
        if len(arrays) < len(pieces) or len({part.layout for part in arrays}) > 1:
            dropped.append(name)
        elif arrays[0].layout:
            numbers = np.concatenate([np.asarray(part.values) for part in arrays])
            kept.append(Attribute(name, numbers, arrays[0].role, arrays[0].names))
        else:
            kept.append(Attribute(name, [word for part in arrays for word in part.values]))
    notices += ignored(dropped, "that some pieces lack", "the arrays of a mesh need a value in every piece")
    return kept


def ignored(names: Sequence[str], reason: str, hint: str) -> list[Notice]:
    """The notice for arrays that are not kept; none for no names."""
    if not names:
        return []
    listed = escape_text(", ".join(name[:40] for name in names[:5]))
    message = f"{pluralize(len(names), '[array|arrays]')} {reason}, ignored: {listed}"
    return [Notice("ignored_arrays", len(names), message, hint)]


def properties(attributes: Iterable[Attribute]) -> dict[str, NDArray[Any]]:
    """Numbers by name. The columns of a vector that stand beside it under the same names are kept as they are."""
    columns: dict[str, NDArray[Any]] = {}
    vectors = []
    for attribute in attributes:
        if attribute.layout > 1:
            vectors.append(attribute)
        columns |= attribute.columns() if attribute.layout == 1 else {}
    for vector in vectors:
        columns = {**vector.columns(), **columns}
    order = [name for attribute in attributes for name in attribute.columns()]
    return {name: columns[name] for name in dict.fromkeys(order)}


def labels(attributes: Iterable[Attribute], meanings: Mapping[str, tuple[str, ...]]) -> dict[str, Labels]:
    """Arrays of words, and of codes whose names are known, as labels."""
    by_name: dict[str, Labels] = {}
    for attribute in attributes:
        values = attribute.values
        if not isinstance(values, np.ndarray):
            number: dict[str | None, int] = {None: -1}
            codes = np.array([number.setdefault(word, len(number) - 1) for word in values], np.int32)
            del number[None]
            by_name[attribute.name] = Labels(codes, tuple(word for word in number if word is not None))
        elif (names := meanings.get(attribute.name)) and _are_codes(values, len(names)):
            by_name[attribute.name] = Labels(values.astype(np.int32), names)
    return by_name


def _are_codes(values: NDArray[Any], names: int) -> bool:
    """Test for indices of so many names, or -1."""
    integers = values.ndim == 1 and values.dtype.kind in "iu" and len(values) > 0
    return integers and -1 <= int(values.min()) <= int(values.max()) < names
