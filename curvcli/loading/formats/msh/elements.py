"""Elements of a Gmsh file, and their types."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from .element_types import TYPES


@dataclass(frozen=True)
class Elements:
    """Tags of nodes of all elements, concatenated; per element the number of nodes, type of VTK, group and entity.

    groups: number of the physical group, 0 for none.
    """

    nodes: NDArray[np.int64]
    sizes: NDArray[np.int64]
    kinds: NDArray[np.uint8]
    groups: NDArray[np.int64]
    entities: NDArray[np.int64]


class ElementBlocks:
    """Elements gathered block by block."""

    def __init__(self) -> None:
        self.nodes: list[NDArray[np.int64]] = []
        self.columns: list[tuple[int, int, int]] = []
        self.groups: list[NDArray[np.int64]] = []
        self.entities: list[NDArray[np.int64]] = []

    def add(self, kind: int, nodes: NDArray[np.int64], groups: NDArray[np.int64], entities: NDArray[np.int64]) -> None:
        """Add elements of a type of Gmsh: nodes (n, k), group and entity of each."""
        self.nodes.append(nodes.reshape(-1))
        self.columns.append((TYPES[kind][0], nodes.shape[1], len(nodes)))
        self.groups.append(groups)
        self.entities.append(entities)

    def elements(self) -> Elements:
        """All elements."""
        kinds, sizes, counts = np.array(self.columns, np.int64).reshape(-1, 3).T
        return Elements(
            _joined(self.nodes),
            np.repeat(sizes, counts),
            np.repeat(kinds.astype(np.uint8), counts),
            _joined(self.groups),
            _joined(self.entities),
        )


def _joined(arrays: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    return arrays[0] if len(arrays) == 1 else np.concatenate([np.empty(0, np.int64), *arrays])


def nodes_of(kind: int) -> int:
    """Number of nodes of a type of Gmsh. Errors: InputError for an unknown type."""
    if kind not in TYPES:
        raise InputError(f"element type {kind} found, a type of Gmsh expected", place="$Elements")
    return TYPES[kind][1]
