"""The catalogue of identities: built-ins, those of plug-ins, and the order of the report."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib import import_module

from ..errors import UsageError
from ..support.words import suggestion
from .base import CheckRule, registered

# The files of built-in identities, in the order of the report.
BUILT_IN = (
    "gauss_bonnet",
    "fenchel",
    "holonomy",
    "total_absolute_curvature",
    "balance",
    "variation",
    "first_variation",
    "dirichlet",
    "partition",
)


@cache
def _load_built_ins() -> tuple[str, ...]:
    """The names of the built-in identities, after their files are imported."""
    modules = [f"{__package__}.{name}" for name in BUILT_IN]
    for module in modules:
        import_module(module)
    own = [rule for rule in registered.values() if rule.function.__module__ in modules]
    return tuple(rule.name for rule in sorted(own, key=lambda rule: modules.index(rule.function.__module__)))


def identities() -> dict[str, CheckRule]:
    """The identities by name: built-ins in the order of the report, then those of plug-ins that are loaded."""
    return {name: registered[name] for name in dict.fromkeys([*_load_built_ins(), *registered])}


def named_checks(names: str | Iterable[str]) -> list[str]:
    """The names of identities, also in comma lists, in the order of the report.

    Errors: UsageError for one that is not known, with the nearest.
    """
    entries = [names] if isinstance(names, str) else names
    wanted = {name.strip() for entry in entries for name in entry.split(",")}
    known = identities()
    for name in sorted(wanted - known.keys()):
        raise UsageError(f"unknown check {name!r}{suggestion(name, known, '`curvcli help checks` lists them')}")
    return [name for name in known if name in wanted]
