"""Maps f: M → E³ that are linear on every face: stretch, distance from conformal and from harmonic."""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..checks.base import Check, CheckRule, IdentityValues, rounding
from ..curvatures.kernels.cotangents import Dirichlet, dirichlet
from ..errors import InputError, Notice
from ..loading.load import as_surface
from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, dot
from ..support.arrays import Floats
from ..support.words import counted
from .map_differential import Stretch, stretch
from .map_orientation import orientation
from .notices import out_of_range
from .totals import overflows

if TYPE_CHECKING:
    from .configuration import Configuration


class SurfaceMap:
    """Map f that sends each vertex of a surface M to the vertex of the same index of another, linear on faces.

    source: M. image: a surface with the same faces in the same order, or the points f(p) as an array (V, 3). Both may
    be a Surface, a path, a trimesh.Trimesh or a pair (points, faces).
    σ₁ ≥ σ₂ ≥ 0 are the singular values of f on a face; `orientation` marks the faces that f turns over.
    Columns are in the files' units; null (NaN) on degenerate faces of M and at their corners.
    Errors: InputError where the faces differ, with the first difference.
    Source: Sullivan, Discrete surfaces; Pinkall and Polthier, Computing discrete minimal surfaces and their conjugates.
    """

    # For texture maps: number of edges along which the surface is cut, and the name of the image in a report.
    seams: int | None = None
    image_name: str | None = None

    def __init__(self, source: Any, image: Any) -> None:
        self.source = as_surface(source)
        self.image = _on_same_faces(self.source, image)
        self.source_vertices = self.source.n_vertices
        self.configuration: Configuration | None = None

    # ------------------------------------------------------------------ columns

    @cached_property
    def stretch(self) -> Stretch:
        """Differential on every face."""
        return stretch(self.source, self.image)

    @cached_property
    def _cotangent(self) -> Dirichlet:
        return dirichlet(self.source, self.image.xyz)

    def _ratio(self, values: Floats, exponent: int = 1) -> Floats:
        return self.source.in_file_unit(self.image.in_file_unit(values, exponent), -exponent)

    @property
    def sigma_1(self) -> Floats:
        """(F,) larger singular value: the most that f stretches a direction of the face."""
        return self._ratio(self.stretch.sigma_1)

    @property
    def sigma_2(self) -> Floats:
        """(F,) smaller singular value, without sign; 0 where f flattens the face."""
        return self._ratio(self.stretch.sigma_2)

    @property
    def area(self) -> Floats:
        """(F,) area of the face of M."""
        return self.source.in_file_unit(self.stretch.area, 2)

    @property
    def image_area(self) -> Floats:
        """(F,) area of its image, σ₁ σ₂ area."""
        return self.image.in_file_unit(self.stretch.image_area, 2)

    @property
    def area_distortion(self) -> Floats:
        """(F,) σ₁ σ₂: area of the image per area of the face; 1 where f keeps areas."""
        return self._ratio(self._area_ratio, 2)

    @cached_property
    def _area_ratio(self) -> Floats:
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            ratio = self.stretch.image_area / self.stretch.area
        return np.where(np.isnan(self.stretch.sigma_1), np.nan, ratio)

    @cached_property
    def orientation(self) -> Floats:
        """(F,) +1, or −1 where f turns the face over against most of its patch; see `map_orientation`."""
        return orientation(self.source, self.image, self.stretch)

    @property
    def turned_over(self) -> NDArray[np.int64]:
        """Indices of the faces that f turns over."""
        return np.flatnonzero(self.orientation < 0)

    @property
    def nonconformality(self) -> Floats:
        """(F,) ½ (σ₁ − σ₂)² area ≥ 0: the energy of the face beyond the area of its image; 0 where f is conformal."""
        return self.image.in_file_unit(self.stretch.nonconformality, 2)

    @property
    def energy(self) -> Floats:
        """(F,) Dirichlet energy of f on the face, ¼ Σ cot θ |opposite edge of f|²."""
        return self.image.in_file_unit(self._cotangent.energy, 2)

    @cached_property
    def _gradient(self) -> Floats:
        null = ~self.source.referenced
        null[self.source.faces[self._degenerate].ravel()] = True
        return np.where(null, np.nan, self._cotangent.gradient)

    @property
    def gradient(self) -> Floats:
        """(V, 3) ∇_p E(f) = ½ Σ (cot α + cot β)(f_p − f_q); on a boundary edge the one cotangent there is."""
        return self.image.in_file_unit(self._gradient, 1).T

    @property
    def harmonic_residual(self) -> Floats:
        """(V,) |∇_p E(f)|, 0 where f is discrete harmonic; null on the boundary, which a harmonic map holds fixed."""
        residual = np.where(self.source.boundary, np.nan, np.sqrt(dot(self._gradient, self._gradient)))
        return self.image.in_file_unit(residual, 1)

    @cached_property
    def _degenerate(self) -> NDArray[np.int64]:
        return np.flatnonzero(np.isnan(self._cotangent.energy))

    # ------------------------------------------------------------------ integrals

    @cached_property
    def _sums(self) -> dict[str, tuple[Surface, Floats]]:
        """Each total in the unit of computation, with the surface of that unit."""
        s = self.stretch
        columns = {
            "dirichlet": (self.image, self._cotangent.energy),
            "area": (self.source, s.area),
            "image_area": (self.image, s.image_area),
            "nonconformality": (self.image, s.nonconformality),
        }
        return {name: (unit, np.asarray(np.nansum(values))) for name, (unit, values) in columns.items()}

    @cached_property
    def totals(self) -> dict[str, float]:
        """`dirichlet` E(f), `area` of M, `image_area`, `nonconformality` E(f) − area f(M) as a sum over faces."""
        # Summed before the change to the file's unit, where a single face may be out of range.
        return {name: float(unit.in_file_unit(total, 2)) for name, (unit, total) in self._sums.items()}

    @property
    def _lost(self) -> Counter[str]:
        """Number of values of each column and total that are beyond the range of doubles in the file's unit."""
        s = self.stretch
        columns = [
            ("sigma_1", s.sigma_1, self.sigma_1),
            ("sigma_2", s.sigma_2, self.sigma_2),
            ("area_distortion", self._area_ratio, self.area_distortion),
            ("nonconformality", s.nonconformality, self.nonconformality),
            ("area", s.area, self.area),
            ("image_area", s.image_area, self.image_area),
            ("gradient", self._gradient, self.gradient.T),
        ]
        counts = Counter({name: int(np.count_nonzero(np.isnan(at) & ~np.isnan(own))) for name, own, at in columns})
        counts.update({name: overflows(unit, total, 2) for name, (unit, total) in self._sums.items()})
        return counts

    @cached_property
    def harmonic(self) -> tuple[float, int | None, float]:
        """Largest residual, its vertex, and the bound on its rounding; NaN, None, NaN without one."""
        residual = self.harmonic_residual
        if np.isnan(residual).all():
            return np.nan, None, np.nan
        vertex = int(np.nanargmax(residual))
        bound = (16 + self.source.corner_count[vertex]) * EPSILON * self._cotangent.gradient_terms[vertex]
        return float(residual[vertex]), vertex, float(self.image.in_file_unit(np.array(bound), 1))

    @cached_property
    def checks(self) -> list[Check]:
        """Two identities: both formulas of E(f) agree, and E(f) − area f(M) = Σ ½ (σ₁ − σ₂)² area."""
        s, energy = self.stretch, float(np.nansum(self._cotangent.energy))
        terms = float(np.sum(s.terms + self._cotangent.energy_terms))
        return [
            self._check(
                "dirichlet_energy",
                float(np.nansum(s.energy)),
                energy,
                terms,
                "½ Σ |∇f|² area against ¼ Σ cot θ |opposite edge|²",
            ),
            self._check(
                "nonconformality",
                float(np.nansum(s.nonconformality)),
                energy - float(s.image_area.sum()),
                terms + float(s.image_area.sum()),
                "Σ ½(σ₁ − σ₂)² area against E(f) − area f(M)",
            ),
        ]

    def _check(self, name: str, value: float, expected: float, terms: float, detail: str) -> Check:
        tolerance = rounding(self.source, np.array([terms]))
        outcome = IdentityValues(np.array([value]), np.array([expected]), tolerance, length_exponent=2, detail=detail)
        if len(self._degenerate):
            some = f"{counted(len(self._degenerate), 'face')} of the source without area"
            outcome.exclude(np.array([True]), f"{some}, the first is {self._degenerate[0]}")
        return CheckRule(name, lambda *_: outcome, (), detail).run(self.image, self.image.whole, {})[0]

    @cached_property
    def notices(self) -> list[Notice]:
        """Notices of faces where f is undefined, faces that f flattens, and values beyond the file's unit."""
        collapsed = np.flatnonzero(self.stretch.collapsed)
        defects = (
            (
                "degenerate_source_faces",
                self._degenerate,
                "[face|faces] of the source without area; f is undefined there",
                "remesh A: on a face without area the differential is undefined",
            ),
            (
                "collapsed_faces",
                collapsed,
                "[face|faces] whose image has no area",
                "f is not injective there: σ₂ is 0, and no angle is kept",
            ),
            (
                "turned_over_faces",
                self.turned_over,
                "[face|faces] that the map turns over, against the rest of [its|their] patch",
                "the image is folded; column orientation of `--table faces=PATH` is -1 there",
            ),
        )
        notices = [Notice.at(code, at, text, hint) for code, at, text, hint in defects if len(at)]
        return [*notices, *out_of_range(self._lost)]

    # ------------------------------------------------------------------ tables

    def face_table(self) -> dict[str, NDArray[Any]]:
        """One row per face: singular values, non-conformality, area, area of the image, their ratio, orientation."""
        names = ("sigma_1", "sigma_2", "nonconformality", "area", "image_area", "area_distortion")
        face = np.arange(self.source.n_faces, dtype=np.int32)
        sign = np.ma.masked_array(np.nan_to_num(self.orientation).astype(np.int32), np.isnan(self.orientation))
        return {"face": face} | {name: getattr(self, name) for name in names} | {"orientation": sign}

    def vertex_table(self) -> dict[str, NDArray[Any]]:
        """One row per vertex: position in the source, gradient of the energy, harmonic residual."""
        table: dict[str, NDArray[Any]] = {"vertex": np.arange(self.source.n_vertices, dtype=np.int32)}
        table |= dict(zip("xyz", self.source.xyz_given, strict=True))
        table |= {f"gradient_{axis}": values for axis, values in zip("xyz", self.gradient.T, strict=True)}
        return table | {"harmonic_residual": self.harmonic_residual}


