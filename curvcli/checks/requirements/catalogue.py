"""The catalogue of requirements: built-ins, those required by default, and the syntax of --require."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from ...errors import UsageError
from ...support.order import in_order
from ...support.words import suggestion
from .base import Required, Requirement, registered

# Modules of this folder that declare no requirement.
WITHOUT_REQUIREMENTS = ("base", "catalogue", "wording")


@cache
def _load_built_ins() -> None:
    for module in iter_modules(import_module(__package__).__path__):
        if module.name not in WITHOUT_REQUIREMENTS:
            import_module(f".{module.name}", __package__)


def requirements() -> dict[str, Requirement]:
    """All requirements by name, in the order of lists."""
    _load_built_ins()
    return dict(in_order(registered.items(), lambda entry: entry[0], lambda entry: entry[1].after))


def defaults() -> list[str]:
    """The names of those that every mesh must meet unless allowed to fail."""
    return [name for name, requirement in requirements().items() if requirement.default]


def parse(texts: Iterable[str]) -> list[Required]:
    """Requirements from comma lists such as `closed,genus=1`, each once, in the order given.

    Errors: UsageError for an unknown name (with the nearest), a missing, superfluous or impossible number.
    """
    return list(dict.fromkeys(_parse_entry(part.strip()) for text in texts for part in text.split(",")))


def _parse_entry(text: str) -> Required:
    name, equals, text_of_value = (part.strip() for part in text.partition("="))
    known = requirements()
    requirement = known.get(name)
    if requirement is None:
        raise UsageError(f"unknown requirement {name!r}{suggestion(name, known, '`curvcli help checks` lists them')}")
    if not requirement.number:
        if equals:
            raise UsageError(f"requirement {text}: {name} takes no number")
        return Required(requirement)
    wanted = "a whole number" if requirement.number == "N" else "a tolerance of 0 or more"
    try:
        value = int(text_of_value) if requirement.number == "N" else float(text_of_value)
    except ValueError:
        raise UsageError(f"requirement {text}: expected {requirement.usage} with {wanted}") from None
    if requirement.number == "TOL" and not 0 <= value < math.inf:
        raise UsageError(f"requirement {text}: expected {requirement.usage} with {wanted}")
    return Required(requirement, value)
