"""Closed surfaces in space: which lies inside which, and which cross."""

from .nesting import Nesting, nest

__all__ = ["Nesting", "nest"]
