"""Solids of an STL text: a label per facet, with the names that the text gives them."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....errors import Notice
from ....mesh.file import Labels
from ....support.words import escape_text
from ...text import decode


class TextFacets(NamedTuple):
    """Content of an STL text: corners (3, 3 F) of the facets, notices, and the solid of each facet."""

    xyz: NDArray[np.float64]
    notices: tuple[Notice, ...]
    solids: Labels


def label_solids(begins: list[int], names: list[bytes], facets: int) -> Labels:
    """The solid of each facet.

    begins: number of facets before each solid. names: words behind `solid`; a solid without one gets its number, and so
    does each of several solids with one name, in the order of the file.
    """
    given = [escape_text(decode(name).strip()) for name in names]
    counted = Counter(given)
    named = [
        name if name and counted[name] == 1 else f"{name or 'solid'} {number}" for number, name in enumerate(given, 1)
    ]
    if len(begins) == 1:
        return Labels(np.zeros(facets, np.int32), tuple(named))
    codes = np.searchsorted(np.array(begins, np.int64), np.arange(facets), side="right") - 1
    return Labels(codes.astype(np.int32), tuple(named))
