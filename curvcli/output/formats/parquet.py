"""Tables in Apache Parquet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from ..registry import TableFormat, register

if TYPE_CHECKING:
    from collections.abc import Mapping
    from threading import Event


def write(stream: BinaryIO, columns: Mapping[str, Any], precision: str | int, stop: Event | None) -> None:
    """Write the columns with their types."""
    from ..tables.write import write_parquet

    write_parquet(stream, columns, precision, stop)


register(TableFormat(suffix=".parquet", description="table, Apache Parquet", place=3, write=write))
