"""Groups of faces (the whole, components, regions) and pairwise sums over them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..support.arrays import Floats, Index
from ..support.cache import cached
from .incidence import Incidence


class Segments:
    """Members of groups, for sums by group.

    label: (n,) group of each member, -1 for none; None when every member is of the only group.
    """

    def __init__(self, label: Index | None, count: int, size: int) -> None:
        self.label, self.count, self.size = label, count, size

    @cached_property
    def _order(self) -> NDArray[np.int64] | None:
        """(n,) members without a group, then group after group; None if they stand so."""
        assert self.label is not None
        return None if (self.label[1:] >= self.label[:-1]).all() else stable_order(self.label, self.count)

    @cached_property
    def _runs(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """(G,) first place of each group in the order, and number of its members."""
        assert self.label is not None
        per_group = np.bincount(self.label + 1, minlength=self.count + 1)
        start = np.concatenate([[0], np.cumsum(per_group)])[1:]
        return start[:-1], per_group[1:]

    def gather(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values (n,) of the members of all groups, group after group; a view where they stand so."""
        if self.label is None:
            return values
        first = self._runs[0][0]
        return values[first:] if self._order is None else values[self._order[first:]]

    def members_of(self, group: int) -> NDArray[np.int64]:
        """Members of one group, in ascending order."""
        if self.label is None:
            return np.arange(self.size)
        start, per_group = self._runs
        place = slice(start[group], start[group] + per_group[group])
        return np.arange(place.start, place.stop) if self._order is None else self._order[place]

    def members(self) -> NDArray[np.int64]:
        """(G,) number of members of each group."""
        return np.array([self.size]) if self.label is None else self._runs[1]

    def _reduce(self, ufunc: np.ufunc, values: NDArray[Any], empty: float, **options: Any) -> NDArray[Any]:
        """(G,) reduction of the (n,) values of each group; `empty` for a group without members."""
        start, per_group = self._runs
        result = np.full(self.count, empty, options.get("dtype", values.dtype))
        filled = per_group > 0
        if filled.any():
            result[filled] = ufunc.reduceat(self.gather(values), start[filled] - start[0], **options)
        return result

    def sum(self, values: NDArray[np.generic]) -> NDArray[np.float64]:
        """(G,) sums over each group by pairwise summation, error O(log n · ε); nulls (NaN) are left out.

        values: (n,), one for each member.
        """
        numbers = np.asarray(values, np.float64)
        if np.isnan(numbers).any():
            numbers = np.where(np.isnan(numbers), 0.0, numbers)
        return np.array([numbers.sum()]) if self.label is None else self._reduce(np.add, numbers, 0.0)

    def count_of(self, members: NDArray[np.integer]) -> NDArray[np.int64]:
        """(G,) number of the given members in each group."""
        if self.label is None:
            return np.array([len(members)])
        return np.bincount(self.label[members] + 1, minlength=self.count + 1)[1:]

    def count_true(self, mask: NDArray[np.bool_]) -> NDArray[np.int64]:
        """(G,) number of members of each group where the (n,) mask holds."""
        if self.label is None:
            return np.array([np.count_nonzero(mask)])
        if self._order is None:
            return self._reduce(np.add, mask.view(np.int8), 0, dtype=np.int64)
        return self.count_of(np.flatnonzero(mask))

    def any(self, mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(G,) flag of each group: the mask holds for at least one member."""
        result: NDArray[np.bool_] = self.count_true(mask) > 0
        return result

    def max(self, values: Floats) -> Floats:
        """(G,) largest of the (n,) values in each group; NaN for a group without one."""
        if self.label is not None:
            return self._reduce(np.fmax, values, np.nan)
        largest = values.max(where=~np.isnan(values), initial=-np.inf)
        return np.array([np.nan if largest == -np.inf else largest])


def stable_order(label: Index, count: int) -> NDArray[np.int64]:
    """(n,) stable order of labels from -1 to count - 1, in linear time: numpy sorts 16-bit integers by radix."""
    if count < 1 << 15:
        return np.argsort(label.astype(np.int16), kind="stable")
    key = (label + 1).astype(np.uint32)
    order = np.argsort(key.astype(np.uint16), kind="stable")
    return order[np.argsort((key >> np.uint32(16)).astype(np.uint16)[order], kind="stable")]


@dataclass(frozen=True, eq=False)
class Groups:
    """A partition of a surface's faces, with the vertices that go with each part.

    kind: `whole`, `component` or `region`. count: G. face: (F,) group of each face. faces, vertices: the members of
    each group. names: of the groups; empty for numbers.
    """

    kind: str
    count: int
    face: Index
    faces: Segments
    vertices: Segments
    names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self.face.setflags(write=False)

    def scope(self, group: int) -> str:
        """Name of a group in checks and messages."""
        return self.kind if self.kind == "whole" else f"{self.kind} {self.names[group] if self.names else group}"

    def edges(self, surface: Incidence) -> Segments:
        """(E,) group of each edge as `Segments`."""
        return _edges(self, surface)

    def of(self, surface: Incidence, element: str) -> Segments:
        """The segments of `vertex`, `edge` or `face` values."""
        return self.edges(surface) if element == "edge" else {"vertex": self.vertices, "face": self.faces}[element]


@cached
def _edges(groups: Groups, surface: Incidence) -> Segments:
    lower_end, vertex = surface.edges.a, groups.vertices.label
    return Segments(None if vertex is None else vertex[lower_end], groups.count, len(lower_end))


def whole(surface: Incidence, kind: str = "whole", names: tuple[str, ...] = ()) -> Groups:
    """The whole surface as one group, unreferenced vertices included, whose values are null."""
    faces, vertices = (Segments(None, 1, size) for size in (surface.n_faces, surface.n_vertices))
    face = np.broadcast_to(np.int32(0), surface.n_faces)  # a view without memory of its own
    return Groups(kind, 1, face, faces, vertices, names)


def by_label(
    surface: Incidence, face: Index, count: int, kind: str, names: tuple[str, ...] = (), vertex: Index | None = None
) -> Groups:
    """Groups of faces that share no vertex, given the group of each face."""
    if count == 1:
        return whole(surface, kind, names)
    if vertex is None:
        vertex = np.full(surface.n_vertices, -1, np.int32)
        for corner in surface.faces.T:
            vertex[corner] = face
    faces, vertices = (Segments(label, count, len(label)) for label in (face, vertex))
    return Groups(kind, count, face, faces, vertices, names)
