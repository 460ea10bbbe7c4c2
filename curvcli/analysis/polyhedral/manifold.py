"""Curvature of a simplicial n-manifold in E^d, located at the faces of codimension two as a rotation about them.

>>> import numpy as np
>>> from itertools import combinations
>>> five_cell = PolyhedralManifold(np.eye(5), list(combinations(range(5), 4)))
>>> bool(np.allclose(five_cell.defect, 2 * np.pi - 3 * np.arccos(1 / 3)))
True
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...checks.base import Check
from ...errors import InputError, UsageError
from ...mesh.triangles import EPSILON
from ...support.arrays import Floats, Ints
from .frames import Frames, frames
from .simplicial import Complex


class PolyhedralManifold:
    """An n-manifold of flat simplices in E^d, d ≥ n ≥ 2, with or without boundary; also in E^n itself.

    points: (V, d). simplices: (C, n + 1) vertex indices; their order gives each simplex its orientation, and the
    simplices need not agree. Nothing depends on scale or offset. Faces of codimension two are called hinges.
    Links of faces of higher codimension are not examined: the curvature does not depend on them.
    Errors: InputError for a degenerate or repeated simplex, a ridge of more than two, a hinge that is not one cycle or
    path of simplices, and arrays that are no complex.
    Source: Sullivan, Curvatures of Smooth and Discrete Surfaces (vector bundles on polyhedral manifolds); Regge.
    """

    def __init__(self, points: ArrayLike, simplices: ArrayLike) -> None:
        self.points, self.simplices = _checked(points, simplices)
        self.n, self.d = self.simplices.shape[1] - 1, self.points.shape[1]
        self.complex = Complex(self.simplices)
        _ = self.complex.rounds  # refuses a complex that is no manifold
        # Geometry of the corners, rows sorted as in the complex.
        used = self.points[np.unique(self.simplices)]
        size = float(np.abs(used / 2 - used[0] / 2).max())
        self._points = np.ldexp(self.points, -int(np.frexp(size)[1]))
        self._geometry: Frames = frames(self._points, self.simplices)
        order = self.complex.order[:, :, None]
        self._inward = np.take_along_axis(self._geometry.inward, order, axis=1)

    # ------------------------------------------------------------------ ridges

    @property
    def ridges(self) -> Ints:
        """(R, n) vertices of each ridge (face of codimension one), sorted."""
        return self.complex.ridges

    @property
    def ridge_simplices(self) -> Ints:
        """(R, 2) the two simplices at each ridge, the lower first; -1 beyond the boundary."""
        sides = self.complex.sides
        return np.where(sides < 0, -1, sides // (self.n + 1))

    @property
    def frames(self) -> Floats:
        """(C, n, d) orthonormal rows that span each simplex, right-handed with its corners as given."""
        return self._geometry.frames

    @cached_property
    def rotations(self) -> Floats:
        """(R, n, n) Levi-Civita transport across each ridge, from the frame of its first simplex to its second's.

        Unfolding about the ridge: directions in the ridge stay, the outward conormal of the one simplex becomes the
        inward conormal of the other. Orthogonal; of determinant +1 where the two simplices agree in orientation. Null
        on the boundary.
        """
        rotation = np.full((len(self.ridges), self.n, self.n), np.nan)
        inside = np.flatnonzero(self.complex.sides[:, 1] >= 0)
        inner, outer = self.complex.sides[inside].T
        flat = self._inward.reshape(-1, self.n)
        out, into = -flat[inner], flat[outer]
        inner_frame, outer_frame = (self.frames[flag // (self.n + 1)] for flag in (inner, outer))
        turn = outer_frame @ inner_frame.swapaxes(1, 2)
        turn -= (turn @ out[:, :, None]) @ out[:, None, :]
        rotation[inside] = turn + into[:, :, None] @ out[:, None, :]
        return rotation

    def transport(self, path: Sequence[int]) -> Floats:
        """(n, n) parallel transport along a path of simplices, from the frame of its first to that of its last.

        Errors: UsageError for a simplex that does not exist, or two consecutive ones that share no ridge.
        """
        outside = [c for c in path if not 0 <= c < len(self.simplices)]
        if outside or not len(path):
            problem = f"simplex {outside[0]} does not exist" if outside else "the path is empty"
            raise UsageError(f"{problem}, expected indices from 0 to {len(self.simplices) - 1}")
        turn = np.eye(self.n)
        for simplex, neighbour in pairwise(path):
            ridge = np.intersect1d(self.complex.ridge_of[simplex], self.complex.ridge_of[neighbour])
            if simplex == neighbour or not len(ridge):
                raise UsageError(
                    f"simplices {simplex} and {neighbour} share no ridge; a path goes from neighbour to neighbour"
                )
            step = self.rotations[ridge[0]]
            turn = (step if self.ridge_simplices[ridge[0], 0] == simplex else step.T) @ turn
        return turn

    def parallel_transport(self, vectors: ArrayLike, path: Sequence[int]) -> Floats:
        """Tangent vectors (d,) or (k, d) of a path's first simplex, carried parallel to its last; lengths and angles
        stay, a part normal to the first simplex is dropped.
        """
        turn = self.transport(path)
        coordinates = np.asarray(vectors, np.float64) @ self.frames[path[0]].T
        return np.asarray(coordinates @ turn.T @ self.frames[path[-1]])

    # ------------------------------------------------------------------ hinges

    @property
    def hinges(self) -> Ints:
        """(H, n - 1) vertices of each hinge (face of codimension two), sorted; rows in lexicographic order."""
        return self.complex.hinges

    @property
    def boundary(self) -> NDArray[np.bool_]:
        """(H,) hinges that lie in the boundary."""
        return self.complex.boundary

    @property
    def valence(self) -> Ints:
        """(H,) number of simplices at each hinge."""
        return self.complex.valence

    @cached_property
    def _angles(self) -> Floats:
        """(C, n + 1, n + 1) dihedral angles for sorted corners: π less the angle between two ridges' conormals."""
        inward, across = self._inward[:, :, None, :], self._inward[:, None, :, :]
        sum_, gap = ((side * side).sum(axis=3) for side in (inward + across, inward - across))
        angles = 2 * np.arctan2(np.sqrt(sum_), np.sqrt(gap))
        angles[:, np.arange(self.n + 1), np.arange(self.n + 1)] = np.nan
        return np.asarray(angles)

    @property
    def dihedral(self) -> Floats:
        """(C, n + 1, n + 1) interior dihedral angle of each simplex at the hinge opposite corners i and j, as given."""
        place = np.argsort(self.complex.order, axis=1)
        each = np.arange(len(self.simplices))
        return self._angles[each[:, None, None], place[:, :, None], place[:, None, :]]

    @cached_property
    def angle_sum(self) -> Floats:
        """(H,) sum of the interior dihedral angles at each hinge."""
        return self._sum(self._angles.ravel())

    @cached_property
    def defect(self) -> Floats:
        """(H,) 2π − Σ interior dihedral angles, K if n = 2; on the boundary its turning π − Σ, κ_g if n = 2."""
        return np.where(self.boundary, 1.0, 2.0) * np.pi - self.angle_sum

    def _sum(self, of_turns: Floats) -> Floats:
        turns, start = self.complex.rounds
        return np.asarray(np.add.reduceat(of_turns[turns], start[:-1]))

    @cached_property
    def holonomy(self) -> Floats:
        """(H, n, n) parallel transport once about each interior hinge, in the frame of its lowest simplex; null on the
        boundary.

        The path is counterclockwise about the hinge's sorted vertices as that simplex is oriented. The holonomy is the
        rotation about the hinge by its defect, in the sense of the path.
        """
        size = self.n + 1
        turns, start = self.complex.rounds
        holonomy = np.full((len(self.hinges), self.n, self.n), np.nan)
        inside = np.flatnonzero(~self.boundary)
        inside = inside[np.argsort(-self.valence[inside], kind="stable")]
        turn = np.tile(np.eye(self.n), (len(inside), 1, 1))
        lengths = self.valence[inside]
        for step in range(int(lengths.max(initial=0))):
            # The longest rounds come first, so those still open are a prefix.
            active = int(np.searchsorted(-lengths, -step, side="left"))
            at = turns[start[inside[:active]] + step]
            flag = at // size // size * size + at % size
            ridge = self.complex.ridge_of.ravel()[flag]
            forth = self.rotations[ridge]
            back = self.complex.sides[ridge, 0] != flag
            forth[back] = forth[back].swapaxes(1, 2)
            turn[:active] = forth @ turn[:active]
        holonomy[inside] = turn
        return holonomy

    @cached_property
    def _planes(self) -> tuple[Floats, Floats]:
        """(H, n) twice: the plane across each hinge in the frame where its round starts, x along the ridge where the
        round enters that simplex, y into it.
        """
        size = self.n + 1
        turns, start = self.complex.rounds
        first = turns[start[:-1]]
        c, i, j = first // size**2, first // size % size, first % size
        y, x = self._inward[c, i], self._inward[c, j]
        for _ in range(2):  # the second pass removes the rounding error of y where the angle is flat
            x = x - (x * y).sum(axis=1)[:, None] * y
            x = x / np.sqrt((x * x).sum(axis=1))[:, None]
        return x, y

    @cached_property
    def holonomy_angle(self) -> Floats:
        """(H,) rotation angle of the holonomy in the sense of its path, in (−π, π]; null on the boundary."""
        (x, y), turn = self._planes, self.holonomy
        turned_x, turned_y = ((turn @ side[:, :, None])[:, :, 0] for side in (x, y))
        sine = (y * turned_x).sum(axis=1) - (x * turned_y).sum(axis=1)
        cosine = (x * turned_x).sum(axis=1) + (y * turned_y).sum(axis=1)
        return np.asarray(np.arctan2(sine, cosine))

    # ------------------------------------------------------------------ the identity

    @cached_property
    def holonomy_residual(self) -> Floats:
        """(H,) distance (Frobenius) of the holonomy from the rotation by the defect; null on the boundary."""
        x, y = self._planes
        cosine, sine = np.cos(self.defect)[:, None, None], np.sin(self.defect)[:, None, None]
        xx, yy, yx = (a[:, :, None] * b[:, None, :] for a, b in ((x, x), (y, y), (y, x)))
        rotation = np.eye(self.n) + (cosine - 1) * (xx + yy) + sine * (yx - yx.swapaxes(1, 2))
        gap = self.holonomy - rotation
        return np.asarray(np.sqrt((gap * gap).sum(axis=(1, 2))))

    def check(self) -> Check:
        """`holonomy`: about every interior hinge it is the rotation by the defect; reports the worst hinge.

        The bound is (16 + n²) ε times the sum over the simplices there of longest edge over smallest height.
        """
        size = self.n + 1
        bound = (16 + self.n**2) * EPSILON * self._sum(np.repeat(self._geometry.stretch, size * size))
        strain = np.where(self.boundary, -1.0, self.holonomy_residual / bound)
        strain[np.isnan(strain)] = np.inf
        if not len(strain) or self.boundary.all():
            reason = "every face of codimension two is on the boundary"
            return Check("holonomy", "whole", "not_applicable", None, None, None, None, reason)
        worst = int(np.argmax(strain))
        return Check(
            "holonomy",
            "whole",
            "pass" if strain[worst] <= 1 else "fail",
            float(self.holonomy_angle[worst]),
            float(np.pi - np.remainder(np.pi - self.defect[worst], 2 * np.pi)),
            float(self.holonomy_residual[worst]),
            float(bound[worst]),
            f"holonomy against angle defect (mod 2π) at {int((~self.boundary).sum())} faces of codimension two",
        )


