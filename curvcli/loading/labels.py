"""Regions: a labelling of the faces, and the surface cut along it.

Every integral relation holds for every set of faces. To evaluate it on a region, the surface is cut so that each region
has its own copy of the vertices on its border; all columns, totals and checks then apply as they stand, with the border
as boundary. Pinched regions, islands and Möbius strips need no special care.
"""

from __future__ import annotations

import io
import math
import os
from dataclasses import dataclass
from itertools import chain, compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, LackingError, Notice
from ..mesh.counts import count_groups
from ..mesh.file import Labels
from ..mesh.groups import Groups, by_label
from ..mesh.surface import CutFrom, Surface
from ..support.arrays import Index
from ..support.words import suggestion
from .content import open_regular, read_whole

FILES = (".npy", ".csv", ".txt")
MAGIC = b"\x93NUMPY"


@dataclass(frozen=True)
class Regions:
    """A labelling of the faces.

    face: (F,) region of each face, -1 for none. names: of the regions, in ascending order of label or of first use.
    unused: labels of polygons without any remaining face.
    """

    face: Index
    names: tuple[str, ...]
    unused: tuple[str, ...] = ()

    @property
    def count(self) -> int:
        """Number of regions."""
        return len(self.names)


def find_regions(surface: Surface, chosen: str | NDArray[np.integer[Any]]) -> Regions:
    """Find the regions that `--regions` names, see `_find`; errors name the mesh."""
    try:
        return _find(surface, chosen)
    except InputError as error:
        error.path = error.path or (surface.file.path if surface.file is not None else None)
        raise


def _find(surface: Surface, chosen: str | NDArray[np.integer[Any]]) -> Regions:
    """Find the regions of `--regions`: records of an OBJ file, a face property of a PLY file, a file, or an array.

    Labels are given per polygon of the file, or per triangle if their number matches; a polygon's label passes to its
    triangles. Faces with a negative label belong to no region.
    Errors: LackingError for an unknown name; InputError for labels of another number or type.
    """
    if not isinstance(chosen, str):
        return _from_labels(surface, np.asarray(chosen), "the labels")
    file = surface.file
    if file is not None and chosen in file.polygon_labels:
        records = file.polygon_labels[chosen]
        codes = _per_face(surface, records.codes, chosen)
        if codes.max() < 0:
            raise InputError(f"{chosen}: no face comes after such a record, expected at least one")
        return _numbered(codes, records)
    if file is not None and chosen in file.polygon_properties:
        return _from_labels(surface, file.polygon_properties[chosen], f"face property {chosen}")
    if os.path.splitext(chosen)[1].lower() in FILES:
        return _from_labels(surface, read_labels(chosen), chosen)
    known = [*file.polygon_labels, *file.polygon_properties] if file is not None else []
    way_out = suggestion(chosen, known) if known else "; it has no labels of its own"
    raise LackingError(f"--regions {chosen}: neither a label of this mesh nor a .npy, .csv or .txt file{way_out}")


def read_labels(path: str) -> NDArray[Any]:
    """Read one label per face from a .npy, .csv or .txt file; a first line that is no number is a header.

    Errors: InputError for a file that cannot be read or has other content.
    """
    try:
        with open_regular(path, None) as file:
            data = read_whole(file, None)
        return _read_array(data) if path.lower().endswith(".npy") else _read_lines(data, path)
    except InputError as error:
        error.path = path
        raise
    except ValueError as error:
        raise InputError(f"{error}, expected one whole number per face", path=path) from None


def _read_array(data: bytes) -> NDArray[Any]:
    if not data.startswith(MAGIC):
        raise ValueError("is not a .npy file")
    stream = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(stream)
        header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, in_columns, dtype = header(stream)
        if dtype.hasobject:
            raise ValueError("objects")
        # The size of the data decides: a header that announces more is refused before memory is allocated.
        array = np.frombuffer(data, dtype, math.prod(shape), stream.tell())
        return array.reshape(shape, order="F" if in_columns else "C")
    except MemoryError:
        raise
    except Exception as error:
        # numpy parses the header with Python's parser, and a damaged header raises any of its exceptions.
        raise ValueError(f"is a damaged .npy file ({error})") from None


def _read_lines(data: bytes, path: str) -> NDArray[Any]:
    text = data.decode("utf-8-sig")
    lines = io.StringIO(text, newline=None)
    try:
        filled = filter(None, map(str.strip, lines))
        first = next(filled, "")
        if not _is_number(first):
            first = next(filled, "")
        table = np.loadtxt(chain([first], lines), comments=None, ndmin=2) if first else np.empty((0, 1))
        if table.shape[1] == 1:
            return table[:, 0]
    except ValueError:
        pass
    return _read_line_by_line(text, path)


def _read_line_by_line(text: str, path: str) -> NDArray[Any]:
    """Read numbers that only Python accepts; errors name the line that is none."""
    stream = io.StringIO(text, newline=None)
    lines = [(place, line.strip()) for place, line in enumerate(stream, 1) if line.strip()]
    if not _is_number(lines[0][1]):
        del lines[0]
    try:
        return np.array([float(text) for _, text in lines])
    except ValueError:
        place, text = next(line for line in lines if not _is_number(line[1]))
        raise InputError(f"{text[:40]!r}, expected one whole number", path=path, place=f"line {place}") from None


