"""Exact curvatures of smooth surfaces, as columns named and signed like the vertex table.

kappa > 0 where the surface is convex seen from the side the normal points to: the unit sphere with its outward normal
has kappa_1 = kappa_2 = 1, h_signed = 2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .model import ExactColumns, FloatArray


def principal(first: ArrayLike, second: ArrayLike) -> ExactColumns:
    """Columns from the two principal curvatures, each (V,), in any order."""
    a, b = np.broadcast_arrays(np.asarray(first, np.float64), np.asarray(second, np.float64))
    # Adding 0.0 replaces -0.0 by 0.0.
    a, b = a + 0.0, b + 0.0
    h_signed = a + b
    return {
        "h": np.abs(h_signed),
        "h_signed": h_signed,
        "K_density": a * b + 0.0,
        "kappa_1": np.maximum(a, b),
        "kappa_2": np.minimum(a, b),
    }


def facing(columns: ExactColumns, normal: ArrayLike) -> ExactColumns:
    """The columns with the normal (V, 3), of any length, as `normal_x`, `normal_y`, `normal_z`."""
    vector = np.asarray(normal, np.float64)
    unit = vector / np.linalg.norm(vector, axis=-1, keepdims=True) + 0.0
    count = len(next(iter(columns.values())))
    return columns | {f"normal_{axis}": np.broadcast_to(unit[..., k], (count,)).copy() for k, axis in enumerate("xyz")}


def revolved(points: FloatArray, out: ArrayLike, up: ArrayLike) -> FloatArray:
    """Normals (V, 3) of a surface of revolution about the z axis: their parts away from the axis and along it."""
    x, y, _ = points.T
    across = np.hypot(x, y)
    outward = np.asarray(out, np.float64) / np.where(across > 0, across, 1.0)
    return np.stack([x * outward, y * outward, np.broadcast_to(np.asarray(up, np.float64), x.shape)], axis=1)


def constant(count: int, first: float, second: float) -> ExactColumns:
    """Columns of a surface whose principal curvatures are the same everywhere."""
    return principal(np.full(count, first), np.full(count, second))


def one_sided(columns: ExactColumns) -> ExactColumns:
    """Keep the columns that are even in the normal, for surfaces without an outer side."""
    return {name: columns[name] for name in ("h", "K_density")}


def of_shape_operator(a: FloatArray, b: FloatArray, d: FloatArray) -> ExactColumns:
    """Columns from the shape operator ((a, b), (b, d)) in an orthonormal tangent frame; accurate at umbilics too."""
    middle, gap = (a + d) / 2, np.hypot((a - d) / 2, b)
    return principal(middle + gap, middle - gap) | {"h": np.abs(a + d), "h_signed": a + d, "K_density": a * d - b * b}


def of_parametrisation(
    xu: FloatArray, xv: FloatArray, xuu: FloatArray, xuv: FloatArray, xvv: FloatArray
) -> ExactColumns:
    """Columns from the derivatives of a parametrisation, each (V, 3), with the normal along xu x xv."""
    length_u = np.linalg.norm(xu, axis=1)
    e1 = xu / length_u[:, None]
    skew = _dot(xv, e1)
    across = xv - skew[:, None] * e1
    length_v = np.linalg.norm(across, axis=1)
    normal = np.cross(e1, across / length_v[:, None])
    # The second fundamental form of the frame e1 = xu / |xu|, e2 = (xv - skew e1) / |...|, convex positive.
    a = -_dot(xuu, normal) / length_u**2
    mixed = -_dot(xuv, normal) / length_u
    b = (mixed - skew * a) / length_v
    d = (-_dot(xvv, normal) - 2 * skew * mixed + skew**2 * a) / length_v**2
    return facing(of_shape_operator(a, b, d), normal)


def of_graph(fx: FloatArray, fy: FloatArray, fxx: FloatArray, fxy: FloatArray, fyy: FloatArray) -> ExactColumns:
    """Columns of the graph z = f(x, y), normal upward, from the derivatives of f, each (V,)."""
    zero, unit = np.zeros_like(fx), np.ones_like(fx)

    def column(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
        return np.stack([x, y, z], axis=1)

    second = [column(zero, zero, f) for f in (fxx, fxy, fyy)]
    return of_parametrisation(column(unit, zero, fx), column(zero, unit, fy), *second)


def of_quadric(weights: tuple[float, float, float], points: FloatArray) -> ExactColumns:
    """Columns of the ellipsoid w . x^2 = 1 at its points (V, 3), normal outward: S = P diag(2w) P / |gradient|."""
    gradient = 2 * points * np.asarray(weights)
    length = np.linalg.norm(gradient, axis=1)
    normal = gradient / length[:, None]
    # A frame that never degenerates: e1 leaves out the axis that the normal is most along.
    helper = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    e1 = np.cross(helper, normal)
    e1 /= np.linalg.norm(e1, axis=1)[:, None]
    e2 = np.cross(normal, e1)
    hessian = 2 * np.asarray(weights)
    entries = (_dot(first * hessian, second) / length for first, second in ((e1, e1), (e1, e2), (e2, e2)))
    return facing(of_shape_operator(*entries), normal)


def inverted(first: ArrayLike, second: ArrayLike, normal: FloatArray, offset: FloatArray) -> ExactColumns:
    """Columns of the image d / |d|^2 of a surface, where d = offset (V, 3) leads to it from the centre of inversion.

    k -> |d|^2 k - 2 n.d for the normal n, whose image n - 2 (n.d) d / |d|^2 points outward if the centre is outside.
    """
    square, shift = _dot(offset, offset), 2 * _dot(normal, offset)
    image = normal - (shift / square)[:, None] * offset
    return facing(principal(square * np.asarray(first) - shift, square * np.asarray(second) - shift), image)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ij,ij->i", a, b), np.float64)
