"""Gmsh files: nodes, elements, entities and physical groups."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, Notice
from ....mesh.file import MeshFile
from ....support.words import escape_text
from ...registry import ParserOptions
from ...text import decode
from ...vtk.attributes import Attribute
from ...vtk.cells import CellLists, of_types
from ...vtk.dataset import DataSet, VtkPiece, mesh_file
from . import version_2, version_4
from .elements import Elements
from .source import MshSection

_SECTION = re.compile(rb"\s*\$(\w+)[ \t]*(?:\r\n|\n|\r|$)")
_FORMAT = re.compile(rb"\s*(\d+)(?:\.(\d+))?\s+([01])\s+([48])[ \t]*(?:\r\n|\n|\r)")
_NAME = re.compile(rb"\s*(\d+)\s+(\d+)\s+\"([^\"\n]*)\"")
_READ = ("Entities", "Nodes", "Elements")
_CONVERT = "`gmsh IN -save -format msh4 -o OUT.msh` converts it"


@dataclass
class MshContent:
    """Sections read so far. groups: names of physical groups by dimension and number."""

    tags: NDArray[np.int64] | None = None
    points: NDArray[np.float64] | None = None
    elements: Elements | None = None
    groups: dict[tuple[int, int], str] = field(default_factory=dict)
    physical: version_4.Physical = field(default_factory=dict)
    notices: list[Notice] = field(default_factory=list)


def parse_msh(data: bytes, options: ParserOptions) -> MeshFile:
    """Parse a Gmsh file.

    Nodes keep the order of the file, whatever their tags are. Physical groups of faces become the labels `groups`, the
    geometrical entities the property `entity`.
    Errors: InputError with the section.
    """
    content = MshContent()
    at, version, binary, word, order = 0, (0, 0), False, 8, "<"
    while section := _SECTION.match(data, at):
        name, begin = decode(section[1][:40]), section.end()
        if name == "MeshFormat":
            header = _FORMAT.match(data, begin)
            if header is None or (int(header[1]), int(header[2] or b"0")) < (2, 0):
                raise InputError("version, file type and size of a number expected", place="$MeshFormat")
            version = int(header[1]), int(header[2] or b"0")
            binary, word, begin = header[3] == b"1", int(header[4]), header.end()
            if binary:
                order = ">" if data[begin : begin + 4] == b"\0\0\0\1" else "<"
                begin += 4
        elif name == "NOD":
            raise InputError("Gmsh format 1 found, 2 or later expected", hint=_CONVERT)
        end = begin if binary and name in _READ else data.find(b"$End" + section[1], begin)
        if end < 0:
            raise InputError(f"no $End{name} found", place=f"${name}", hint="the file was cut off")
        if name == "PhysicalNames":
            for dimension, number, text in _NAME.findall(data, begin, end):
                content.groups[int(dimension), int(number)] = escape_text(decode(text))
        elif name in _READ:
            if not version[0]:
                raise InputError("no $MeshFormat found before it", place=f"${name}")
            if binary:
                read = MshSection(name, data, begin, len(data), order, word)
            else:
                read = MshSection.of_text(name, data, begin, end)
            _read(content, read, version)
            end = data.find(b"$End" + section[1], read.at if binary else end)
            if end < 0:
                raise InputError(f"no $End{name} found", place=f"${name}", hint="the file was cut off")
            if (binary and data[read.at : end].strip()) or (not binary and read.left):
                raise InputError("more data than announced found", place=f"${name}", hint="a count is wrong")
        at = end + len(b"$End" + section[1])
    if data[at:].strip(b" \t\r\n\0"):
        rest = escape_text(decode(data[at:].strip()[:40]))
        raise InputError(f"`{rest}` found, a section `$…` expected", place=f"byte {at}")
    return _mesh_file(content, options)


def _read(content: MshContent, section: MshSection, version: tuple[int, int]) -> None:
    kind = version_2 if version[0] < 4 else version_4
    modern = version >= (4, 1)
    if section.name == "Entities":
        if version[0] >= 4:
            content.physical = version_4.read_entities(section, modern)
    elif section.name == "Nodes":
        content.tags, content.points = kind.read_nodes(section, modern)
    elif section.name == "Elements":
        content.elements = kind.read_elements(section, modern, content.physical)


def _mesh_file(content: MshContent, options: ParserOptions) -> MeshFile:
    if content.tags is None or content.points is None:
        raise InputError("no section $Nodes found")
    if content.elements is None:
        raise InputError("no faces: no section $Elements found")
    elements = content.elements
    cells = CellLists(_rows(content.tags, elements.nodes), elements.sizes)
    faces = of_types(cells, elements.kinds, len(content.points))
    labels = _groups(elements.groups, content.groups)
    values = [Attribute("groups", labels)] if labels else []
    values.append(Attribute("entity", elements.entities))
    piece = VtkPiece(content.points, faces, (), values)
    return mesh_file(DataSet([piece], notices=content.notices), "msh", options)


def _rows(tags: NDArray[np.int64], nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """The row of each node, given the tags of all rows; nodes without a row are beyond the last."""
    if len(tags) and (tags == np.arange(1, len(tags) + 1)).all():
        if not len(nodes) or 1 <= int(nodes.min()) <= int(nodes.max()) <= len(tags):
            return nodes - 1
        wrong, rows = (nodes < 1) | (nodes > len(tags)), nodes
    else:
        order = np.argsort(tags, kind="stable")
        sorted_tags = tags[order]
        double = np.flatnonzero(sorted_tags[1:] == sorted_tags[:-1])
        if len(double):
            raise InputError(f"node {sorted_tags[double[0]]} found twice, once expected", place="$Nodes")
        place = np.searchsorted(sorted_tags, nodes)
        place[place == len(tags)] = 0
        wrong = sorted_tags[place] != nodes if len(tags) else np.ones(len(nodes), np.bool_)
        rows = order[place] if len(tags) else place
    missing = np.flatnonzero(wrong)
    if len(missing):
        raise InputError(f"node {nodes[missing[0]]} found in an element, but not among the nodes", place="$Elements")
    return rows


def _groups(numbers: NDArray[np.int64], names: dict[tuple[int, int], str]) -> list[str | None]:
    """Names of the physical groups of the elements; None for none. Empty if no element has a group."""
    if not numbers.any():
        return []
    different, place = np.unique(numbers, return_inverse=True)
    labels = [None if number == 0 else names.get((2, number), str(number)) for number in different.tolist()]
    return [labels[k] for k in place.tolist()]
