"""Errors of computed columns against the exact values of a smooth surface, in the usual norms."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...curvatures.catalogue import load_passes
from ...curvatures.registry import passes
from ...support.arrays import Floats

# Exact columns by the stem of the computed ones; columns that are odd in the normal have a sign.
_STEMS = ("kappa_1", "kappa_2", "K", "h")


@dataclass(frozen=True)
class ErrorNorms:
    """Errors of one column against the exact one it was matched with.

    relative_l2: ‖x − exact‖ / ‖exact‖, weighted by the areas of the vertices; None where the exact values are all 0.
    linf: the largest error, and its vertex. rms: √(Σ A (x − exact)² / Σ A). bias: Σ A (x − exact) / Σ A, and
    relative_bias over Σ A |exact| instead. nulls: vertices that have an exact value but no computed one. compared:
    those that have both; if there are none, everything but the counts is None.
    """

    column: str
    exact: str
    relative_l2: float | None
    linf: float | None
    vertex: int | None
    rms: float | None
    bias: float | None
    relative_bias: float | None
    nulls: int
    compared: int


def match(columns: Mapping[str, Any], exact: Mapping[str, Any]) -> dict[str, str]:
    """Exact column that each computed one estimates: of the same name, else by quantity.

    Densities of Gauss curvature (`K_density`, `K_corrected`, `K_fit`, …) are compared with K_density; mean curvatures
    (`h_*`) with h_signed if they have a sign, else h; `kappa_1_*`, `kappa_2_*` with kappa_1, kappa_2. A column without
    partner is left out.
    """
    load_passes()
    known = {column: q for q in passes.quantities("vertex") for column in q.columns}
    matched = {}
    for name in columns:
        quantity = next((known[c] for c in sorted(known, key=len, reverse=True) if _at_scale(name, c)), None)
        if name in exact:
            matched[name] = name
        elif quantity is not None and quantity.kind == "density":
            stem = next((stem for stem in _STEMS if name.startswith(f"{stem}_") or name == stem), "")
            wanted = {"K": "K_density" if quantity.length_exponent == -2 else "", "h": _mean(quantity.parity)}
            partner = wanted.get(stem, stem)
            # The rest of a name after its stem is the method of the estimate; an uncertainty estimates nothing.
            if partner in exact and not name.endswith("_sigma"):
                matched[name] = partner
    return matched


def _at_scale(name: str, column: str) -> bool:
    return name == column or name.startswith(f"{column}_")


def _mean(parity: str) -> str:
    return "h_signed" if parity == "odd" else "h"


def error_norms(column: str, exact: str, values: Floats, exact_values: Floats, area: Floats) -> ErrorNorms:
    """Error norms of a column (V,) against exact values (V,), NaN is null; area: (V,) weights."""
    known = np.isfinite(exact_values)
    both = known & np.isfinite(values) & (area > 0)
    weight, reference = area[both], exact_values[both]
    gap = values[both] - reference
    total = float(weight.sum())
    if not total:
        return ErrorNorms(column, exact, None, None, None, None, None, None, int((known & ~both).sum()), 0)
    square, size = float(weight @ gap**2), float(weight @ reference**2)
    worst = int(np.argmax(np.abs(gap)))
    bias, absolute = float(weight @ gap), float(weight @ np.abs(reference))
    return ErrorNorms(
        column,
        exact,
        _known(math.sqrt(square / size)) if size else None,
        float(abs(gap[worst])),
        int(np.flatnonzero(both)[worst]),
        _known(math.sqrt(square / total)),
        _known(bias / total),
        _known(bias / absolute) if absolute else None,
        int(np.count_nonzero(known & ~both)),
        int(np.count_nonzero(both)),
    )


def _known(value: float) -> float | None:
    """The value; None if a sum overflowed."""
    return None if math.isnan(value) else value
