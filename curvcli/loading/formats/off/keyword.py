"""The first word of an OFF file: the data of each vertex."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ....errors import InputError

SIGN = re.compile(rb"(?:\xef\xbb\xbf)?(?:\s*+#[^\r\n]*+[\r\n])*+\s*+((?:ST|[CN4n])*OFF)(?=[\s#\d]|$)")
_FIELDS = re.compile(r"ST|[CN]")
_NAMES = {"N": ("nx", "ny", "nz"), "C": ("red", "green", "blue", "alpha"), "ST": ("s", "t")}


@dataclass(frozen=True)
class Keyword:
    """Data of each vertex behind its position, in the order of the numbers: `N`, `C`, `ST`.

    The letters are read backwards: CNOFF has normals before colours, and NCOFF colours before normals.
    """

    word: str
    fields: tuple[str, ...]

    def columns(self, width: int) -> dict[str, int] | None:
        """The place of each property in rows of this many numbers, the first three being the position.

        A colour may lack alpha. None for rows too short; further numbers have no name.
        """
        names: list[str] = []
        missing = max(0, self.most - width)
        for field in self.fields:
            names += _NAMES[field][: 3 if field == "C" and missing == 1 else None]
        if 3 + len(names) > width:
            return None
        return {name: 3 + k for k, name in enumerate(names)}

    @property
    def most(self) -> int:
        """Numbers per vertex, with alpha."""
        return 3 + sum(len(_NAMES[field]) for field in self.fields)


def parse_keyword(word: str) -> Keyword:
    """Parse the first word; empty if the file has none.

    Errors: InputError for positions that are not three numbers.
    """
    letters = word.removesuffix("OFF")
    if "4" in letters or "n" in letters:
        kind = "homogeneous positions of four numbers" if "4" in letters else "positions of any dimension"
        hint = "OFF with x, y, z divided by w" if "4" in letters else "OFF with x, y, z only"
        raise InputError(f"`{word[:20]}` found, {kind}; positions of three numbers expected", hint=f"write {hint}")
    fields = tuple(reversed(_FIELDS.findall(letters)))
    if len(set(fields)) < len(fields):
        raise InputError(f"`{word[:20]}` found, each of the letters C, N and ST expected at most once")
    return Keyword(word, fields)
