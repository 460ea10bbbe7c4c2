"""Meshes of the files before damage: sound bodies, sheets and heaps of polygons, at any scale and place."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from tests.helpers.spelling import Meant, meant

_CUBE = [(float(x), float(y), float(z)) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
_SIDES: list[tuple[int, ...]] = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def _torus(m: int = 4, n: int = 3) -> Meant:
    """A torus of m by n skew quadrilaterals, each halved."""
    points = [(2.0 * i + j, (i * i) % 5 + 0.5 * j, float((i + 2 * j) % 3)) for i in range(m) for j in range(n)]
    faces: list[tuple[int, ...]] = []
    for i in range(m):
        for j in range(n):
            a, b = i * n + j, (i + 1) % m * n + j
            c, d = (i + 1) % m * n + (j + 1) % n, i * n + (j + 1) % n
            faces += [(a, b, c), (a, c, d)]
    return Meant(points, faces)


def _mobius(n: int = 5) -> Meant:
    """A strip of n twisted quadrilaterals, each halved."""
    points = [(float(i), float(j), i * 0.3 + j * (1 - i)) for i in range(n) for j in range(2)]
    faces: list[tuple[int, ...]] = []
    for i in range(n):
        a, b = 2 * i, 2 * i + 1
        c, d = (2 * i + 2, 2 * i + 3) if i < n - 1 else (1, 0)
        faces += [(a, c, d), (a, d, b)]
    return Meant(points, faces)


_CORNER = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 3.0, 0.0), (0.0, 0.0, 5.0)]
_NOTCHED = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 4.0, 0.0), (2.0, 1.0, 0.0), (0.0, 4.0, 0.0)]
_LOOSE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.5), (0.0, 1.0, 0.0), (7.0, 7.0, 7.0)]
SOUND = (
    Meant(_CORNER, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]),
    Meant(_CUBE, _SIDES),
    Meant(_CUBE, _SIDES[:-1]),
    Meant(_NOTCHED, [(0, 1, 2, 3, 4)]),
    Meant(_LOOSE, [(0, 1, 2), (0, 3, 2)]),
    _torus(),
    _mobius(),
)


@st.composite
def placed(draw: st.DrawFn) -> Meant:
    """A sound shape, scaled and moved, with some of its corners made equal, collinear or nearly so."""
    shape = draw(st.sampled_from(SOUND))
    scale = draw(st.sampled_from([1.0, 1.0, 0.1, 1e-9, 1e9, 1e150, 1e-150, 1e-320, 1e300, 1e-3]))
    offset = draw(st.sampled_from([0.0, 0.0, 1.0, 1e6, 1e12, -1e300]))
    points = [tuple(x * scale + offset for x in p) for p in shape.points]
    for _ in range(draw(st.sampled_from([0, 0, 0, 1, 2]))):
        k, other = draw(st.integers(0, len(points) - 1)), draw(st.integers(0, len(points) - 1))
        points[k] = (points[other][0], points[other][1], points[draw(st.sampled_from([k, other]))][2])
    polygons = list(shape.polygons)
    for _ in range(draw(st.sampled_from([0, 0, 1, 3]))):
        polygon = draw(st.sampled_from(polygons))
        polygons.append(draw(st.sampled_from([polygon, polygon[::-1], polygon[1:] + polygon[:1]])))
    return Meant([(x, y, z) for x, y, z in points], polygons)


@st.composite
def _heap(draw: st.DrawFn, triangles: bool) -> Meant:
    """Any polygons on a few points of a coarse grid."""
    near = st.integers(-2, 2).map(float)
    points = draw(st.lists(st.tuples(near, near, near), min_size=3, max_size=8, unique=True))
    index = st.integers(0, len(points) - 1)
    polygon = st.lists(index, min_size=3, max_size=3 if triangles else 6, unique=True).map(tuple)
    return Meant(points, draw(st.lists(polygon, min_size=1, max_size=12)))


# Powers of two in the coordinates of one mesh: of sizes that meet, of sizes that do not, and all that there are.
_POWERS = (range(-60, 60), (-100, -53, -27, 0, 30), (-1000, -500, -300, -50, 0, 50, 300, 500, 1000), range(-1074, 1023))


@st.composite
def extreme(draw: st.DrawFn) -> Meant:
    """Triangles whose coordinates share no size: needles of needles, points on points, the ends of the range."""
    shape = draw(st.one_of(st.sampled_from(SOUND).map(_halved), _heap(True)))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    size = len(shape.points), draw(st.sampled_from((1, 3)))
    points = np.ldexp(rng.uniform(-1, 1, (len(shape.points), 3)), rng.choice(draw(st.sampled_from(_POWERS)), size))
    points[rng.random(points.shape) < draw(st.sampled_from((0.0, 0.2, 0.5, 0.8)))] = 0.0
    for _ in range(draw(st.integers(0, 2))):
        points[rng.integers(len(points))] = points[rng.integers(len(points))]
    return Meant([(x, y, z) for x, y, z in points.tolist()], shape.polygons)


def shapes(*, single: bool = False, triangles: bool = False) -> st.SearchStrategy[Meant]:
    """Any of these, or any few points with any few polygons on them; single: positions that fit float32."""
    heap = st.one_of(meant(single=single, triangles=triangles), _heap(triangles))
    if single or triangles:
        fit = placed().filter(lambda m: all(abs(x) < 1e38 for p in m.points for x in p))
        return st.one_of(fit.map(_halved), heap)
    return st.one_of(placed(), heap)


def _halved(shape: Meant) -> Meant:
    return Meant(shape.points, [(p[0], p[k], p[k + 1]) for p in shape.polygons for k in range(1, len(p) - 1)])
