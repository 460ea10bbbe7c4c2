"""Columns of vertices for programs of the cortex: GIFTI arrays, and FreeSurfer's curv."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import OverlayFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping


def require() -> None:
    """Errors: MissingExtraError without nibabel."""
    from ..overlays import require_nibabel

    require_nibabel()


def write_gifti(stream: BinaryIO, columns: Mapping[str, Any], faces: int) -> None:
    """Write every column as an array."""
    from ..overlays import write_gifti

    write_gifti(stream, columns, faces)


def write_curv(stream: BinaryIO, columns: Mapping[str, Any], faces: int) -> None:
    """Write the only column."""
    from ..overlays import write_curv

    write_curv(stream, columns, faces)


for place, suffix in enumerate((".shape.gii", ".func.gii"), 1):
    description = "GIFTI array of the column in the name, or of each of --color-by, float32"
    register(
        OverlayFormat(
            suffix=suffix, description=description, place=place, write=write_gifti, several=True, require=require
        )
    )
for place, suffix in enumerate((".curv", ".crv"), 3):
    description = "FreeSurfer's values of the column in the name, or of --color-by, float32"
    register(OverlayFormat(suffix=suffix, description=description, place=place, write=write_curv))
