"""Token reader of text STL: facets with any line breaks, names and comments with any words."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import Labels
from ....support.words import pluralize
from ...limits import check_faces
from ...text import BLANK, NEWLINE, read_tokens, separates
from .solids import TextFacets, label_solids

Offsets = NDArray[np.intp]

# `facet normal x y z outer loop`, three times `vertex x y z`, `endloop endfacet`; the normal may be missing.
_NORMAL, _VERTEX = 4, 4
_FACETS = re.compile(rb"(?i)(?<=[ \n])facet (?:normal|outer) [^\n]*")
_COMMENT = re.compile(rb" #[^\n]*")
_PART = re.compile(rb"(?:normal|outer|loop|vertex|endloop|endfacet)(?= |$)|.*? (outer) loop(?= |$)")
_NAMES = (b"solid", b"endsolid")


def read_ascii_tokens(text: bytes, max_faces: int | None) -> TextFacets:
    """The corners (3, 3 F) of a tidy text, facet by facet: 21 tokens each, or 17 without a normal.

    Names and comments between facets may have any words but those of a whole facet.
    Errors: InputError with the line of the first unexpected token of a facet.
    """
    if b"#" in text:
        # The name on a `solid` line may contain the comment mark: a comment on it is recognised behind a facet only.
        text = _FACETS.sub(lambda match: _COMMENT.sub(b"", match[0]), text)
    tokens = _Tokens.of(text)
    every = np.arange(len(tokens.starts))
    facets = every[tokens.are(every, b"facet")]
    normal = tokens.are(facets + 1, b"normal")
    begun = normal | tokens.are(facets + 1, b"outer") | (facets + 1 == len(every))
    facets, normal = facets[begun], normal[begun]
    loops = facets + 1 + _NORMAL * normal
    expected = [(loops, b"outer"), (loops + 1, b"loop")]
    expected += [(loops + 2 + _VERTEX * k, b"vertex") for k in range(3)]
    expected += [(loops + 2 + _VERTEX * 3, b"endloop"), (loops + 3 + _VERTEX * 3, b"endfacet")]
    first_wrong = np.full(len(facets), len(expected))
    for k in reversed(range(len(expected))):
        first_wrong[~tokens.are(*expected[k])] = k
    whole = first_wrong == len(expected)
    begin, end = facets[whole], loops[whole] + 4 + _VERTEX * 3
    wrong = np.flatnonzero(~whole)
    wrong = wrong[(first_wrong[wrong] > 0) | ~tokens.in_name(facets[wrong], end)]
    if len(wrong):
        positions, word = expected[first_wrong[wrong[0]]]
        raise tokens.unexpected(int(positions[wrong[0]]), word.decode())
    check_faces(len(begin), max_faces)
    notices, solids = _between(tokens, begin, end)
    corners = (loops[whole] + 3)[:, None] + np.arange(3) * _VERTEX
    numbers = tokens.numbers((corners[:, :, None] + np.arange(3)).ravel())
    return TextFacets(np.ascontiguousarray(numbers.reshape(-1, 3).T), tuple(notices), solids)


@dataclass(frozen=True)
class _Tokens:
    """The tokens of a tidy text. starts: offset of each token. ends: offsets of the separators."""

    text: bytes
    data: NDArray[np.uint8]
    starts: Offsets
    ends: NDArray[np.bool_]

    @classmethod
    def of(cls, text: bytes) -> _Tokens:
        data = np.frombuffer(text, np.uint8)
        ends = separates(data)
        first = ~ends
        first[1:] &= ends[:-1]
        return cls(text, data, np.flatnonzero(first), ends)

    def are(self, tokens: Offsets, word: bytes) -> NDArray[np.bool_]:
        """Mask of the tokens equal to a word, in any case."""
        same = tokens < len(self.starts)
        if not same.any():
            return same
        at = self.starts[np.minimum(tokens, len(self.starts) - 1)]
        for k, letter in enumerate(word):
            same &= (self.data.take(at + k, mode="clip") | 32) == letter
        return np.asarray(same & self.ends.take(at + len(word), mode="clip"))

    def numbers(self, tokens: Offsets) -> NDArray[np.float64]:
        """The tokens at these ascending places as numbers."""
        if not len(tokens):
            return np.empty(0)
        wanted = np.zeros(len(self.starts), np.bool_)
        wanted[tokens] = True
        kept = np.zeros(len(self.data), np.bool_)
        kept[self.starts[0] :] = np.repeat(wanted, np.diff(self.starts, append=len(self.data)))
        kept[1:] &= ~(self.ends[1:] & self.ends[:-1])
        numbers, known = read_tokens(bytes(np.where(self.data[kept] == BLANK, NEWLINE, self.data[kept])), np.float64)
        if not known.all():
            raise self.unexpected(int(tokens[np.flatnonzero(~known)[0]]), "")
        return np.asarray(numbers, np.float64)

    def in_name(self, tokens: Offsets, end: Offsets) -> NDArray[np.bool_]:
        """Mask of the tokens behind `solid` or `endsolid` on their line, without the end of a facet between them."""
        every = np.arange(len(self.starts))
        named = np.append(-1, every[self.are(every, _NAMES[0]) | self.are(every, _NAMES[1])])
        name = named[np.searchsorted(named, tokens) - 1]
        since = np.append(0, end)[np.searchsorted(end, tokens, side="right")]
        newlines = np.flatnonzero(self.data == NEWLINE)
        lines = [np.searchsorted(newlines, self.starts[np.maximum(some, 0)]) for some in (name, tokens)]
        return np.asarray((name >= since) & (lines[0] == lines[1]))

    def line(self, offset: int) -> str:
        """Line number of a byte offset."""
        return f"line {1 + self.text.count(bytes([NEWLINE]), 0, offset)}"

    def unexpected(self, place: int, word: str) -> InputError:
        """The error for a token other than this word, or other than a number if the word is empty."""
        asked = f"`{word}` expected" if word else "a number expected"
        if place >= len(self.starts):
            return InputError(f"the data end inside a facet; {asked}", place=self.line(int(self.starts[-1])))
        offset = int(self.starts[place])
        token = self.text[offset : offset + 200].split()[0][:40].decode("utf-8", "backslashreplace")
        return InputError(f"`{token}` found, {asked}", place=self.line(offset))


def _between(tokens: _Tokens, begin: Offsets, end: Offsets) -> tuple[list[Notice], Labels]:
    """The notices of the text outside facets, which has ends and names of solids and other lines; and the solids.

    Errors: InputError for a part of a facet there.
    """
    text, bounds = tokens.text, np.append(tokens.starts, len(tokens.text))
    left, right = np.concatenate(([0], end)), np.append(begin, len(tokens.starts))
    solids, unknown, last = 0, 0, b""
    begins: list[int] = []
    names: list[bytes] = []
    for gap in np.flatnonzero(left < right).tolist():
        offset = int(bounds[left[gap]])
        own = text[offset : bounds[right[gap]]]
        last = own.lower()
        named = naming = False
        for line, spelt in zip(last.split(b"\n"), own.split(b"\n"), strict=True):
            if match := _PART.match(line):
                part = (match[1] or match[0]).decode()
                raise InputError(f"`{part}` outside a facet found", place=tokens.line(offset))
            if (tokens_of_line := line.split(b" ", 1))[0] in _NAMES:
                # If its line has no name, the next lines have it.
                named, naming = True, len(tokens_of_line) == 1
                if tokens_of_line[0] == _NAMES[0]:
                    begins.append(gap)
                    names.append(spelt.partition(b" ")[2])
            else:
                unknown += bool(line) and not naming
            offset += len(line) + 1
        solids += named and gap < len(begin)
    notices = []
    if solids > 1:
        hint = "`components` of the report keeps apart those that do not touch"
        notices.append(Notice("several_solids", solids, "solids, read as one surface", hint))
    if len(begin) and not (left[-1] < right[-1] and b"endsolid" in last):
        hint = "if it was cut off, faces are missing"
        notices.append(Notice("missing_endsolid", 1, "text that ends without `endsolid`", hint))
    if unknown:
        message = pluralize(unknown, "[statement|statements] that STL does not know, ignored")
        notices.append(
            Notice("unknown_statements", unknown, message, "facets are triangles between `facet` and `endfacet`")
        )
    return notices, label_solids(begins, names, len(begin))
