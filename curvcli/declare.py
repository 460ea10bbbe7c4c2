"""Public declarations for plug-ins: quantities, passes and the types of their arrays."""

from __future__ import annotations

from .curvatures.derived import DerivedTotal, derived_total
from .curvatures.quantity import FlagNotice, Quantity
from .curvatures.registry import Pass, curvature_pass
from .curvatures.setting import Setting
from .support.arrays import Codes, Column, Counts, Flags, VectorColumn

__all__ = [
    "Codes",
    "Column",
    "Counts",
    "DerivedTotal",
    "FlagNotice",
    "Flags",
    "Pass",
    "Quantity",
    "Setting",
    "VectorColumn",
    "curvature_pass",
    "derived_total",
]