def cut_along_regions(surface: Surface, regions: Regions) -> tuple[Surface, Groups]:
    """Cut a surface so that every region has its own vertices, oriented as the whole; with the regions as groups."""
    inside = regions.face >= 0
    faces, label = surface.faces[inside], regions.face[inside]
    turned = None
    if surface.orientation.face_sign is not None:
        turned = surface.orientation.face_sign[inside] < 0
        faces[turned] = faces[turned][:, [0, 2, 1]]
    corner = np.repeat(label.astype(np.int64), 3) * surface.n_vertices + faces.ravel()
    own, position = np.unique(corner, return_inverse=True)
    vertex = own % surface.n_vertices
    cut_from = CutFrom(surface, vertex, turned)
    cut = Surface(surface.points[vertex], position.reshape(-1, 3).astype(np.int32), cut_from=cut_from)
    return cut, by_label(cut, label, regions.count, "region", regions.names)


_SLIPPED = "meant, or a label has slipped; --table faces=PATH has the region of every face"


def region_notices(cut: Surface, groups: Groups, regions: Regions) -> list[Notice]:
    """Warn of likely wrong labels: regions in pieces, pinched or with a single face, and faces without a label."""
    pieces = np.zeros(groups.count, np.int64)
    first = np.unique(cut.components.face, return_index=True)[1]
    np.add.at(pieces, groups.face[first], 1)
    pinched = count_groups(cut, groups).nonmanifold_vertices > 0
    single = groups.faces.members() == 1
    of_regions = [
        ("regions_in_pieces", pieces > 1, "[region is|regions are] not connected", _SLIPPED),
        ("regions_pinched", pinched, "[region touches itself|regions touch themselves] at a vertex", _SLIPPED),
        (
            "regions_of_one_face",
            single if not single.all() else ~single,
            "[region is|regions are] a single face",
            _SLIPPED,
        ),
    ]
    names = [(code, tuple(compress(regions.names, mask)), message, hint) for code, mask, message, hint in of_regions]
    dropped = "[label is|labels are] on dropped faces only"
    names += [("labels_without_faces", regions.unused, dropped, "no region has [it|them]")]
    notices = [Notice.of(code, some, message, hint, len(some)) for code, some, message, hint in names]
    without = np.flatnonzero(regions.face < 0)
    notices += [
        Notice.at(
            "faces_without_region", without, "[face has|faces have] no region", "no region's integrals count [it|them]"
        )
    ]
    return [notice for notice in notices if notice.count]


def _from_labels(surface: Surface, labels: NDArray[Any], source: str) -> Regions:
    if labels.ndim != 1 or labels.dtype.kind not in "iufb":
        raise InputError(f"{source}: shape {labels.shape} of {labels.dtype}, expected one whole number per face")
    # Beyond, a floating-point type skips whole numbers, and two labels would be equal.
    bits = np.finfo(labels.dtype).nmant + 1 if labels.dtype.kind == "f" else 63
    with np.errstate(invalid="ignore"):
        whole = labels.astype(np.int64)
        wrong = np.flatnonzero((whole != labels) | (np.abs(labels) >= 2.0**bits))
    if len(wrong):
        first = int(wrong[0])
        expected = f"a whole number below 2^{bits}" + (", or integers in a .npy file" if bits < 63 else "")
        raise InputError(f"{source}: label {labels[first]} of face {first}, expected {expected}")
    per_face = _per_face(surface, whole, source)
    names, codes = np.unique(per_face[per_face >= 0], return_inverse=True)
    face = np.full(surface.n_faces, -1, np.int32)
    face[per_face >= 0] = codes
    if not len(names):
        raise InputError(f"{source}: no face has a label, expected at least one that is not negative")
    unused = np.setdiff1d(whole[whole >= 0], names)
    return Regions(face, tuple(map(str, names.tolist())), tuple(map(str, unused.tolist())))


def _numbered(codes: NDArray[Any], records: Labels) -> Regions:
    """Drop the names without a face."""
    used = np.unique(codes[codes >= 0])
    new = np.full(len(records.names) + 1, -1, np.int32)
    new[used] = np.arange(len(used))
    unused = np.setdiff1d(records.codes[records.codes >= 0], used)
    return Regions(new[codes], *(tuple(records.names[i] for i in some) for some in (used, unused)))


def _per_face(surface: Surface, labels: NDArray[Any], source: str) -> NDArray[Any]:
    polygons = surface.file.polygons if surface.file is not None else surface.n_faces
    if len(labels) == polygons:
        return labels if surface.polygon is None else labels[surface.polygon]
    if len(labels) == surface.n_faces:
        return labels
    expected = (
        f"{polygons}" if polygons == surface.n_faces else f"{polygons} (polygons) or {surface.n_faces} (triangles)"
    )
    raise InputError(f"{source}: {len(labels)} labels, expected {expected}")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