def _on_same_faces(source: Surface, given: Any) -> Surface:
    """The image as a surface, after a check that its faces are the source's."""
    if isinstance(given, np.ndarray):
        if given.shape != source.points.shape:
            raise InputError(f"points of shape {given.shape}, expected {source.points.shape} as in the source")
        return Surface(given, source.faces)
    image = as_surface(given)
    path = image.file.path if image.file else None
    named_source = (source.file.path if source.file else None) or "the source"
    hint = "a map needs the same vertices and faces in the same order"
    for element, count, expected in (
        ("vertices", image.n_vertices, source.n_vertices),
        ("faces", image.n_faces, source.n_faces),
    ):
        if count != expected:
            raise InputError(f"has {count} {element}, expected {expected} as in {named_source}", path=path, hint=hint)
    differ = (image.faces != source.faces).any(axis=1)
    if differ.any():
        if _same_polygons(source, image):
            # Polygons are cut by their shape; the map is linear on the triangles of its source.
            return Surface(image.points, source.faces, polygon=source.polygon, file=image.file, notices=image.notices)
        face = int(np.argmax(differ))
        corners = [" ".join(map(str, surface.faces[face])) for surface in (image, source)]
        problem = f"has corners {corners[0]}, expected {corners[1]} as in {named_source}"
        raise InputError(problem, path=path, place=f"face {face}", hint=hint)
    return image


def _same_polygons(source: Surface, image: Surface) -> bool:
    first, second = source.file, image.file
    if first is None or second is None or first.sizes is None or second.sizes is None:
        return False
    return np.array_equal(first.sizes, second.sizes) and np.array_equal(first.corners, second.corners)
