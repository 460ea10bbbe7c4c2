"""Exact values of `tests/exact`, under the names of the columns, totals and topology of the report."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import mpmath as mp  # type: ignore[import-untyped]
import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).parents[1] / "exact"
MESHES = {path.stem: path for path in sorted((FOLDER / "meshes").iterdir())}
NAMES = tuple(MESHES)

Array = NDArray[Any]

# Null where a star has no orientation.
ODD = {"A_vec", "h_signed", "h_perp", "h_normal", "kappa_1", "kappa_2", "shape_index"}


@cache
def expected(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((FOLDER / "expected" / f"{name}.json").read_text())
    return found


def array(values: list[Any]) -> Array:
    """Numbers or vectors with NaN for null."""
    width = next((len(value) for value in values if isinstance(value, list)), None)
    empty: Any = math.nan if width is None else [math.nan] * width
    return np.array([empty if value is None else value for value in values], np.float64)


class Vertices:
    """The vertex columns of one mesh by the product's names."""

    def __init__(self, name: str) -> None:
        self.known = expected(name)
        self.given = {key: array(values) for key, values in self.known["vertices"].items() if key != "boundary"}
        self.boundary = np.array([flag is True for flag in self.known["vertices"]["boundary"]])
        self.orientable = self.known["topology"]["orientable"]

    def columns(self) -> dict[str, Array]:
        """Every column whose exact value follows from the file."""
        g = self.given
        inside = np.where(self.boundary, np.nan, 1.0)
        signed = np.where(g["H_dot_vecA"] < 0, g["h"], -g["h"])
        found = {
            "degree": g["degree"],
            "K": g["K"] * inside,
            "kappa_g": np.where(self.boundary, g["K"], np.nan),
            "K_comb": g["K_comb"],
            "K_plus": g["K_plus"],
            "K_minus": g["K_minus"],
            "K_abs": g["K_plus"] + g["K_minus"],
            "A": g["A"],
            "A_mixed": g["A_mixed"],
            "A_voronoi": g["A_voronoi"],
            "A_vec": g["vecA"],
            "H_vec": g["H"],
            "area_gradient": g["area_gradient"],
            "h": g["h"],
            "h_signed": signed,
            "h_hks": g["H_over_A"],
            "h_perp": -g["h_perp"],
            "h_normal": -g["h_normal"],
            "K_density": g["K_over_A"],
            "willmore": g["h"] ** 2 * g["A"],
            "willmore_hks": g["abs_H"] ** 2 / g["A"] * inside,
            "willmore_perp": g["h_perp"] ** 2 * g["A"],
            "willmore_normal": g["h_normal"] ** 2 * g["A"],
            "willmore_conformal": g["bobenko"] / 2,
            "K_positive": np.maximum(g["K"] * inside, 0),
            "K_negative": np.minimum(g["K"] * inside, 0),
            "K_rectified": np.abs(g["K"] * inside),
            "H_rectified": g["h"] * g["A"],
            "intrinsic_index": np.maximum(g["K"] * inside, 0) / (4 * math.pi),
        }
        larger, smaller = principal(g["h"], g["K_over_A"])
        found["folding_index"] = larger * (larger - np.abs(smaller)) * g["A"] / (4 * math.pi)
        found["kappa_1"], found["kappa_2"] = principal(signed, g["K_over_A"])
        found["curvedness"] = np.sqrt((found["kappa_1"] ** 2 + found["kappa_2"] ** 2) / 2)
        for column in ODD & found.keys():
            if not self.orientable:
                found[column] = np.full_like(found[column], np.nan)
        return found


def principal(H: Array, K: Array) -> tuple[Array, Array]:
    """κ₁ and κ₂ in many digits from H and K in double."""
    half = [mp.mpf(value) / 2 for value in H]
    root = [mp.sqrt(max(h * h - mp.mpf(k), 0)) if h == h else h for h, k in zip(half, K, strict=True)]
    pairs = list(zip(half, root, strict=True))
    return np.array([float(h + r) for h, r in pairs]), np.array([float(h - r) for h, r in pairs])


def edges(name: str) -> dict[str, Array]:
    """The edge columns by the product's names; `a` and `b` are the ends."""
    known = expected(name)
    given = known["edges"]
    theta = array(given["theta"] if known["topology"]["orientable"] else given["theta_abs"])
    sign = np.where(theta < 0, -1.0, 1.0)
    a, b = np.array(given["vertices"]).T
    found = {"a": a, "b": b, "theta": theta, "beta": array(given["beta"])}
    found |= {key: sign * array(given[key]) for key in ("H_sin", "H_theta", "H_tan")}
    return found | {"length": array(given["length"]), "H_vec": array(given["H"])}


def length_exponents() -> dict[str, int]:
    """Length exponents of totals."""
    return {
        "area": 2,
        "volume": 3,
        "A_vec": 2,
        "H_vec": 1,
        "H_theta": 1,
        "H_sin": 1,
        "H_tan": 1,
        "dirichlet": 2,
        **dict.fromkeys(("K", "kappa_g", "K_plus", "K_minus", "K_abs", "willmore", "willmore_hks"), 0),
        **dict.fromkeys(("willmore_perp", "willmore_normal", "willmore_conformal"), 0),
        **dict.fromkeys(("helfrich", "reduced_volume", "reduced_area_difference"), 0),
        **dict.fromkeys(("K_positive", "K_negative", "K_rectified", "folding_index", "intrinsic_index"), 0),
        "H_rectified": 1,
    }


def totals(name: str) -> dict[str, Any]:
    """The totals of the whole surface by the report's keys; None where undefined."""
    known = expected(name)
    g, orientable = known["global"], known["topology"]["orientable"]
    lengths = edges(name)
    found = {
        "area": g["area"],
        "volume": g["volume"],
        "K": g["sum_K_interior"],
        "kappa_g": g["sum_K_boundary"],
        "K_plus": g["sum_K_plus"],
        "K_minus": g["sum_K_minus"],
        "K_abs": g["total_absolute_curvature"],
        "A_vec": g.get("vector_area"),
        "H_vec": g["sum_He"],
        "willmore": g["willmore_h2A"],
        "willmore_hks": g["willmore_H2_over_A"],
        "willmore_perp": g["willmore_perp"],
        "willmore_normal": g["willmore_normal"],
        "willmore_conformal": g["bobenko_energy"],
        "dirichlet": g["area"],
    }
    sizes = ("H_theta", "H_sin", "H_tan")
    found |= {key: math.fsum(x for x in lengths[key] if x == x) if orientable else None for key in sizes}
    vertices = Vertices(name).columns()
    folding = ("K_positive", "K_negative", "K_rectified", "H_rectified", "folding_index", "intrinsic_index")
    found |= {key: math.fsum(x for x in vertices[key] if x == x) for key in folding}
    vesicle = known["topology"]["closed"] and orientable and known["topology"]["n_components"] == 1
    radius = math.sqrt(found["area"] / (4 * math.pi))
    return found | {
        "helfrich": found["willmore"] / 2,
        "reduced_volume": found["volume"] / (4 / 3 * math.pi * radius**3) if vesicle else None,
        "reduced_area_difference": found["H_theta"] / (8 * math.pi * radius) if vesicle else None,
    }
