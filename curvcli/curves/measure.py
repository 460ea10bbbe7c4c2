"""Measures of a set of curves: one row per curve and one row per vertex."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import Notice
from ..mesh.file import Labels
from ..support.arrays import Floats
from ..support.words import pluralize
from .collect import CurveSet, curve_notices
from .darboux import Darboux
from .densities import curvature, signed_curvature, torsion_density
from .frames import Bishop, Frenet, twist, twist_error
from .identities import Identity, identities
from .links import Links, links
from .loops import complete_sum, components, linking, pull, vector_area
from .plane import PlaneCurves, plane_curves
from .turning import Turning
from .writhe import MAX_EDGES, UNSURE, within, writhe


class CurveMeasures:
    """Totals and columns of all curves of a set, in the file's unit of length; NaN is undefined."""

    def __init__(self, curve_set: CurveSet, *, max_writhe: int | None = MAX_EDGES) -> None:
        self.curve_set, self.max_writhe = curve_set, max_writhe
        self.distinct, self.kept = curve_set.curves.distinct()
        self.turning = Turning(self.distinct)
        self.frenet, self.bishop = Frenet(self.turning), Bishop(self.turning)
        self.darboux = None if curve_set.boundary is None else Darboux(curve_set.boundary)

    @cached_property
    def writhe(self) -> tuple[Floats, Floats]:
        """(m,) writhe in turns and the bound of its error."""
        return writhe(self.distinct, self.max_writhe)

    @cached_property
    def links(self) -> Links:
        """Linking numbers of the pairs of closed curves."""
        return links(self.distinct, self.max_writhe)

    def links_table(self) -> dict[str, Any]:
        """One row per pair of closed curves: their numbers, linking number and the bound of its error in turns."""
        result = self.links
        number = np.rint(np.where(result.known, result.number, 0.0)).astype(np.int32)
        return {
            "a": result.a.astype(np.int32),
            "b": result.b.astype(np.int32),
            "linking": np.ma.masked_array(number, ~result.known),
            "linking_error": result.error,
        }

    @cached_property
    def identities(self) -> list[Identity]:
        """The identities of every curve."""
        return identities(self.turning, self.plane, self.bishop, self.writhe)

    @cached_property
    def plane(self) -> PlaneCurves:
        """The planes of the curves."""
        return plane_curves(self.turning)

    @property
    def notices(self) -> list[Notice]:
        """Notices about accepted input."""
        vertex = self.curve_set.vertex
        repeated = np.delete(vertex, self.kept)
        back = vertex[self.kept[self.turning.reversed]]
        refused = int(np.count_nonzero(~within(self.distinct.edges, self.max_writhe)))
        unsure = Notice.at(
            "writhe_undefined",
            np.flatnonzero(self.writhe[1] > UNSURE),
            "[curve comes|curves come] so near to crossing [itself|themselves] that rounding decides the writhe",
            "`writhe_error` bounds the error in turns; the writhe jumps by two where a curve passes through itself",
        )
        of_curves = curve_notices(self.curve_set, repeated, back, refused, self.max_writhe)
        return [*of_curves, *(notice for notice in (unsure, *self._of_links()) if notice.count)]

    def _of_links(self) -> Iterator[Notice]:
        links = self.links
        touching = np.flatnonzero(links.touching | (links.error > UNSURE))
        yield Notice(
            "linking_undefined",
            len(touching),
            pluralize(len(touching), "[pair|pairs] of closed curves that touch, or so nearly that rounding decides"),
            "a linking number jumps where one curve passes through the other",
            tuple(f"{links.a[k]}-{links.b[k]}" for k in touching[:5].tolist()),
        )
        refused = pluralize(links.refused, "[pair|pairs] of closed curves too large for [its|their] linking number")
        yield Notice("linking_refused", links.refused, refused, "--max-writhe sets the limit of these double sums too")

    def _boundary_first(self, values: Floats | None, like: int) -> Floats:
        """Values of the boundary curves (or their vertices), then NaN for the polylines."""
        if values is None:
            return np.full(like, np.nan)
        padded = np.full((*values.shape[:-1], like), np.nan)
        padded[..., : values.shape[-1]] = values
        return padded

    # ------------------------------------------------------------------ a row per curve

    @cached_property
    def totals(self) -> dict[str, Any]:
        """One row per curve; see `curvcli curves --help` for the order and the report for the keys."""
        curve_set, curves, turning = self.curve_set, self.curve_set.curves, self.turning
        distinct, count = self.distinct, len(self.curve_set.curves)
        back = distinct.sum(turning.reversed)
        torsion = self.frenet.torsion
        middle = distinct.inner & distinct.inner[distinct.following]
        boundary, darboux = curve_set.boundary, self.darboux
        turned, turned_error = self._twist()
        table: dict[str, Any] = {
            "curve": np.arange(count, dtype=np.int32),
            "kind": Labels((np.arange(count) >= curve_set.boundaries).astype(np.int32), ("boundary", "polyline")),
            "component": self._component(),
            "closed": curves.closed,
            "vertices": curves.sizes.astype(np.int32),
            "length": curves.length,
            "total_curvature": turning.total,
            "total_sin2": distinct.sum(turning.sin2),
            "total_tan2": np.where(back > 0, np.nan, distinct.sum(turning.tan2)),
            "unknotted": np.ma.masked_array(turning.unknotted, ~turning.unknotted),
            "plane": self.plane.plane,
            "signed_total": self.plane.signed_total,
            "turning_number": self._turning_number(),
            "total_torsion": complete_sum(distinct, torsion, middle),
            **components("tangent_change", turning.tangent_change),
            **components("vector_area", vector_area(curves)),
            "holonomy": self.bishop.holonomy,
            "writhe": self.writhe[0],
            "writhe_error": self.writhe[1],
            "sum_kappa_g": self._boundary_first(self._darboux_sum("kappa_g"), count),
            "sum_kappa_n": self._boundary_first(self._darboux_sum("kappa_n"), count),
            "twist": turned,
            **linking(*self.writhe, turned, turned_error),
        }
        force, torque = (None, None) if boundary is None or darboux is None else pull(boundary, darboux)
        for name, vector in (("force", force), ("torque", torque)):
            table |= components(name, self._vectors(vector, count))
        table["repeated_points"] = (curves.sizes - distinct.sizes).astype(np.int32)
        return table

    def _turning_number(self) -> Any:
        number = self.plane.turning_number
        return np.ma.masked_array(np.nan_to_num(number).astype(np.int32), np.isnan(number))

    def _vectors(self, values: Floats | None, like: int) -> Floats:
        return np.full((3, like), np.nan) if values is None else self._boundary_first(values, like)

    def _component(self) -> Any:
        count, mine = len(self.curve_set.curves), self.curve_set.boundaries
        component = np.zeros(count, np.int32)
        if self.curve_set.boundary is not None:
            component[:mine] = self.curve_set.boundary.component
        return np.ma.masked_array(component, np.arange(count) >= mine)

    def _darboux_sum(self, column: str) -> Floats | None:
        if self.darboux is None or self.curve_set.boundary is None:
            return None
        return complete_sum(self.curve_set.boundary.curves, getattr(self.darboux, column))

    def _twist(self) -> tuple[Floats, Floats]:
        """(m,) twist of the surface along its boundary curves, and the bound of its error."""
        normal = self._vectors(None if self.darboux is None else self.darboux.nu, self.curve_set.curves.size)
        return twist(self.turning, normal[:, self.kept]), twist_error(self.turning, normal[:, self.kept])

    # ------------------------------------------------------------------ a row per vertex

    def _rows(self, values: Floats) -> Floats:
        """Values at distinct points as rows of all points."""
        rows = np.full((*values.shape[:-1], self.curve_set.curves.size), np.nan)
        rows[..., self.kept] = values
        return rows

    def points(self) -> dict[str, Any]:
        """One row per vertex of each curve; values of an edge are in the row of its first vertex.

        At vertices: turning ψ, sin2 = 2 sin(ψ/2), tan2 = 2 tan(ψ/2), Frenet normal and binormal; per length curvature,
        signed_curvature of plane curves and torsion_density (see `densities`); on boundary curves
        the angle kappa_g = π − Σθ and the components of the curvature vector T′ − T = −kappa_n ν + kappa_eta η.
        On edges: length, torsion, tangent, Bishop's bishop_u and bishop_v, Darboux's nu and eta.
        """
        curves, turning, frenet, bishop = self.curve_set.curves, self.turning, self.frenet, self.bishop
        size = curves.size
        position = np.arange(size) - np.repeat(curves.start[:-1], curves.sizes)
        darboux = self.darboux
        nu = self._vectors(None if darboux is None else darboux.nu, size)
        tangent = self._rows(self.distinct.tangent)
        eta = np.cross(tangent, nu, axis=0)
        return {
            "curve": curves.label.astype(np.int32),
            "position": position.astype(np.int32),
            "vertex": self.curve_set.vertex.astype(np.int32),
            **dict(zip("xyz", curves.xyz, strict=True)),
            "arc": curves.arc,
            "length": curves.edge_length,
            "turning": self._rows(turning.angle),
            "sin2": self._rows(turning.sin2),
            "tan2": self._rows(turning.tan2),
            "curvature": self._rows(curvature(turning)),
            "signed_curvature": self._rows(signed_curvature(turning, self.plane)),
            "torsion": self._rows(frenet.torsion),
            "torsion_density": self._rows(torsion_density(frenet)),
            "kappa_g": self._boundary_first(None if darboux is None else darboux.kappa_g, size),
            "kappa_n": self._boundary_first(None if darboux is None else darboux.kappa_n, size),
            "kappa_eta": self._boundary_first(None if darboux is None else darboux.kappa_eta, size),
            **components("tangent", tangent),
            **components("normal", self._rows(frenet.normal)),
            **components("binormal", self._rows(frenet.binormal)),
            **components("bishop_u", self._rows(bishop.u)),
            **components("bishop_v", self._rows(bishop.v)),
            **components("nu", nu),
            **components("eta", eta),
        }
