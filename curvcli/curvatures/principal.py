"""Principal curvatures from the mean and the Gauss curvature."""

from __future__ import annotations

import numpy as np

from ..declare import Column, Flags, Quantity, curvature_pass

_SHARED = {
    "kind": "density",
    "length_exponent": -1,
    "parity": "odd",
    "signed": True,
    "preserves": "κ₁ + κ₂ = h_signed, and κ₁ κ₂ = K_density where the radicand is not clamped",
    "boundary": "null",
    "source": "Sullivan, Curvatures of smooth surfaces",
}


@curvature_pass(
    provides=(
        Quantity("kappa_1", symbol="κ₁", formula="H/2 + √(H²/4 − K_density), H = h_signed", **_SHARED),  # type: ignore[arg-type]
        Quantity("kappa_2", symbol="κ₂", formula="H/2 − √(H²/4 − K_density), H = h_signed", **_SHARED),  # type: ignore[arg-type]
        Quantity("kappa_clamped", kind="flag", public=False),
    )
)
def principal_curvatures(h_signed: Column, K_density: Column) -> tuple[Column | Flags, ...]:
    """Principal curvatures, κ₁ ≥ κ₂; a negative radicand, where H² < 4K, is clamped at 0 and counted."""
    half = 0.5 * h_signed
    radicand = half * half - K_density
    clamped = radicand < 0
    root = np.sqrt(np.maximum(radicand, 0.0))
    return half + root, half - root, clamped
