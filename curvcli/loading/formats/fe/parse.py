"""Datafiles of the Surface Evolver: facets as loops of vertices, with bodies and colours as labels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import Labels, MeshFile
from ....support.words import pluralize
from ...copies import label_faces
from ...limits import check_faces
from ...pieces import Pieces
from .header import parse_header
from .rows import COLOURS, ElementRows, row_of_numbers
from .text import split_sections


def parse_fe(pieces: Pieces, *, max_faces: int | None = None) -> MeshFile:
    """Parse a datafile or a dump of a linear triangulated surface.

    Rows are in file order, whatever the numbers of elements are. A facet begins where its first edge begins; facets of
    more than three edges are polygons. Expressions, constraints and commands are ignored and counted.
    Errors: InputError with the line of a malformed element, or of a model of another kind.
    """
    sections = split_sections(pieces.rest())
    header = parse_header(sections["header"])
    for name in ("vertices", "edges", "faces"):
        if name not in sections:
            raise InputError(f"no section `{name}` found, a datafile of the Surface Evolver expected")
    if header.is_dump and "read" not in sections:
        hint = "the file is truncated, or a line `read` is missing at its end"
        raise InputError("a dump without the section `read` found, one expected", hint=hint)
    check_faces(len(sections["faces"].numbers), max_faces)
    vertices, edges, facets = (
        ElementRows(sections[name], word)
        for name, word in (("vertices", "vertex"), ("edges", "edge"), ("faces", "facet"))
    )
    vertices.require(3, 3, "3 coordinates")
    edges.require(2, 2, "2 vertices")
    facets.require(3, None, "3 or more edges")
    if not facets.count:
        raise InputError("no faces", hint="a surface needs at least one facet")
    corners = _loops(vertices, edges, facets)
    sizes = facets.sizes
    triangles = bool((np.asarray(sizes) == 3).all())
    bodies = ElementRows(sections["bodies"], "body") if "bodies" in sections else None
    labels = _bodies(facets, bodies)
    properties = _attributes(facets, header.attributes["facet"])
    if (colour := facets.colours()) is not None:
        properties["color"] = colour
        labels["materials"] = _colour_labels(colour)
    notices = [*header.notices, *_ignored(vertices, edges, facets)]
    if "read" in sections and (count := len(sections["read"].numbers)):
        message = pluralize(count, "[line|lines] of commands behind `read`, ignored")
        notices.append(Notice("ignored_statements", count, message, "the mesh is read as it stands before them"))
    return MeshFile(
        "fe",
        np.ascontiguousarray(vertices.values.reshape(-1, 3).T),
        corners,
        None if triangles else np.broadcast_to(np.asarray(sizes), facets.count).astype(np.int32),
        vertex_properties=_attributes(vertices, header.attributes["vertex"]),
        polygon_properties=properties,
        polygon_labels=labels,
        notices=tuple(notices),
    )


def _loops(vertices: ElementRows, edges: ElementRows, facets: ElementRows) -> NDArray[np.int32]:
    """The vertices of all facets, concatenated: where each of its edges begins.

    Errors: InputError for edges that do not follow each other around a facet.
    """
    ends = row_of_numbers(vertices.id, edges.values, edges, "vertex").reshape(-1, 2)
    signed = facets.values
    edge_rows = row_of_numbers(edges.id, np.abs(signed), facets, "edge")
    back = signed < 0
    tail = np.where(back, ends[edge_rows, 1], ends[edge_rows, 0])
    head = np.where(back, ends[edge_rows, 0], ends[edge_rows, 1])
    sizes = np.broadcast_to(np.asarray(facets.sizes, np.int64), facets.count)
    stop = np.cumsum(sizes)
    following = np.arange(1, len(tail) + 1)
    following[stop - 1] = stop - sizes
    broken = np.flatnonzero(head != tail[following])
    if len(broken):
        row = int(np.searchsorted(stop, broken[0], side="right"))
        first, second = int(signed[broken[0]]), int(signed[following[broken[0]]])
        problem = f"edge {second} does not begin where edge {first} ends, a closed loop of edges expected"
        raise InputError(problem, place=facets.lines.place(row))
    return np.asarray(tail, np.int32)


def _attributes(rows: ElementRows, names: list[str]) -> dict[str, NDArray[np.generic]]:
    properties: dict[str, NDArray[np.generic]] = {}
    for name in names:
        values = rows.attribute(name)
        properties[name] = np.full(rows.count, np.nan) if values is None else values
    return properties


def _bodies(facets: ElementRows, bodies: ElementRows | None) -> dict[str, Labels]:
    """The body of each facet, or the pair of a facet between two, as `1|2`."""
    front, back = np.zeros(facets.count, np.int64), np.zeros(facets.count, np.int64)
    if bodies is not None and bodies.count:
        facet_rows = row_of_numbers(facets.id, np.abs(bodies.values), bodies, "facet")
        owner = np.repeat(bodies.id, np.broadcast_to(np.asarray(bodies.sizes, np.int64), bodies.count))
        positive = bodies.values > 0
        front[facet_rows[positive]], back[facet_rows[~positive]] = owner[positive], owner[~positive]
    for word, side in (("frontbody", front), ("backbody", back)):
        if (given := facets.attribute(word)) is not None:
            side[given > 0] = given[given > 0]
    if not (front.any() or back.any()):
        return {}
    pairs, code = np.unique(np.sort(np.stack([front, back]), axis=0), axis=1, return_inverse=True)
    names = [f"{a}|{b}" if a else str(b) for a, b in pairs.T.tolist()]
    labels = label_faces(np.where((pairs[1] == 0)[code.reshape(-1)], -1, code.reshape(-1)), names)
    return {"groups": labels, "objects": labels}


def _colour_labels(colour: NDArray[np.int32]) -> Labels:
    values, code = np.unique(colour, return_inverse=True)
    names = [COLOURS[value + 1] if value + 1 < len(COLOURS) else str(value) for value in values.tolist()]
    return label_faces(code, names)


def _ignored(*sections: ElementRows) -> list[Notice]:
    count = sum(rows.attributed for rows in sections)
    if not count:
        return []
    message = (
        "[element|elements] with attributes; scalars that the header declares and `color` are kept, others ignored"
    )
    hint = "they change no coordinate and no facet"
    return [Notice("ignored_attributes", count, pluralize(count, message), hint)]
