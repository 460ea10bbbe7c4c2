"""VTK XML files: the tree of elements, without the content of their arrays."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from ...errors import InputError

MOST_ELEMENTS = 1_000_000
"""Largest number of elements: files of partitioned data have some ten thousand."""

_DEPTH = 64
_ARRAYS = ("DataArray", "Array")
# A tag, whose attributes may contain `>` between quotes.
_TAG = re.compile(rb"<(?:[^<>\"']++|\"[^<\"]*+\"|'[^<']*+')*+>")


@dataclass
class XmlElement:
    """An element: its name, its attributes, its children, and the positions of its own text in the file."""

    name: str
    attributes: dict[str, str]
    children: list[XmlElement] = field(default_factory=list)
    text: list[slice] = field(default_factory=list)

    def all(self, *names: str) -> Iterator[XmlElement]:
        """The children of these names."""
        return (child for child in self.children if child.name in names)

    def arrays(self) -> Iterator[XmlElement]:
        """The arrays among the children."""
        return self.all(*_ARRAYS)


@dataclass
class Document:
    """The root, the comments, the element of appended data, and the position behind its start tag; -1 without it."""

    root: XmlElement
    comments: list[str]
    data: XmlElement | None = None
    appended: int = -1


def parse_document(data: bytes) -> Document:
    """Parse the elements of a VTK XML file. The texts of arrays and the appended data are not parsed.

    No entity is declared and no other file is opened.
    Errors: InputError for text that is no XML, a document type, or too many or too deep elements.
    """
    return _Scan(data).document()


class _Scan:
    """Markup goes to expat one tag at a time, so that the position of the text of an array is that behind its tag."""

    def __init__(self, data: bytes) -> None:
        self.data, self.count = data, 0
        self.stack: list[XmlElement] = []
        self.root: XmlElement | None = None
        self.comments: list[str] = []
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CommentHandler = self.comments.append

    def document(self) -> Document:
        at, size = 0, len(self.data)
        try:
            while at < size:
                begin = self.data.find(b"<", at)
                if begin < 0:
                    break
                if self.stack and self.stack[-1].name in _ARRAYS:
                    self.stack[-1].text.append(slice(at, begin))
                elif begin > at:
                    self.parser.Parse(self.data[at:begin], False)
                at = self._end_of_markup(begin)
                self.parser.Parse(self.data[begin:at], False)
                if self.stack and self.stack[-1].name == "AppendedData":
                    return Document(self.root or self.stack[0], self.comments, self.stack[-1], at)
            self.parser.Parse(self.data[at:], True)
        except expat.ExpatError as error:
            reason = expat.ErrorString(error.code)
            raise InputError(f"no well-formed XML found: {reason}", place=f"byte {at}") from None
        assert self.root is not None
        return Document(self.root, self.comments)

    def _end_of_markup(self, begin: int) -> int:
        """Position behind the tag, comment or instruction that begins here."""
        if self.data.startswith(b"<!DOCTYPE", begin):
            raise InputError("a document type declaration found, none expected", hint="entities are never expanded")
        for start, end in ((b"<!--", b"-->"), (b"<?", b"?>"), (b"<![", b"")):
            if self.data.startswith(start, begin):
                if not end:
                    raise InputError("a CDATA section found, arrays as VTK writes them expected", place=f"byte {begin}")
                position = self.data.find(end, begin)
                stop = position + len(end)
                break
        else:
            tag = _TAG.match(self.data, begin)
            position, stop = (begin, tag.end()) if tag else (-1, 0)
        if position < 0:
            raise InputError("the file ends within a tag", place=f"byte {begin}", hint="the file was cut off")
        return stop

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count > MOST_ELEMENTS:
            raise InputError(f"more than {MOST_ELEMENTS} XML elements found")
        if len(self.stack) >= _DEPTH:
            raise InputError(f"XML elements nested deeper than {_DEPTH} found")
        element = XmlElement(name, attributes)
        if self.stack:
            self.stack[-1].children.append(element)
        else:
            self.root = element
        self.stack.append(element)

    def _end(self, name: str) -> None:
        self.stack.pop()
