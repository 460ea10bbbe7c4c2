"""A page as a test reads it: its elements in a tree, checked to be well formed on the way."""

from __future__ import annotations

import base64
import json
import zlib
from dataclasses import dataclass, field
from html.parser import HTMLParser
from typing import Any

import numpy as np
from numpy.typing import NDArray

VOID = {"meta", "link", "input", "br", "img", "hr"}
# Elements of SVG, which close themselves.
EMPTY = {"rect", "stop"}


@dataclass
class Element:
    tag: str
    attributes: dict[str, str | None]
    children: list[Element | str] = field(default_factory=list)

    def all(self, tag: str | None = None, **attributes: str) -> list[Element]:
        """Every element below with this tag and these attributes (`data_x` for `data-x`), in document order."""
        wanted = {name.replace("_", "-"): value for name, value in attributes.items()}
        found = []
        for child in self.children:
            if isinstance(child, Element):
                if tag in (None, child.tag) and wanted.items() <= child.attributes.items():
                    found.append(child)
                found += child.all(tag, **attributes)
        return found

    def one(self, tag: str | None = None, **attributes: str) -> Element:
        (found,) = self.all(tag, **attributes)
        return found

    @property
    def text(self) -> str:
        return "".join(child if isinstance(child, str) else child.text for child in self.children)


class Page(HTMLParser):
    """Parses a whole page; every element must be closed by its own end."""

    def __init__(self, content: bytes) -> None:
        super().__init__()
        self.root = Element("root", {})
        self._open = [self.root]
        self.feed(content.decode("utf-8"))
        self.close()
        assert self._open == [self.root], [element.tag for element in self._open]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert len(dict(attrs)) == len(attrs), (tag, attrs)
        element = Element(tag, dict(attrs))
        self._open[-1].children.append(element)
        if tag not in VOID:
            self._open.append(element)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert tag in EMPTY, tag
        self._open[-1].children.append(Element(tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop().tag == tag

    def handle_data(self, data: str) -> None:
        self._open[-1].children.append(data)

    def json(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self.root.one("script", id="data").text)
        return found

    def block(self, name: str, kind: str, width: int) -> NDArray[Any]:
        """The numbers of a block of data as rows."""
        raw = zlib.decompress(base64.b64decode(self.root.one("script", id=f"block-{name}").text))
        size = np.dtype(kind).itemsize
        planes = np.frombuffer(raw, np.uint8).reshape(size, -1)
        return np.ascontiguousarray(planes.T).view(kind).reshape(width, -1).T
