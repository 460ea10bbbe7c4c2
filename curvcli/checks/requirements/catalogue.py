"""The catalogue of requirements: built-ins, those required by default, and the syntax of --require."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache
from importlib import import_module

from ...errors import UsageError
from ...support.words import suggestion
from .base import Required, Requirement, registered

# The files of built-in requirements, in the order of lists.
BUILT_IN = ("topology", "shape", "soundness")


@cache
def _load_built_ins() -> None:
    for name in BUILT_IN:
        import_module(f".{name}", __package__)


def requirements() -> dict[str, Requirement]:
    """All requirements by name."""
    _load_built_ins()
    return registered


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
