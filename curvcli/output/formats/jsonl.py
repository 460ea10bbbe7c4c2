"""Tables as JSON objects, one line each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import TableFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping
    from threading import Event


def write(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int, stop: Event | None) -> None:
    """Write an object per row, with null for undefined values."""
    from ..tables.write import write_json_lines

    write_json_lines(stream, columns, precision, stop)


register(TableFormat(suffix=".jsonl", description="table, one JSON object a line", place=5, write=write))
