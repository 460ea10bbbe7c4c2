"""Words of labels and the unit of length in the comments that curvcli writes into VTK files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

_LABELS, _UNIT = "labels: {", "unit of length: "


@dataclass
class Meanings:
    """Words of the codes 0, 1, 2, … of arrays of points and of cells, and the unit."""

    points: dict[str, tuple[str, ...]] = field(default_factory=dict)
    cells: dict[str, tuple[str, ...]] = field(default_factory=dict)
    unit: str | None = None

    @classmethod
    def of_comments(cls, comments: Iterable[str]) -> Meanings:
        """Those of all comments; lines of another form are ignored."""
        meanings = cls()
        for comment in comments:
            for line in comment.split("\n"):
                if line.startswith(_UNIT):
                    meanings.unit = line.removeprefix(_UNIT).strip() or None
                elif line.startswith(_LABELS):
                    meanings._read(line.removeprefix(_LABELS[:-1]))
        return meanings

    def _read(self, text: str) -> None:
        try:
            given = json.loads(text)
        except (ValueError, RecursionError):
            return
        for element, target in (("points", self.points), ("cells", self.cells)):
            arrays = given.get(element)
            for name, labels in arrays.items() if isinstance(arrays, Mapping) else ():
                if isinstance(labels, list) and all(isinstance(label, str) for label in labels):
                    target[name] = tuple(labels)
