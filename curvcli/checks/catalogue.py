"""The catalogue of identities: built-ins, those of plug-ins, and the order of the report."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from ..errors import UsageError
from ..support.order import topological_order
from ..support.words import suggestion
from .base import CheckRule, registered

# Modules of this folder that declare no identity.
WITHOUT_IDENTITIES = ("base", "catalogue", "special", "summary")

_OWN = f"{__package__}."


@cache
def _load_built_ins() -> None:
    for module in iter_modules(import_module(__package__).__path__):
        if not module.ispkg and module.name not in WITHOUT_IDENTITIES:
            import_module(f".{module.name}", __package__)


def identities() -> dict[str, CheckRule]:
    """The identities by name: built-ins in the order of the report, then those of plug-ins that are loaded."""
    _load_built_ins()
    built_ins_first = sorted(registered.items(), key=lambda entry: not entry[1].function.__module__.startswith(_OWN))
    return dict(topological_order(built_ins_first, lambda entry: entry[0], lambda entry: entry[1].after))


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
