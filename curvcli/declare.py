"""Public declarations for plug-ins: quantities, passes and the types of their arrays."""

from __future__ import annotations

from .curvatures.quantity import Quantity
from .curvatures.registry import Pass, curvature_pass
from .support.arrays import Codes, Column, Counts, Flags, VectorColumn

__all__ = ["Codes", "Column", "Counts", "Flags", "Pass", "Quantity", "VectorColumn", "curvature_pass"]
