"""Attributes of legacy VTK files: scalars, vectors, normals, colours, texture coordinates and fields."""

from __future__ import annotations

from urllib.parse import unquote

from ...errors import InputError
from ...support.words import escape_text
from .attributes import Attribute
from .cursor import Cursor

_WIDTHS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6, "GLOBAL_IDS": 1, "PEDIGREE_IDS": 1, "EDGE_FLAGS": 1}


def read_attributes(cursor: Cursor, tokens: list[str], count: int | None) -> list[Attribute]:
    """The attribute that a line announces, or the arrays of a field; none for a table of colours.

    count: number of points or cells; None for a field of the whole file, whose arrays have numbers of their own.
    Errors: InputError for an unknown keyword, or arrays of another length.
    """
    keyword, size = tokens[0].upper(), len(tokens)
    if keyword == "FIELD" and size > 2:
        return _field(cursor, _count(tokens[2], cursor), count)
    if count is not None:
        if keyword == "SCALARS" and size > 2:
            width = _count(tokens[3], cursor) if size > 3 else 1
            if cursor.peek() == "LOOKUP_TABLE":
                cursor.line()
            return [_attribute(cursor, tokens[1], tokens[2], count, width)]
        if keyword in _WIDTHS and size > 2:
            role = "normals" if keyword == "NORMALS" else ""
            return [_attribute(cursor, tokens[1], tokens[2], count, _WIDTHS[keyword], role)]
        if keyword == "TEXTURE_COORDINATES" and size > 3:
            width = _count(tokens[2], cursor)
            return [_attribute(cursor, tokens[1], tokens[3], count, width, "texture")]
        if keyword == "COLOR_SCALARS" and size > 2:
            kind = "float" if cursor.text else "unsigned_char"
            return [_attribute(cursor, tokens[1], kind, count, _count(tokens[2], cursor))]
        if keyword == "LOOKUP_TABLE" and size > 2:
            cursor.numbers("float" if cursor.text else "unsigned_char", 4 * _count(tokens[2], cursor))
            return []
    line = escape_text(" ".join(tokens)[:60])
    raise InputError(f"`{line}` found, an attribute such as SCALARS or FIELD expected", place=cursor.place)


def _attribute(cursor: Cursor, name: str, kind: str, count: int, width: int, role: str = "") -> Attribute:
    if not 1 <= width < 10_000:
        raise InputError(f"{width} components found, 1 to 9999 expected", place=cursor.place)
    if kind.lower() == "string":
        return Attribute(unquote(name), cursor.words(count * width)[::width])
    values = cursor.numbers(kind, count * width)
    return Attribute(unquote(name), values if width == 1 else values.reshape(-1, width), role)


def _field(cursor: Cursor, arrays: int, count: int | None) -> list[Attribute]:
    attributes = []
    for _ in range(arrays):
        tokens = cursor.line()
        if tokens and tokens[0].upper() == "METADATA":
            cursor.skip_paragraph()
            tokens = cursor.line()
        if len(tokens) < 4:
            if len(tokens) == 1 and tokens[0] == "NULL_ARRAY":
                continue
            line = escape_text(" ".join(tokens)[:60])
            raise InputError(f"`{line}` found, name, components, number and type expected", place=cursor.place)
        width, rows = _count(tokens[1], cursor), _count(tokens[2], cursor)
        if count is not None and rows != count:
            raise InputError(f"array `{tokens[0][:40]}` of {rows} rows, {count} expected", place=cursor.place)
        if width:
            attributes.append(_attribute(cursor, tokens[0], tokens[3], rows, width))
    return attributes


def _count(text: str, cursor: Cursor) -> int:
    if not (text.isascii() and text.isdigit() and len(text) < 19):
        raise InputError(f"`{escape_text(text[:40])}` found, a whole number expected", place=cursor.place)
    return int(text)
