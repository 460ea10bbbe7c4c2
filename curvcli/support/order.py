"""Order of declarations, each of which names the one before it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import TypeVar

_Entry = TypeVar("_Entry")


def topological_order(
    entries: Iterable[_Entry], name: Callable[[_Entry], str], after: Callable[[_Entry], str | None]
) -> list[_Entry]:
    """Sort entries so that each comes behind the one that it names, whatever order they are declared in.

    after: "" for the first; an entry that names none, or one that is not there, comes last. Of two behind the same
    entry, the one that fewer others follow comes first.
    """
    listed = list(entries)
    names = {name(entry) for entry in listed}
    followers: dict[str | None, list[_Entry]] = defaultdict(list)
    for entry in listed:
        before = after(entry)
        followers[before if before == "" or before in names else None].append(entry)

    def chain(before: str | None) -> list[_Entry]:
        """The entries behind one, each followed by its own."""
        chains = [[entry, *chain(name(entry))] for entry in followers[before]]
        if before is not None:
            chains.sort(key=lambda each: (len(each), name(each[0])))
        return [entry for each in chains for entry in each]

    return chain("") + chain(None)
