"""The header of a datafile: declared attributes, statements that are ignored, and models that are refused."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from ....errors import InputError, Notice
from ....support.words import pluralize
from .text import SectionLines

_LINEAR = "a linear soap-film model of triangles in three dimensions expected"
_REFUSED = {
    "string": "the string model, which has curves,",
    "quadratic": "the quadratic model",
    "lagrange": "a Lagrange model",
    "simplex_representation": "the simplex model",
    "simplex_model": "the simplex model",
    "torus": "a torus, whose edges wrap around periods,",
    "torus_filled": "a torus, whose edges wrap around periods,",
    "symmetry_group": "a symmetry group, by which edges wrap,",
    "metric": "a metric of its own",
    "conformal_metric": "a metric of its own",
    "klein_metric": "a metric of its own",
}
_DIMENSIONS = {"space_dimension": 3, "surface_dimension": 2}
_DECLARED = re.compile(
    rb"define\s+(vertex|facet|face)\s+attribute\s+([a-z_]\w*)\s+(?:real|integer|ulong|uint|long|int|char|uchar)\s*(.*)",
    re.IGNORECASE | re.DOTALL,
)
_WORD = re.compile(rb"[a-z_#]\w*", re.IGNORECASE)


@dataclass
class DatafileHeader:
    """Names of scalar attributes of vertices and facets, notices, and whether the Evolver wrote the file by `dump`."""

    attributes: dict[str, list[str]] = field(default_factory=lambda: {"vertex": [], "facet": []})
    notices: list[Notice] = field(default_factory=list)
    is_dump: bool = False


def parse_header(lines: SectionLines) -> DatafileHeader:
    """Parse the lines before the vertices; all but declarations of attributes are counted and ignored.

    Errors: InputError for a model that is no linear triangulated surface.
    """
    header = DatafileHeader()
    ignored: dict[str, int] = {}
    for row, line in enumerate(lines.text.splitlines()):
        keyword = _WORD.match(line)
        word = keyword[0].decode("latin-1").lower() if keyword else line.split()[0].decode("latin-1")
        if word in _REFUSED:
            raise InputError(f"{_REFUSED[word]} found, {_LINEAR}", place=lines.place(row))
        if word in _DIMENSIONS:
            value = line.split()[-1]
            if value != b"%d" % _DIMENSIONS[word]:
                problem = f"`{word} {value[:20].decode('latin-1')}` found, {_DIMENSIONS[word]} expected"
                raise InputError(problem, place=lines.place(row))
            continue
        if declared := _DECLARED.match(line):
            kind = "vertex" if declared[1].lower() == b"vertex" else "facet"
            if not declared[3].strip() or declared[3].strip() == b"[1]":
                header.attributes[kind].append(declared[2].decode())
                continue
        header.is_dump |= word == "facets_predicted"
        if word not in ("soapfilm", "linear"):
            ignored[word] = ignored.get(word, 0) + 1
    if total := sum(ignored.values()):
        keywords = ", ".join(f"`{word[:30]}`" for word in list(ignored)[:5])
        message = f"[line|lines] of the header, ignored: {keywords}"
        hint = "they change no coordinate and no facet"
        header.notices.append(Notice("ignored_statements", total, pluralize(total, message), hint))
    return header
