"""Requirements of `--require`: properties that identities do not prove, one function each."""

from . import shape, soundness, topology  # noqa: F401  (importing registers)
from .base import DEFAULT, Kind, Requirement, kinds, parse

__all__ = ["DEFAULT", "Kind", "Requirement", "kinds", "parse"]
