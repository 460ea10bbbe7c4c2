"""The catalogue of requirements: built-ins, named sets, those required by default, and the syntax of --require."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from ...errors import UsageError
from ...support.order import topological_order
from ...support.words import suggestion
from .base import Required, Requirement, registered

# Modules of this folder that declare no requirement.
WITHOUT_REQUIREMENTS = ("base", "catalogue", "wording")

# Sets of requirements by name; each may name sets that stand before it.
SETS: Mapping[str, tuple[str, ...]] = {
    "watertight": ("closed", "oriented", "outward", "no-self-intersections", "no-duplicate-faces"),
    "printable": ("watertight", "manifold", "consistent-winding", "no-degenerate"),
    "simulation": ("printable", "no-duplicate-vertices", "no-unreferenced", "no-self-contacts"),
}


@cache
def _load_built_ins() -> None:
    for module in iter_modules(import_module(__package__).__path__):
        if module.name not in WITHOUT_REQUIREMENTS:
            import_module(f".{module.name}", __package__)


def requirements() -> dict[str, Requirement]:
    """All requirements by name, in the order of lists."""
    _load_built_ins()
    return dict(topological_order(registered.items(), lambda entry: entry[0], lambda entry: entry[1].after))


def defaults() -> list[str]:
    """The names of those that every mesh must meet unless allowed to fail."""
    return [name for name, requirement in requirements().items() if requirement.default]


def parse(texts: Iterable[str], sets: Mapping[str, tuple[str, ...]] = SETS) -> list[Required]:
    """Requirements from comma lists such as `closed,genus=1`, each once, in the order given; a set is its members.

    Errors: UsageError for an unknown name (with the nearest), a missing, superfluous or impossible number.
    """
    return list(dict.fromkeys(entry for text in _names(texts) for entry in _parse_entry(text, sets)))


def parse_sets(texts: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """The built-in sets, and those of texts `NAME=REQUIREMENT,…`; a set may name those before it.

    Errors: UsageError for a text of another form, a name that a requirement has, or an unknown member.
    """
    sets = dict(SETS)
    for text in texts:
        name, equals, members = (part.strip() for part in text.partition("="))
        if not (name and equals and members):
            raise UsageError(f"set of requirements {text!r}: expected NAME=REQUIREMENT[,REQUIREMENT]")
        if name in requirements():
            raise UsageError(f"set of requirements {name}: a requirement has this name; choose another")
        # Members by name, not by set: a set may extend the one whose name it takes.
        sets[name] = tuple(required.name for required in parse([members], sets))
    return sets


def _names(texts: Iterable[str]) -> list[str]:
    """The names of comma lists."""
    return [part.strip() for text in texts for part in text.split(",")]


def _parse_entry(text: str, sets: Mapping[str, tuple[str, ...]]) -> list[Required]:
    """A requirement, or the members of a set."""
    if text in sets:
        return parse(sets[text], sets)
    name, equals, text_of_value = (part.strip() for part in text.partition("="))
    known = requirements()
    requirement = known.get(name)
    if requirement is None:
        way_out = suggestion(name, [*known, *sets], "`curvcli help checks` lists them")
        raise UsageError(f"unknown requirement {name!r}{way_out}")
    if not requirement.number:
        if equals:
            raise UsageError(f"requirement {text}: {name} takes no number")
        return [Required(requirement)]
    wanted = "a whole number" if requirement.number == "N" else "a tolerance of 0 or more"
    try:
        value = int(text_of_value) if requirement.number == "N" else float(text_of_value)
    except ValueError:
        raise UsageError(f"requirement {text}: expected {requirement.usage} with {wanted}") from None
    if requirement.number == "TOL" and not 0 <= value < math.inf:
        raise UsageError(f"requirement {text}: expected {requirement.usage} with {wanted}")
    return [Required(requirement, value)]
