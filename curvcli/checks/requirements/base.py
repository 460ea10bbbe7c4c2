"""Requirement: a named test that returns a fault."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ...mesh.surface import Surface
from ...support.words import format_number

Test = Callable[..., str]
Number = Literal["", "N", "TOL"]


@dataclass(frozen=True)
class Requirement:
    """One name of --require: its test returns the fault of a mesh, or nothing.

    number: the value after the equals sign, `N` (a whole number), `TOL` (not negative) or none.
    statement: the property, for lists. remedy: the repair of a mesh that fails. needs: the quantities that the test
    takes by the names of its parameters, and `mean`, the convention for H. default: required of every mesh unless
    --allow names it. after: the requirement that it follows in lists, "" for the first; None comes last.
    """

    name: str
    test: Test
    needs: tuple[str, ...]
    number: Number
    statement: str
    remedy: str
    default: bool = False
    after: str | None = None

    @property
    def usage(self) -> str:
        """The spelling in help, such as `genus=N`."""
        return f"{self.name}={self.number}" if self.number else self.name


@dataclass(frozen=True)
class Required:
    """A requirement with its number. value: the number, None without one."""

    requirement: Requirement
    value: float | None = None

    @property
    def name(self) -> str:
        """The spelling after --require, such as `genus=1`."""
        name = self.requirement.name
        return name if self.value is None else f"{name}={format_number(self.value)}"

    def problem(self, surface: Surface, given: Mapping[str, Any]) -> str:
        """The fault of a surface, with the first place; empty where the requirement is met.

        given: the quantities that the requirement needs, and `mean`.
        """
        number = () if self.value is None else (self.value,)
        needs = {name: given[name] for name in self.requirement.needs}
        return self.requirement.test(surface, *number, **needs)


# By name; `catalogue.requirements` gives the order of lists.
registered: dict[str, Requirement] = {}


def requirement(
    name: str, number: Number = "", *, remedy: str, default: bool = False, after: str | None = None
) -> Callable[[Test], Test]:
    """Register a requirement: a function of the surface, its number if it has one, and the quantities it names.

    The docstring of the function is the statement. The fields are those of `Requirement`.
    """

    def register(test: Test) -> Test:
        needs = tuple(inspect.signature(test).parameters)[2 if number else 1 :]
        statement = (test.__doc__ or "").strip().rstrip(".")
        registered[name] = Requirement(name, test, needs, number, statement, remedy, default, after)
        return test

    return register
