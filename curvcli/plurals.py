"""Words that agree with a number."""

from __future__ import annotations

import re

_CHOICE = re.compile(r"\[([^][|]*)\|([^][|]*)\]")


def agree(count: float, text: str) -> str:
    """The text with each `[one|many]` as the number demands: `[vertex|vertices] that no face uses`."""
    return _CHOICE.sub(r"\1" if count == 1 else r"\2", text)


def counted(count: int, one: str, many: str | None = None) -> str:
    """`1 face`, `1,000 faces`; many: where it is not one with an s."""
    return f"{count:,} {_form(count, one, many)}"


def number_of(count: int, one: str, many: str | None = None) -> str:
    """As `counted`, in the digits that stand in a file: `1000 faces`."""
    return f"{count} {_form(count, one, many)}"


def _form(count: int, one: str, many: str | None) -> str:
    return one if count == 1 else many or one + "s"
