"""Surface: points and triangles with their combinatorics, computed on demand and cached."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError, Notice
from ..support.arrays import Index, Mask, Sign
from ..support.words import counted
from .arrays import as_components, as_triangles, frozen, with_repeated_corner
from .exports import Exports
from .groups import Groups, by_label, whole
from .incidence import Incidence
from .orientation import Orientation, Uncancelled, closed_patches, orient, orient_stars, uncancelled, uncancelled_rim
from .solids.patches import Solids
from .topology import renumber_by_lowest_member, vertex_components
from .volumes import triple_products

if TYPE_CHECKING:
    from .file import MeshFile

# Extents between these powers of two are computed in the file's own unit. Outside, the eighth power of an edge, needed
# by the square of the cross ratio, leaves the range of doubles for edges 2⁵³ times shorter than the extent.
_LARGEST_EXPONENT = 60

Orient = Literal["file", "outward"]

STATUS = ("interior", "boundary", "degenerate", "nonmanifold", "unreferenced")


# Properties of stars and edges needed by topology, status of vertices and orientation.
_OF_EDGES = (
    "interior",
    "without_orientation",
    "corner_sign",
    "uncancelled",
    "closed_patches",
    "boundary_half_edges",
    "degree",
    "components",
    "whole",
)


class CutFrom(NamedTuple):
    """The surface that this one was cut from.

    vertex: (V,) the original vertex of each vertex. turned: (F,) mask of the faces whose winding here follows the
    orientation of the original surface and not its file; None if there are none.
    """

    surface: Surface
    vertex: NDArray[np.integer]
    turned: Mask | None


class Surface(Incidence, Exports):
    """A triangle mesh: points and faces, frozen, with its edges, stars, components and orientation.

    points: (V, 3) float64 in the file's unit and order. faces: (F, 3) int32 as wound in the file; faces with a repeated
    corner are dropped and counted (`notices`, code `repeated_corner_faces`).
    polygon: (F,) the polygon of the file, or the triangle given, that each face came from; None if face f is polygon f.
    Errors: InputError for a corner out of range, a coordinate of a face that is not finite, or no face at all.
    """

    def __init__(
        self,
        points: ArrayLike,
        faces: ArrayLike,
        *,
        orient: Orient = "file",
        polygon: Index | None = None,
        file: MeshFile | None = None,
        cut_from: CutFrom | None = None,
        notices: Sequence[Notice] = (),
    ) -> None:
        self.xyz_given = as_components(points)
        triangles = as_triangles(faces, self.xyz_given.shape[1])
        repeated = with_repeated_corner(triangles)
        self.notices = list(notices)
        if len(repeated):
            came_from = np.arange(len(triangles), dtype=np.int32) if polygon is None else polygon
            self.notices.append(
                Notice.at(
                    "repeated_corner_faces",
                    came_from[repeated],
                    "[face|faces] with a repeated corner, dropped",
                    "[it has|they have] no area; `curvcli check` refuses such files without --allow no-degenerate",
                )
            )
            triangles, polygon = np.delete(triangles, repeated, axis=0), np.delete(came_from, repeated)
            if not len(triangles):
                raise InputError("no faces: every face has a repeated corner")
        self.faces, self.n_vertices = triangles, self.xyz_given.shape[1]
        self.faces.setflags(write=False)
        self.polygon = polygon
        self.file = file
        self.cut_from = cut_from
        self.orient = orient
        self._check_finite()

    def _check_finite(self) -> None:
        with np.errstate(over="ignore", invalid="ignore"):
            if np.isfinite(self.xyz_given.sum()):  # a finite sum proves that all terms are finite
                return
        bad = ~np.isfinite(self.xyz_given).all(axis=0)
        if not bad.any():
            return
        used = bad & self.referenced
        if used.any():
            vertex = int(np.flatnonzero(used)[0])
            at = ", ".join(f"{value:g}" for value in self.xyz_given[:, vertex])
            raise InputError(
                f"coordinates ({at}) are not finite, expected finite numbers at every vertex that a face uses",
                place=f"vertex {vertex}",
                hint=f"{counted(int(np.count_nonzero(used)), 'such vertex', 'such vertices')}; "
                "remove the faces there or repair them first",
            )

    # ------------------------------------------------------------------ geometry

    @property
    def points(self) -> NDArray[np.float64]:
        """(V, 3) positions as given, a view."""
        return self.xyz_given.T

    def used_coordinates(self) -> NDArray[np.float64]:
        """(3, n) coordinates as given, of the vertices that faces use."""
        return self.xyz_given if self.referenced.all() else self.xyz_given.compress(self.referenced, axis=1)

    @cached_property
    def unit_exponent(self) -> int:
        """Exponent of the unit of computation, a power of two, so that scaling is exact.

        0 unless the mesh is so large or small that squares of areas would leave the range of doubles.
        """
        used = self.used_coordinates()
        extent = float((used.max(axis=1) / 2 - used.min(axis=1) / 2).max())
        exponent = math.frexp(extent)[1] + 1
        return 0 if extent == 0 or abs(exponent) <= _LARGEST_EXPONENT else exponent

    def in_file_unit(self, values: NDArray[np.float64], length_exponent: int) -> NDArray[np.float64]:
        """Convert values, of any shape, from the unit of computation to the file's; NaN on overflow."""
        power = length_exponent * self.unit_exponent
        if not power:
            return values
        with np.errstate(over="ignore", under="ignore"):
            scaled = np.ldexp(values, power)
        tiny = (np.abs(scaled) < np.finfo(np.float64).tiny) & (values != 0)
        return np.where(np.isinf(scaled) | tiny, np.nan, scaled)

    @cached_property
    @frozen
    def xyz(self) -> NDArray[np.float64]:
        """(3, V) coordinates in the unit of computation, one contiguous row per coordinate."""
        if not self.unit_exponent:
            return self.xyz_given
        with np.errstate(over="ignore", invalid="ignore"):  # unreferenced vertices may overflow, and NaNs may signal
            return np.ldexp(self.xyz_given, -self.unit_exponent)

    @cached_property
    @frozen
    def base(self) -> NDArray[np.float64]:
        """(3,) a point of the mesh, the origin of moments, so that an offset costs no digits."""
        return self.xyz[:, self.faces[0, 0]].copy()

    # ------------------------------------------------------------------ orientation

    @cached_property
    def _file_orientation(self) -> Orientation:
        if self.consistent_winding and self.is_manifold:
            # With one fan at every vertex, the components by vertices are the components across edges.
            return Orientation(self.components.face, np.ones(self.components.count, bool), None)
        return orient(self.faces, self.edges)

    @cached_property
    def orientation(self) -> Orientation:
        """Patches and the sign of each face; orient="outward" turns closed patches that are inside out."""
        result = self._file_orientation
        if self.orient == "file" or not self.inside_out.any():
            return result
        turned = self.inside_out[result.patch]
        sign = np.ones(self.n_faces, np.int8) if result.face_sign is None else result.face_sign.copy()
        sign[turned] *= -1
        return Orientation(result.patch, result.orientable, sign if (sign < 0).any() else None)

    @cached_property
    def orientable(self) -> bool:
        """True if every patch is orientable."""
        return bool(self.orientation.orientable.all())

    @cached_property
    @frozen
    def without_orientation(self) -> Mask:
        """(V,) mask of the vertices of patches without an orientation."""
        mask = np.zeros(self.n_vertices, bool)
        if not self.orientable:
            mask[self.faces[~self.orientation.orientable[self.orientation.patch]].ravel()] = True
        return mask

    @cached_property
    def corner_sign(self) -> Sign | None:
        """(F, 3) the sign of each face's normal in the star of each corner; None if all are +1."""
        sign = self.orientation.face_sign
        if self.orientable:
            return None if sign is None else np.repeat(sign[:, None], 3, axis=1)
        corners = np.ones((self.n_faces, 3), np.int8) if sign is None else np.repeat(sign[:, None], 3, axis=1)
        without = ~self.orientation.orientable[self.orientation.patch]
        corners[without] = orient_stars(self.faces, self.edges)[without]
        return corners

    @cached_property
    def uncancelled(self) -> Uncancelled:
        """Edges whose oriented half-edges do not cancel."""
        if self.coherent:  # the two faces of an edge are turned or kept together
            return uncancelled_rim(self.faces, self.boundary_half_edges, self.orientation)
        return uncancelled(self.faces, self.edges, self.orientation, self.consistent_winding)

    @cached_property
    @frozen
    def closed_patches(self) -> Mask:
        """(patches,) flag: each edge of the patch has exactly two of its own faces, with opposite half-edges."""
        if not self.coherent:
            return closed_patches(self.faces, self.edges, self._file_orientation)
        closed = np.ones(len(self._file_orientation.orientable), bool)
        closed[self._file_orientation.patch[self.boundary_half_edges // 3]] = False
        return closed

    @property
    def solids(self) -> Solids:
        """The closed orientable patches as the file winds them, with their nesting."""
        return Solids(self, self._file_orientation)

    @property
    def inside_out(self) -> Mask:
        """(patches,) mask of the closed orientable patches whose normals point to the wrong side, see `Solids`."""
        return self.solids.inside_out

    @cached_property
    @frozen
    def triple_products(self) -> NDArray[np.float64]:
        """(F,) six times the volume that each face, as the file winds it, spans with a point of its component."""
        return triple_products(self.xyz, self.faces, self.components.face)

    # ------------------------------------------------------------------ pieces

    @cached_property
    def components(self) -> Groups:
        """Pieces connected by shared vertices, listed by their lowest face."""
        count, vertex = vertex_components(self.faces, self.stars.lowest, self.referenced)
        if count == 1:
            return whole(self, "component")
        pieces, face = renumber_by_lowest_member(vertex[self.faces[:, 0]], count)
        return by_label(self, face, pieces, "component")

    def compute_topology(self) -> None:
        """Compute the cached properties of stars and edges that every analysis needs."""
        for known in _OF_EDGES:
            getattr(self, known)
        self.__dict__.pop("stars", None)

    def release_edges(self) -> None:
        """Compute the properties of edges that every analysis needs, and release the edges: 72 bytes per vertex.

        Edges are computed only if the winding is incoherent. A later use sorts them again, which costs less than the
        page faults of passes that need no edges.
        """
        self.compute_topology()
        self.__dict__.pop("edges", None)

    @cached_property
    def whole(self) -> Groups:
        """The whole surface as one group."""
        return whole(self)
