"""Differences between two reports, or between the columns of two tables, beyond tolerance.

A number has moved when |a − b| > atol + rtol · max(|a|, |b|, typical) + noise. `typical` is the size of the terms where
a value can cancel: area^(L/2) for signed totals of length exponent L, the percentiles of its column for a statistic,
the median size of its column for a cell. `noise` is a bound on its rounding error, in multiples of ε and of the mean
edge length to the power L; it is left out where rtol is 0, which demands equality to the last bit. So Σ**A** of a
closed surface, zero up to rounding, has not moved when its rounding has.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...curvatures.catalogue import load_passes
from ...curvatures.derived import derived
from ...curvatures.quantity import Quantity
from ...curvatures.registry import passes
from ...mesh.triangles import EPSILON

STATISTICS = ("min", "max", "mean", "area_mean", "std", "p02", "median", "p98")
# For a loop: its measures by length exponent; its other entries are compared as they are.
_LOOP = {"length": 1, "total_curvature": 0, "sum_kappa_g": 0, "vector_area": 2, "force": 1, "torque": 2}
_LOOP |= {"holonomy": 0, "writhe": 0, "twist": 0}
# Rounding of other entries does not depend on the curve.
_BOUNDS = ("writhe_error", "linking_error")

Key = tuple[str, ...]
Size = TypeVar("Size", float, NDArray[np.float64])


@dataclass(frozen=True)
class Tolerance:
    """Tolerance for a number: relative to its size and that of its terms, and absolute."""

    rtol: float = 1e-9
    atol: float = 0.0

    def allowed(self, size: Size, noise: float) -> Size:
        """Largest move of a number of this size, or of each of several."""
        return self.atol + self.rtol * size + (noise if self.rtol > 0 else 0.0)


@dataclass(frozen=True)
class Difference:
    """One value that differs, by its dotted key: moved, changed, absent_in_a or absent_in_b."""

    key: str
    status: str
    a: Any
    b: Any
    moved: float | None
    allowed: float | None


class Leaf(NamedTuple):
    """Value of a report; typical is None where only equality counts, infinite where any number is the same."""

    value: Any
    typical: float | None = None
    noise: float = 0.0


def dotted(key: Key) -> str:
    """Key in the form that `--only` and `--ignore` match."""
    return ".".join(key)


def selector(only: Collection[str] = (), ignore: Collection[str] = ()) -> Callable[[str], bool]:
    """Filter of dotted keys: true if the key, or a prefix of it, matches a pattern of `only` and none of `ignore`."""

    def matches(key: str, patterns: Collection[str]) -> bool:
        return any(fnmatchcase(key, pattern) or fnmatchcase(key, f"{pattern}.*") for pattern in patterns)

    return lambda key: (not only or matches(key, only)) and not matches(key, ignore)


DEFAULT, EVERYTHING = Tolerance(), selector()


def compare_reports(
    a: Mapping[str, Any],
    b: Mapping[str, Any],
    tolerance: Tolerance = DEFAULT,
    wanted: Callable[[str], bool] = EVERYTHING,
    *,
    common: bool = False,
) -> tuple[list[Difference], int]:
    """Differences between two reports, in the order of the report, and the number of values compared.

    a, b: reports as `Analysis.report()` gives them. wanted: chooses dotted keys such as `totals.K`. common: leave out
    keys that only one of them has. Paths, hashes, versions, timings and the numbers inside checks are not compared.
    """
    leaves_a, leaves_b = dict(leaves(a)), dict(leaves(b))
    for listed in ("components", "loops"):
        if len(a[listed]) != len(b[listed]):  # the count shows it; the entries have no partners
            leaves_a, leaves_b = (
                {k: v for k, v in side.items() if k[0] != listed or k[1] == "count"} for side in (leaves_a, leaves_b)
            )
    differences: list[Difference] = []
    compared = 0
    absent: set[str] = set()
    for key in dict.fromkeys([*leaves_a, *leaves_b]):
        if not wanted(dotted(key)):
            continue
        if key in leaves_a and key in leaves_b:
            compared += 1
            difference = _compared(key, leaves_a[key], leaves_b[key], tolerance)
            differences += [difference] if difference else []
        elif not common:
            lacking = leaves_b if key in leaves_a else leaves_a
            name = dotted(key if any(other_key[:2] == key[:2] for other_key in lacking) else key[:2])
            if name not in absent:
                absent.add(name)
                differences.append(
                    Difference(name, "absent_in_b" if key in leaves_a else "absent_in_a", None, None, None, None)
                )
    return differences, compared


def _compared(key: Key, a: Leaf, b: Leaf, tolerance: Tolerance) -> Difference | None:
    if a.value == b.value:
        return None
    first, second = _numbers(a.value), _numbers(b.value)
    if a.typical is None or b.typical is None or first is None or second is None or len(first) != len(second):
        return Difference(dotted(key), "changed", a.value, b.value, None, None)
    size = max(math.hypot(*first), math.hypot(*second), a.typical, b.typical) if tolerance.rtol > 0 else 0.0
    allowed = tolerance.allowed(size, max(a.noise, b.noise))
    moved = math.dist(first, second)
    return None if moved <= allowed else Difference(dotted(key), "moved", a.value, b.value, moved, allowed)


def _numbers(value: Any) -> list[float] | None:
    components = value if isinstance(value, list) else [value]
    numeric = all(isinstance(part, int | float) and not isinstance(part, bool) for part in components)
    return [float(part) for part in components] if numeric else None


def leaves(report: Mapping[str, Any]) -> Iterator[tuple[Key, Leaf]]:
    """Every compared value of a report, with the scale for its moves."""
    for name in ("mean", "area", "orient", "unit", "regions", "scale", "normals", "settings", "bending_rigidity"):
        yield ("conventions", name), Leaf(report["conventions"].get(name))
    flatness = _flattest(report)
    yield from _piece(report, (), flatness)
    yield ("components", "count"), Leaf(len(report["components"]))
    if len(report["components"]) > 1:
        for index, piece in enumerate(report["components"]):
            yield from _piece(piece, ("components", str(index)), flatness)
    yield ("loops", "count"), Leaf(len(report["loops"]))
    for index, loop in enumerate(report["loops"]):
        for name, value in loop.items():
            if name in _BOUNDS:
                continue
            size = power(loop.get("length") or 0.0, _LOOP.get(name, 0))
            leaf = Leaf(value, size, 256 * EPSILON * size) if name in _LOOP else Leaf(value)
            yield ("loops", str(index), name), leaf
    for piece in report["regions"]:
        yield from _piece(piece, ("regions", str(piece["name"])), flatness)
    yield from _columns(report)
    for check in report["checks"]:
        yield ("checks", check["name"], check["scope"]), Leaf(check["status"])
    for warning in report["warnings"]:
        yield ("warnings", warning["code"]), Leaf(warning["count"])


def _piece(piece: Mapping[str, Any], prefix: Key, flatness: float) -> Iterator[tuple[Key, Leaf]]:
    """Topology, totals and further values of the whole, a component or a region."""
    topology, totals = piece["topology"], piece["totals"]
    for name, count in topology.items():
        yield (*prefix, "topology", name), Leaf(count)
    area, edge = totals.get("area") or 0.0, edge_length(piece)
    terms = 16 * EPSILON * (topology["faces"] + topology["vertices"])
    exponents = total_exponents()

    def total(value: Any, exponent: int, cancels: bool) -> Leaf:
        return Leaf(value, power(area, exponent / 2) if cancels else 0.0, terms * power(edge, exponent))

    for name, value in totals.items():
        known = name if name in exponents else name.rpartition("_")[0]  # of several scales, NAME_SCALE
        leaf = total(value, *exponents[known]) if known in exponents else Leaf(value, 0.0)
        yield (*prefix, "totals", name), leaf
    steiner = piece.get("steiner")
    if steiner is not None:
        yield (*prefix, "steiner", "convex"), Leaf(steiner["convex"])
        for k, value in enumerate(steiner["coefficients"] or [None] * 4):
            yield (*prefix, "steiner", f"coefficients.{k}"), total(value, 3 - k, k > 1)
    noise = 256 * EPSILON
    for section, name, leaf in (
        ("cmc", "H", Leaf(None, power(area, -0.5), noise * power(edge, -1))),
        ("cmc", "residual_max", Leaf(None, 0.0, noise * edge)),
        ("cmc", "residual_density_max", Leaf(None, 0.0, noise * power(edge, -1))),
        ("minimal", "H_vec_max", Leaf(None, 0.0, noise * edge)),
        ("minimal", "H_vec_density_max", Leaf(None, 0.0, noise * power(edge, -1))),
        ("normals", "angle_max", Leaf(None, 0.0, noise * flatness)),
        ("normals", "angle_mean", Leaf(None, 0.0, noise * flatness)),
    ):
        # Reports of older versions lack some.
        if name in (piece.get(section) or {}):
            yield (*prefix, section, name), leaf._replace(value=piece[section][name])


def _columns(report: Mapping[str, Any]) -> Iterator[tuple[Key, Leaf]]:
    """Statistics of every column; the axes of a vector share one size."""
    load_passes()
    edge = edge_length(report)
    sizes: dict[str, float] = {}
    for name, column in report["columns"].items():
        size = max(abs(column["p02"] or 0.0), abs(column["p98"] or 0.0))
        sizes[stem(name)] = max(size, sizes.get(stem(name), 0.0))
    for name, column in report["columns"].items():
        noise, quantity = noise_of(name, column["length_exponent"], edge), passes.column(name)
        for statistic in STATISTICS:
            spread = (column["std"] or 0.0) if statistic in ("mean", "area_mean") else 0.0
            # The signs of lines are arbitrary, and so are all statistics of their components.
            typical = math.inf if quantity and quantity.line else max(sizes[stem(name)], spread)
            yield ("columns", name, statistic), Leaf(column[statistic], typical, noise)
        yield ("columns", name, "nulls"), Leaf(column["nulls"])


def _flattest(report: Mapping[str, Any]) -> float:
    """Factor by which **H**_p magnifies rounding on the flattest part: 1 / (h · edge length)."""
    h, edge = report["columns"].get("h"), edge_length(report)
    least = h["min"] if h is not None else None
    return min(1 / (least * edge), 1 / EPSILON) if least and least * edge > 0 else 1 / EPSILON


def total_exponents() -> dict[str, tuple[int, bool]]:
    """Length exponent of each total, and whether its terms can cancel."""
    exponents = {name: (q.length_exponent, q.signed or q.vector) for name, q in _by_total().items()}
    exponents["volume"] = 3, False
    return exponents | {name: (each.length_exponent, False) for name, each in derived.items()}


def _by_total() -> dict[str, Quantity]:
    load_passes()
    return {quantity.total or "": quantity for quantity in passes.totals()}


def stem(column: str) -> str:
    """Name shared by the axes of a vector, and by positions."""
    if column in ("x", "y", "z"):
        return "xyz"
    return column[:-2] if column[-2:] in ("_x", "_y", "_z") else column


def noise_of(column: str, exponent: int, edge: float) -> float:
    """Bound on the rounding of one value of a column on a mesh of this mean edge length."""
    quantity, relative = passes.column(column), 256 * EPSILON
    # Differences of nearly equal numbers under a root lose half of the digits: κ₁ − κ₂ at umbilics.
    return (math.sqrt(relative) if quantity and quantity.rooted else relative) * power(edge, exponent)


def edge_length(piece: Mapping[str, Any]) -> float:
    """Length scale of one face, √(area / faces); 0 where it is unknown."""
    area, faces = piece["totals"].get("area"), piece["topology"]["faces"]
    return math.sqrt(area / faces) if area and faces and area > 0 else 0.0


def power(base: float, exponent: float) -> float:
    """Power of a length; 0 for an unknown length or beyond the range of doubles."""
    if exponent == 0:
        return 1.0
    try:
        return base**exponent if base > 0 else 0.0
    except OverflowError:
        return 0.0
