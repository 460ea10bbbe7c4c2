"""The columns of every table except the table of vertices, which has a page of its own."""

from __future__ import annotations

import numpy as np

from curvcli.analysis.result import Result
from curvcli.api import analyze
from curvcli.curvatures.catalogue import load_passes
from curvcli.curvatures.quantity import Element
from curvcli.curvatures.registry import passes
from curvcli.output.tables.columns import TABLES

_KEYS = {
    "edges": (
        ("edge", "index, in the order of `a`, then `b`"),
        ("a", "the vertex of lower index"),
        ("b", "the vertex of higher index"),
        ("faces", "number of faces at the edge: 1 on the boundary, 2 inside, more where the surface branches"),
    ),
    "faces": (
        ("face", "index among the triangles"),
        ("polygon", "its face of the file"),
        ("a", "first corner"),
        ("b", "second corner"),
        ("c", "third corner"),
    ),
}
_INTERSECTIONS = (
    ("intersection", "index of the pair, in the order of its faces"),
    ("kind", "`crossing`, `overlapping`, `folded` or `touching`, as on [the page of checks](checks.md)"),
    ("face_a`, `face_b", "the two faces of the file"),
    ("component_a`, `component_b", "their components"),
    ("x`, `y`, `z", "a point of contact"),
)
_STATISTICS = """\
A row for each number, of the whole surface and then of each region: `region` is empty for the whole, `column` is also
the key of a total, `statistic` is `total`, `share` or one of `--stat`. `curvcli batch --long` writes the same for all
meshes."""
_ELEMENTS: dict[str, Element] = {"edges": "edge", "faces": "face"}
_REGION = ("region", "the label of the face's region, with `--regions` only")


def page_part() -> str:
    """Columns of the tables, some with definitions, the others by the keys of the report."""
    load_passes()
    parts = []
    for kind, keys in _KEYS.items():
        rows = [*keys, *_quantities(_ELEMENTS[kind]), *([_REGION] if kind == "faces" else [])]
        parts += [f"### {kind}\n", "| column | definition |", "|---|---|"]
        parts += [f"| `{name}` | {text} |" for name, text in rows]
        parts.append("")
    example = _example()
    for kind in ("loops", "components", "regions"):
        names = ", ".join(f"`{name}`" for name in TABLES[kind](example))
        parts += [f"### {kind}\n", f"{names}\n"]
    parts += ["`region` is the label, as in the table of faces. `name` is its key in the report.\n"]
    parts += [
        f"### statistics\n\n{', '.join(f'`{name}`' for name in TABLES['statistics'](example))}\n\n{_STATISTICS}\n"
    ]
    parts += ["### intersections\n", "| column | definition |", "|---|---|"]
    parts += [f"| `{name}` | {text} |" for name, text in _INTERSECTIONS]
    return "\n".join([*parts, ""])


def _quantities(element: Element) -> list[tuple[str, str]]:
    found = []
    for quantity in passes.quantities(element):
        described = quantity.description.split("\n\n")[0].replace("\n", " ").replace("*", r"\*").replace("|", r"\|")
        found.append(("`, `".join(quantity.columns), described))
    return found


def _example() -> Result:
    """Two triangles in two regions, with every part of a report."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]])
    return analyze((points, np.array([[0, 1, 2], [0, 2, 3]])), "paper", regions=np.array([0, 1]))
