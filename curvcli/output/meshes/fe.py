"""Datafile writer for the Surface Evolver: vertices, edges, facets as loops of edges, bodies."""

from __future__ import annotations

import re
from typing import Any, BinaryIO, Unpack

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ...errors import Notice
from ...mesh.file import Labels
from ...mesh.topology import label_graph
from ...support.blocks import slices
from ...support.words import escape_text, pluralize
from ..tables.write import Column
from .attributes import MeshAttributes
from .text import ROWS_AT_A_TIME, numbers, write_lines, write_rows

_IN_A_LINE = 16


def write_fe(
    stream: BinaryIO, points: NDArray[np.float64], faces: NDArray[np.integer[Any]], **attributes: Unpack[MeshAttributes]
) -> tuple[Notice, ...]:
    """Write points (V, 3) and faces (F, 3), numbered from 1 in their order, with one attribute of vertices.

    Of the attributes, polygons, comments and the property `active`; undefined values are left out. Components whose
    edges all have two facets that run along them in opposite directions are bodies. Polygons that repeat a corner are
    not written; a position that is not finite, of a vertex that no face uses, is the origin.
    Returns notices of both and of another name of the attribute.
    """
    corners, sizes = attributes.get("polygons") or (faces.reshape(-1), np.full(len(faces), 3))
    corners, sizes, notices = _simple(np.asarray(corners, np.int64), np.asarray(sizes, np.int64))
    for comment in attributes.get("comments", ()):
        stream.write(f"// {escape_text(' '.join(comment.split()))}\n".encode())
    active = attributes.get("active")
    values = _values((attributes.get("vertex_properties") or {}).get(active or ""), len(points))
    name = _attribute_name(active or "") if values is not None else ""
    if values is not None:
        stream.write(f"define vertex attribute {name} real\n".encode())
        if name != active:
            message = f"name of a property that the output spells in another way: {escape_text(active or '')} -> {name}"
            notices.append(Notice("renamed_properties", 1, message, "the values are kept under the new name"))
    stream.write(b"\nvertices\n")
    _write_vertices(stream, points, name, values)
    ends, signed = _edges(corners, sizes)
    stream.write(b"\nedges\n")
    for rows in slices(len(ends), ROWS_AT_A_TIME):
        number = np.arange(rows.start, min(rows.stop, len(ends))) + 1
        pair = {letter: numbers(ends[rows, k] + 1) for k, letter in enumerate("ab")}
        write_lines(stream, {"n": numbers(number), **pair})
    stream.write(b"\nfaces\n")
    write_rows(stream, np.arange(len(sizes)) + 1, signed, sizes)
    _write_bodies(stream, len(points), ends, signed, corners, sizes)
    if lost := int(np.count_nonzero(~np.isfinite(points).all(axis=1))):
        message = "[position|positions] of vertices without faces that [is|are] not finite, written as the origin"
        hint = "remove these vertices from the mesh"
        notices.append(Notice("positions_at_origin", lost, pluralize(lost, message), hint))
    return tuple(notices)


def _simple(
    corners: NDArray[np.int64], sizes: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], list[Notice]]:
    """The polygons of at least three corners whose neighbours differ, and a notice of the others."""
    following = np.arange(1, len(corners) + 1)
    stop = np.cumsum(sizes)
    following[(stop - 1)[sizes > 0]] = (stop - sizes)[sizes > 0]
    row = np.repeat(np.arange(len(sizes)), sizes)
    keep = sizes >= 3
    keep[row[corners == corners[following]]] = False
    dropped = np.flatnonzero(~keep)
    message = "[face|faces] with a vertex twice, not written: a facet of the Evolver is a loop of edges"
    hint = "--weld exact drops faces with two corners at one place"
    notices = [Notice.at("repeated_corner_faces", dropped, message, hint)] if len(dropped) else []
    return corners[keep[row]], sizes[keep], notices


def _values(column: Column | None, count: int) -> NDArray[np.float64] | None:
    """The column as doubles, NaN where undefined; None if there is none."""
    if column is None:
        return None
    if isinstance(column, Labels):
        return np.where(column.codes < 0, np.nan, column.codes.astype(np.float64))
    data = np.ma.getdata(column).astype(np.float64)
    return np.where(np.ma.getmaskarray(column), np.nan, data) if len(data) == count else None


def _attribute_name(name: str) -> str:
    """The name as an identifier of the Evolver, in which single letters are commands."""
    word = re.sub(r"\W", "_", name, flags=re.ASCII)
    return word if len(word) > 1 and not word[0].isdigit() else f"column_{word}"


def _write_vertices(
    stream: BinaryIO, points: NDArray[np.float64], name: str, values: NDArray[np.float64] | None
) -> None:
    for rows in slices(len(points), ROWS_AT_A_TIME):
        finite: NDArray[np.bool_] = np.asarray(np.isfinite(points[rows]).all(axis=1))
        positions = np.where(finite[:, None], points[rows], 0.0)
        columns: dict[str, pl.Series | str] = {"n": numbers(np.arange(rows.start, rows.start + len(positions)) + 1)}
        columns |= {axis: numbers(positions[:, k]) for k, axis in enumerate("xyz")}
        if values is not None:
            defined = np.isfinite(values[rows])
            word = numbers(defined).replace_strict([True, False], [name, None], return_dtype=pl.String)
            columns |= {"word": word, "value": pl.Series(np.where(defined, values[rows], np.nan), nan_to_null=True)}
        write_lines(stream, columns)


def _edges(corners: NDArray[np.int64], sizes: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Ends (E, 2) of all edges in the order of their first use, and the signed number of the edge at every corner."""
    following = np.arange(1, len(corners) + 1)
    stop = np.cumsum(sizes)
    following[stop - 1] = stop - sizes
    head = corners[following]
    low, high = np.minimum(corners, head), np.maximum(corners, head)
    _, first, inverse = np.unique(low * (int(high.max(initial=0)) + 1) + high, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    first = first[order]
    number = rank[inverse]
    ends = np.stack([corners[first], head[first]], axis=1)
    return ends, np.where(ends[number, 0] == corners, number + 1, -number - 1)


def _write_bodies(
    stream: BinaryIO,
    vertices: int,
    ends: NDArray[np.int64],
    signed: NDArray[np.int64],
    corners: NDArray[np.int64],
    sizes: NDArray[np.int64],
) -> None:
    number = np.abs(signed) - 1
    uses = np.bincount(number, minlength=len(ends))
    balance = np.bincount(number, np.sign(signed), minlength=len(ends))
    count, label = label_graph(vertices, ends[:, 0].astype(np.int32), ends[:, 1].astype(np.int32))
    closed = np.ones(count, np.bool_)
    open_edges: NDArray[np.int64] = np.flatnonzero((uses != 2) | (balance != 0))
    closed[label[ends[open_edges, 0]]] = False
    first = corners[np.cumsum(sizes) - sizes]
    body = np.where(closed[label[first]], label[first], -1)
    order = np.argsort(body, kind="stable")
    order = order[np.count_nonzero(body < 0) :]
    if not len(order):
        return
    stream.write(b"\nbodies\n")
    bounds = np.flatnonzero(np.diff(body[order], prepend=-1, append=-1))
    for k, (begin, end) in enumerate(zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True), 1):
        facets = order[begin:end] + 1
        for start in range(0, len(facets), _IN_A_LINE):
            numbers = " ".join(map(str, facets[start : start + _IN_A_LINE].tolist()))
            turn = " \\" if start + _IN_A_LINE < len(facets) else ""
            stream.write(f"{f'{k} ' if not start else '  '}{numbers}{turn}\n".encode())
