"""Tables separated by commas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import TableFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping
    from threading import Event


def write(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int, stop: Event | None) -> None:
    """Write text that reads back to the same doubles."""
    from ..tables.write import write_text

    write_text(stream, columns, ",", precision, stop)


register(TableFormat(suffix=".csv", description="table, comma-separated", place=1, write=write))
