"""Content parsed in every way it can come, from memory and from a file piece by piece: all must say the same."""

from __future__ import annotations

import tempfile
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.testing import assert_array_equal

from curvcli.errors import InputError
from curvcli.loading.formats.ply.parse import parse_ply
from curvcli.loading.formats.stl.parse import parse_stl
from curvcli.loading.pieces import Pieces
from curvcli.mesh.file import Labels, MeshFile

PARSERS = {"ply": parse_ply, "stl": parse_stl}


class Small(Pieces):
    """A few rows at a time, and a window that a header does not fit."""

    piece = 100
    window = 90


def parsed(kind: str, data: bytes, **options: Any) -> MeshFile:
    """The content of the data.

    Errors: InputError, if they cannot be parsed.
    """
    outcomes: list[MeshFile | InputError] = [_outcome(kind, Pieces(data), options)]
    for pieces in (Pieces, Small):
        with tempfile.TemporaryFile(buffering=0) as file:
            file.write(data)
            file.seek(0)
            outcomes.append(_outcome(kind, pieces(file), options))  # type: ignore[arg-type]
    for other in outcomes[1:]:
        if isinstance(outcomes[0], InputError) or isinstance(other, InputError):
            assert str(other) == str(outcomes[0])
        else:
            _same(outcomes[0], other)
    if isinstance(outcomes[0], InputError):
        raise outcomes[0]
    return outcomes[0]


def _outcome(kind: str, pieces: Pieces, options: dict[str, Any]) -> MeshFile | InputError:
    with pieces:
        try:
            return PARSERS[kind](pieces, **options)
        except InputError as error:
            return error


def _same(one: MeshFile, other: MeshFile) -> None:
    for each in fields(MeshFile):
        a, b = getattr(one, each.name), getattr(other, each.name)
        pairs = [(a[key], b[key]) for key in a | b] if isinstance(a, dict) else [(a, b)]
        for left, right in pairs:
            if isinstance(left, Labels):
                assert left.names == right.names
                left, right = left.codes, right.codes
            assert_array_equal(left, right)
            if isinstance(left, np.ndarray):
                assert left.dtype == right.dtype
