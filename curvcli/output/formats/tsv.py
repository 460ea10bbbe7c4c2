"""Tables separated by tabs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import TableFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping
    from threading import Event


def write(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int, stop: Event | None) -> None:
    """Write text that reads back to the same doubles."""
    from ..tables.write import write_text

    write_text(stream, columns, "\t", precision, stop)


register(TableFormat(suffix=".tsv", description="table, tab-separated", place=2, write=write))
