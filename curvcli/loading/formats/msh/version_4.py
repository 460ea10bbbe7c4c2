"""Entities, nodes and elements of Gmsh versions 4.0 and 4.1: blocks of one entity each."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from .elements import ElementBlocks, Elements, nodes_of
from .source import MshSection

Physical = dict[tuple[int, int], int]
"""Number of the first physical group by dimension and tag of an entity."""


def read_entities(section: MshSection, modern: bool) -> Physical:
    """The physical groups of entities. modern: version 4.1 or later."""
    physical: Physical = {}
    for dimension, count in enumerate(section.sizes(4).tolist()):
        for _ in range(count):
            tag = int(section.integers(1)[0])
            section.reals(3 if modern and not dimension else 6)
            groups = section.integers(int(section.sizes(1)[0]))
            if len(groups):
                physical[dimension, tag] = int(groups[0])
            if dimension:
                section.integers(int(section.sizes(1)[0]))
    return physical


def read_nodes(section: MshSection, modern: bool) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Tags (V,) and positions (V, 3), without parameters."""
    blocks, count = section.sizes(4 if modern else 2)[:2].tolist()
    tags, points = [np.empty(0, np.int64)], [np.empty((0, 3))]
    for _ in range(blocks):
        entity = section.integers(3).tolist()
        rows = int(section.sizes(1)[0])
        dimension = entity[0] if modern else entity[1]
        width = 3 + (dimension if entity[2] else 0)
        if not 3 <= width <= 6:
            raise InputError(f"entity of dimension {dimension} found, 0 to 3 expected", place="$Nodes")
        if modern:
            tags.append(section.sizes(rows))
            points.append(section.reals(rows * width).reshape(rows, width)[:, :3])
        else:
            numbers, positions = section.rows(rows, width)
            tags.append(numbers)
            points.append(positions[:, :3])
    return _checked(np.concatenate(tags), count, "$Nodes"), np.concatenate(points)


def read_elements(section: MshSection, modern: bool, physical: Physical) -> Elements:
    """All elements."""
    blocks, count = section.sizes(4 if modern else 2)[:2].tolist()
    read = ElementBlocks()
    for _ in range(blocks):
        first, second, kind = section.integers(3).tolist()
        rows = int(section.sizes(1)[0])
        dimension, tag = (first, second) if modern else (second, first)
        size = rows * (1 + nodes_of(kind))
        table = (section.sizes(size) if modern else section.integers(size)).reshape(rows, -1)
        group = physical.get((dimension, tag), 0)
        read.add(kind, table[:, 1:], np.full(rows, group), np.full(rows, tag))
    elements = read.elements()
    _checked(elements.sizes, count, "$Elements")
    return elements


def _checked(values: NDArray[np.int64], count: int, place: str) -> NDArray[np.int64]:
    if len(values) != count:
        raise InputError(f"{len(values)} found, {count} announced", place=place)
    return values
