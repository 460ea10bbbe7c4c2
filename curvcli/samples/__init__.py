"""Test surfaces from formulas, with their exact values; importing this package imports no numpy."""

from .catalogue import get, names, specs

__all__ = ["get", "names", "specs"]
