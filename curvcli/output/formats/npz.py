"""Tables as arrays of numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import TableFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping
    from threading import Event


def write(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int, stop: Event | None) -> None:
    """Write an array per column; the precision is that of the arrays."""
    from ..tables.write import write_npz

    write_npz(stream, columns)


register(TableFormat(suffix=".npz", description="table, numpy arrays", place=4, write=write))
