"""Public declarations for plug-ins: quantities, passes and the types of their arrays."""

from __future__ import annotations

__all__ = [
    *("Codes", "Column", "Counts", "DerivedTotal", "Flags", "Pass", "Quantity", "Setting", "VectorColumn"),
    *("curvature_pass", "derived_total"),
]
