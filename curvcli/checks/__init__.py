"""Identities that must hold exactly, one file per idea."""

from . import (  # noqa: F401, I001  (the order of the report)
    gauss_bonnet,
    fenchel,
    holonomy,
    absolute,
    balance,
    variation,
    first_variation,
    dirichlet,
)
from .base import Check, CheckRule, rules

__all__ = ["Check", "CheckRule", "rules"]