def _checked(points: ArrayLike, simplices: ArrayLike) -> tuple[Floats, Ints]:
    """The arrays, after a check that they form a complex of simplices of dimension 2 or more."""
    given, rows = np.asarray(points), np.asarray(simplices)
    if given.ndim != 2 or given.dtype.kind not in "fiu":
        raise InputError(f"points have shape {given.shape} and type {given.dtype}, expected numbers of shape (V, d)")
    if rows.ndim != 2 or rows.dtype.kind not in "iu" or rows.shape[1] < 3 or not len(rows):
        raise InputError(
            f"simplices have shape {rows.shape} and type {rows.dtype}, expected indices of shape (C, n + 1), n ≥ 2"
        )
    if rows.shape[1] - 1 > given.shape[1]:
        raise InputError(f"simplices of dimension {rows.shape[1] - 1} do not fit into E^{given.shape[1]}")
    if rows.min() < 0 or rows.max() >= len(given):
        c, k = (int(i) for i in np.argwhere((rows < 0) | (rows >= len(given)))[0])
        problem = f"corner {rows[c, k]} does not exist, expected a vertex index from 0 to {len(given) - 1}"
        raise InputError(problem, place=f"simplex {c}")
    points, rows = given.astype(np.float64), rows.astype(np.int64)
    bad = ~np.isfinite(points).all(axis=1)
    if bad[rows].any():
        raise InputError("coordinates are not finite", place=f"vertex {int(rows[bad[rows]][0])}")
    return points, rows
