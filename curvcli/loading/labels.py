"""Regions: a labelling of the faces, and the surface cut along it.

Every integral relation holds for every set of faces. To evaluate it on a region, the surface is cut so that each region
has its own copy of the vertices on its border; all columns, totals and checks then apply as they stand, with the border
as boundary. Pinched regions, islands and Möbius strips need no special care.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError, LackingError, Notice
from ..mesh.borders import split_vertices, vertex_regions
from ..mesh.counts import count_groups
from ..mesh.groups import Groups, by_label
from ..mesh.surface import CutFrom, Surface
from ..support.arrays import Index, Mask
from ..support.words import suggestion
from .copies import unique_names
from .face_labels import face_labels
from .label_files.base import LabelFile
from .label_files.read import is_label_file, read_labels


@dataclass(frozen=True)
class Regions:
    """A labelling of the faces.

    face: (F,) region of each face, -1 for none. names: of the regions, in ascending order of label or of first use.
    unused: labels of polygons or vertices without any remaining face. colors: (count, 3) uint8, None without. notices:
    how labels came to faces.
    """

    face: Index
    names: tuple[str, ...]
    unused: tuple[str, ...] = ()
    colors: NDArray[np.uint8] | None = None
    notices: tuple[Notice, ...] = ()

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
    """Find the regions of `--regions`: labels or properties of the mesh by name, a file, or an array.

    Labels are given per polygon of the file, per triangle or per vertex, as their number matches, in this order; a
    polygon's label passes to its triangles, those of vertices by `from_vertices`. Faces with a negative label belong to
    no region.
    Errors: LackingError for an unknown name; InputError for labels of another number or type.
    """
    if not isinstance(chosen, str):
        return _regions(surface, LabelFile(np.asarray(chosen)), "the labels")
    file = surface.file
    if file is not None:
        if chosen in file.polygon_labels:
            labels = file.polygon_labels[chosen]
            if (labels.codes < 0).all():
                raise InputError(f"{chosen}: no face comes after such a record, expected at least one")
            return _regions(surface, LabelFile(labels, "polygon"), chosen)
        if chosen in file.polygon_properties:
            return _regions(surface, LabelFile(file.polygon_properties[chosen], "polygon"), f"face property {chosen}")
        if chosen in file.vertex_labels:
            return _regions(surface, LabelFile(file.vertex_labels[chosen], "vertex"), chosen)
        if chosen in file.vertex_properties:
            return _regions(surface, LabelFile(file.vertex_properties[chosen], "vertex"), f"vertex property {chosen}")
    if is_label_file(chosen):
        return _regions(surface, read_labels(chosen), chosen)
    known = [] if file is None else [*file.polygon_labels, *file.polygon_properties, *file.vertex_labels]
    known += [] if file is None else file.vertex_properties
    way_out = suggestion(chosen, known) if known else "; it has no labels of its own"
    raise LackingError(f"--regions {chosen}: neither a label of this mesh nor a file of labels such as .csv{way_out}")


def cut_along_regions(
    surface: Surface, regions: Regions, borders: tuple[Index, Mask] | None = None
) -> tuple[Surface, Groups]:
    """Cut a surface so that every region has its own vertices, oriented as the whole; with the regions as groups.

    borders: the result of `vertex_regions`, where it is known.
    """
    inside = regions.face >= 0
    whole = bool(inside.all())
    faces = surface.faces.copy() if whole else surface.faces.compress(inside, axis=0)
    label = regions.face if whole else regions.face[inside]
    turned = None
    if surface.orientation.face_sign is not None:
        turned = surface.orientation.face_sign[inside] < 0
        faces[turned] = faces[turned][:, [0, 2, 1]]
    known = vertex_regions(surface.faces, regions.face, surface.n_vertices) if borders is None else borders
    vertex, region, corners = split_vertices(faces, label, *known, regions.count)
    xyz = surface.xyz_given.take(vertex, axis=1)
    xyz.setflags(write=False)
    cut = Surface(xyz.T, corners, cut_from=CutFrom(surface, vertex, turned))
    return cut, by_label(cut, label, regions.count, "region", regions.names, region)


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
    dropped = "[label is|labels are] left without faces"
    names += [("labels_without_faces", regions.unused, dropped, "no region has [it|them]")]
    notices = [Notice.of(code, some, message, hint, len(some)) for code, some, message, hint in names]
    without = np.flatnonzero(regions.face < 0)
    notices += [
        Notice.at(
            "faces_without_region", without, "[face has|faces have] no region", "no region's integrals count [it|them]"
        )
    ]
    return [*regions.notices, *(notice for notice in notices if notice.count)]


def _regions(surface: Surface, given: LabelFile, source: str) -> Regions:
    """The regions of labels: those names that a face has; of equal names, all but the first get their number."""
    labels, whole, notices = face_labels(surface, given, source)
    named, of_faces = (np.bincount(each.codes + 1, minlength=len(labels.names) + 1)[1:] > 0 for each in (whole, labels))
    used = np.flatnonzero(of_faces)
    if not len(used):
        raise InputError(f"{source}: no face has a label, expected at least one that is not negative")
    new = np.full(len(labels.names) + 1, -1, np.int32)
    new[used] = np.arange(len(used))
    unused = np.flatnonzero(named & ~of_faces)
    every = unique_names(list(labels.names))
    names, others = (tuple(every[code] for code in some.tolist()) for some in (used, unused))
    colors = None if labels.colors is None else labels.colors[used]
    return Regions(new[labels.codes], names, others, colors, tuple(notices))
