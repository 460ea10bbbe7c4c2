"""Mesh writers by suffix, and the input's own properties beside ours."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, BinaryIO, Unpack

import numpy as np
from numpy.typing import NDArray

from ...errors import Notice
from ...support.words import pluralize
from ..registry import MeshFormat, output_formats
from ..tables.write import Column
from .attributes import MeshAttributes

_POSITION = ("x", "y", "z")
# Alpha belongs to the input's colours: a viewer blends it with any others.
_COLOR = ("red", "green", "blue", "alpha")


def write_mesh(
    stream: BinaryIO,
    suffix: str,
    points: NDArray[np.float64],
    faces: NDArray[np.integer[Any]],
    **attributes: Unpack[MeshAttributes],
) -> tuple[Notice, ...]:
    """Write points (V, 3) and faces (F, 3) in the format of the suffix, with those parts that the format has.

    Returns notices of what the format cannot hold. Errors: ValueError for a suffix of no mesh.
    """
    format = output_formats().get(suffix)
    if not isinstance(format, MeshFormat):
        raise ValueError(f"{suffix}: no mesh is written with this suffix")
    return format.write(stream, points, faces, **attributes)


def beside_input(
    ours: Mapping[str, Column], inputs: Mapping[str, Column], *, colored: bool = False
) -> tuple[dict[str, Column], tuple[Notice, ...]]:
    """Properties of the input, followed by ours; the input's becomes `input_NAME` if the names are equal.

    colored: our own colours are written too, so that the input's red, green, blue and alpha are renamed.
    """
    taken = {*ours, *_POSITION, *(_COLOR if colored else ())}
    merged: dict[str, Column] = {}
    renamed = []
    for name, column in inputs.items():
        free = name
        while free in taken or free in merged or (free != name and free in inputs):
            free = f"input_{free}"
        if free != name:
            renamed.append(f"{name} -> {free}")
        merged[free] = column
    merged |= ours
    if not renamed:
        return merged, ()
    message = pluralize(len(renamed), "[property|properties] of the input with a name that is taken: ") + ", ".join(
        renamed
    )
    return merged, (Notice("renamed_properties", len(renamed), message, "the values are kept under the new names"),)
