"""Memory that a Parquet file needs, from its metadata and page headers, before any of it is unpacked."""

from __future__ import annotations

import io
from typing import Any

from ..errors import InputError
from .content import too_large

_TRUE, _FALSE = 1, 2  # types of fields without further bytes
# The metadata of these files nest 5 levels deep.
_DEEPEST = 16


def check_parquet(data: bytes, limit: int) -> None:
    """Raise InputError for columns other than numbers and words, or for more than `limit` bytes of unpacked data.

    The size is 8 bytes per number or the sum of the page headers, whichever is larger.
    """
    import polars as pl

    schema = pl.read_parquet_schema(io.BytesIO(data))
    nested = [name for name, kind in schema.items() if kind.is_nested() or kind in (pl.Binary, pl.Object)]
    if nested:
        raise InputError(f"column `{nested[0]}` holds neither numbers nor words")
    try:
        size = _unpacked(data)
    except (IndexError, KeyError, TypeError, ValueError, RecursionError):
        raise InputError("cannot be read as a table: a damaged record of its pages") from None
    if size > limit:
        raise too_large(f"a table that unpacks to {size} bytes", limit)


def _unpacked(data: bytes) -> int:
    """Bytes of all cells or of all pages, whichever are more; the record stands at the end, before its length."""
    length = int.from_bytes(data[-8:-4], "little")
    record = _Compact(data, len(data) - 8 - length).struct()
    cells = pages = seen = 0
    for group in record[4]:
        for column in group[1]:
            about = column[3]
            cells += 8 * max(group[3], about[5])
            at = min(about[9], about.get(11) or about[9])
            end = at + about[7]
            while at < end:
                header = _Compact(data, at)
                page = header.struct()
                seen += 1
                if page[2] < 0 or page[3] < 0 or seen > len(data):
                    raise ValueError("pages that overlap")
                pages += page[2]
                at = header.at + page[3]
    return int(max(cells, pages, 8 * record[3]))


class _Compact:
    """Values of Thrift's compact protocol, one after the other; a struct is a dict by the numbers of its fields.

    Source: https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md
    """

    def __init__(self, data: bytes, at: int) -> None:
        self.data, self.at, self._depth = data, at, 0

    def struct(self) -> dict[int, Any]:
        """Read a struct at the present position."""
        self._depth += 1
        if self._depth > _DEEPEST or self.at < 0:
            raise ValueError("too deep")
        result: dict[int, Any] = {}
        number = 0
        while head := self._byte():
            number = number + (head >> 4) if head >> 4 else self._integer()
            kind = head & 15
            result[number] = kind == _TRUE if kind in (_TRUE, _FALSE) else self._value(kind)
        self._depth -= 1
        return result

    def _byte(self) -> int:
        self.at += 1
        return self.data[self.at - 1]

    def _unsigned(self) -> int:
        value = shift = 0
        while True:
            byte = self._byte()
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value
            if shift > 63:
                raise ValueError("too long a number")

    def _integer(self) -> int:
        value = self._unsigned()
        return (value >> 1) ^ -(value & 1)

    def _value(self, kind: int) -> Any:
        """Read a value of a type number of the protocol: integers, bytes, doubles, strings, lists, structs."""
        match kind:
            case 4 | 5 | 6:
                return self._integer()
            case 1 | 2 | 3:
                return self._byte()
            case 7:
                self.at += 8
                return None
            case 8:
                length = self._unsigned()
                self.at += length
                return None
            case 9 | 10:
                head = self._byte()
                count = head >> 4 if head >> 4 < 15 else self._unsigned()
                return [self._value(head & 15) for _ in range(count)]
            case 12:
                return self.struct()
        raise ValueError("an unknown type")
