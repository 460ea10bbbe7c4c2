"""Contact of two triangles in rational arithmetic: clip one by the other, and look at the piece that is left."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

Point = tuple[Fraction, ...]


def kind_of_contact(p: Sequence[Sequence[float]], q: Sequence[Sequence[float]]) -> str:
    """`apart`, `crossing`, `overlapping`, `folded` or `touching`, as curvcli.mesh.intersections.pairs.KINDS."""
    a, b = (tuple(tuple(Fraction(float(x)) for x in corner) for corner in face) for face in (p, q))
    common = set(a) & set(b)
    piece = _common_points(a, b)
    sides, others = _sides(a, b), _sides(b, a)
    area = any(any(_cross(_minus(x, piece[0]), _minus(y, piece[0]))) for x, y in combinations(piece, 2))
    if area and not any(sides):
        return "folded" if len(common) == 2 else "overlapping"
    if len(common) == 2 or not set(piece) - common:
        return "apart"
    both_sides = min(sides) < 0 < max(sides) and min(others) < 0 < max(others)
    return "crossing" if len(piece) > 1 and both_sides else "touching"


def _common_points(a: tuple[Point, ...], b: tuple[Point, ...]) -> list[Point]:
    """Corners of the intersection, a convex polygon, segment or point."""
    normal = _cross(_minus(b[1], b[0]), _minus(b[2], b[0]))
    piece = list(a)
    for direction in (normal, tuple(-x for x in normal)):
        piece = _clip(piece, b[0], direction)
    for k in range(3):
        piece = _clip(piece, b[k], _cross(normal, _minus(b[(k + 1) % 3], b[k])))
    return piece


def _clip(piece: list[Point], origin: Point, inward: Point) -> list[Point]:
    """The part of a convex piece on one side of a plane."""
    heights = [_dot(inward, _minus(x, origin)) for x in piece]
    kept: list[Point] = []
    for k, (x, h) in enumerate(zip(piece, heights, strict=True)):
        if h >= 0:
            kept.append(x)
        y, g = piece[(k + 1) % len(piece)], heights[(k + 1) % len(piece)]
        if h * g < 0:
            kept.append(tuple(s + h / (h - g) * (t - s) for s, t in zip(x, y, strict=True)))
    return list(dict.fromkeys(kept))


def _sides(face: tuple[Point, ...], points: tuple[Point, ...]) -> list[Fraction]:
    normal = _cross(_minus(face[1], face[0]), _minus(face[2], face[0]))
    return [_dot(normal, _minus(x, face[0])) for x in points]


def has_area(face: Sequence[Sequence[float]]) -> bool:
    a, b, c = (tuple(Fraction(float(x)) for x in corner) for corner in face)
    return any(_cross(_minus(b, a), _minus(c, a)))


def _minus(x: Point, y: Point) -> Point:
    return tuple(s - t for s, t in zip(x, y, strict=True))


def _cross(x: Point, y: Point) -> Point:
    return tuple(x[i] * y[j] - x[j] * y[i] for i, j in ((1, 2), (2, 0), (0, 1)))


def _dot(x: Point, y: Point) -> Fraction:
    return sum((s * t for s, t in zip(x, y, strict=True)), start=Fraction(0))
