"""Exact identities, one file per idea."""

from . import gauss_bonnet, fenchel, holonomy, absolute, balance, variation, first_variation, dirichlet  # noqa: F401, I001  (the order of the report)
from .base import Check, CheckRule, rules

__all__ = ["Check", "CheckRule", "rules"]
