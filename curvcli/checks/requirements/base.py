"""Requirement: a named test that returns a fault, and its spelling for --require."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ...errors import UsageError
from ...mesh.surface import Surface
from ...support.words import format_number, suggestion

Test = Callable[..., str]
Number = Literal["", "N", "TOL"]

# Required of every mesh unless explicitly allowed.
DEFAULT = ("manifold", "consistent-winding", "no-degenerate", "no-duplicate-faces")


@dataclass(frozen=True)
class Kind:
    """One name of --require with its test, which returns the fault or an empty text.

    number: the value behind the equals sign: `N` (a whole number), `TOL` (not negative) or empty.
    remedy: the advice for a mesh that fails. needs: names of the test's parameters, quantities and `mean`, the
    convention for H.
    """

    name: str
    test: Test
    needs: tuple[str, ...]
    number: Number
    statement: str
    remedy: str

    @property
    def usage(self) -> str:
        """The spelling in help, such as `genus=N`."""
        return f"{self.name}={self.number}" if self.number else self.name


@dataclass(frozen=True)
class Requirement:
    """A kind with its number."""

    kind: Kind
    value: float | None = None

    @property
    def name(self) -> str:
        """The spelling after --require, such as `genus=1`."""
        return self.kind.name if self.value is None else f"{self.kind.name}={format_number(self.value)}"

    def problem(self, surface: Surface, given: Mapping[str, Any]) -> str:
        """The fault of a surface, with the first place; empty where the requirement is met.

        given: the quantities that the kind needs, and `mean`.
        """
        number = () if self.value is None else (self.value,)
        return self.kind.test(surface, *number, **{name: given[name] for name in self.kind.needs})


kinds: dict[str, Kind] = {}


def requirement(name: str, number: Number = "", *, remedy: str) -> Callable[[Test], Test]:
    """Register a requirement: a function of the surface, its number if it has one, and the quantities it names.

    The docstring of the function is the promise.
    """

    def register(test: Test) -> Test:
        needs = tuple(inspect.signature(test).parameters)[2 if number else 1 :]
        kinds[name] = Kind(name, test, needs, number, (test.__doc__ or "").strip().rstrip("."), remedy)
        return test

    return register


def parse(texts: Iterable[str]) -> list[Requirement]:
    """Parse comma lists such as `closed,genus=1`; each requirement once, in the order given.

    Errors: UsageError for an unknown name (with similar ones), a missing, superfluous or impossible number.
    """
    found: dict[Requirement, None] = {}
    for text in texts:
        for part in text.split(","):
            found[_parse_one(part.strip())] = None
    return list(found)


def _parse_one(text: str) -> Requirement:
    name, equals, text_of_value = (part.strip() for part in text.partition("="))
    kind = kinds.get(name)
    if kind is None:
        raise UsageError(f"unknown requirement {name!r}{suggestion(name, kinds, '`curvcli help checks` lists them')}")
    if not kind.number:
        if equals:
            raise UsageError(f"requirement {text}: {name} takes no number")
        return Requirement(kind)
    wanted = "a whole number" if kind.number == "N" else "a tolerance of 0 or more"
    try:
        value = int(text_of_value) if kind.number == "N" else float(text_of_value)
    except ValueError:
        raise UsageError(f"requirement {text}: expected {kind.usage} with {wanted}") from None
    if kind.number == "TOL" and not 0 <= value < math.inf:
        raise UsageError(f"requirement {text}: expected {kind.usage} with {wanted}")
    return Requirement(kind, value)
