"""Text as it can be shown, whatever is in it: names of files are any bytes, and what files say is any text."""

from __future__ import annotations

from contextlib import suppress


def shown(text: str) -> str:
    """The text on one line, what cannot be printed escaped."""
    if text.isprintable():
        return text
    with suppress(UnicodeEncodeError):  # of half a pair of surrogates, which stands for no byte
        text = text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)
