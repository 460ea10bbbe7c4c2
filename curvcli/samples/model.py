"""Sample: a mesh, its exact values, and those of the smooth surface that it approximates."""

from __future__ import annotations

import dataclasses
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import UsageError
from ..support.words import suggestion

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]
ExactColumns = dict[str, FloatArray]
Fact = int | float | bool | None

LENGTH_EXPONENT = {
    "K_density": -2,
    "h": -1,
    "h_signed": -1,
    "kappa_1": -1,
    "kappa_2": -1,
    "area": 2,
    "volume": 3,
    "H_theta": 1,
}
"""Length exponents of columns and totals; absent names have exponent 0."""

_WORDS = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}


@dataclass(frozen=True)
class Sample:
    """A test surface.

    points: (V, 3) float64. faces: (F, 3) int32, counterclockwise seen from outside (graphs: from above).
    exact: (V,) columns with the names and signs of the vertex table, NaN where the surface has none. Curvatures
    are those of the smooth surface through the points; `K`, where present, is the angle defect of the mesh itself.
    facts: exact values of this mesh: topology under the keys of the report, and totals.
    limit: totals of the smooth surface, to which those of ever finer meshes tend (a Schwarz lantern's do not).
    name, description: the requested sample, and its exact values in one sentence.
    """

    points: FloatArray
    faces: IntArray
    exact: ExactColumns = field(default_factory=dict)
    facts: dict[str, Fact] = field(default_factory=dict)
    limit: dict[str, float] = field(default_factory=dict)
    name: str = ""
    description: str = ""

    def scaled(self, factor: float) -> Sample:
        """The sample scaled by `factor`, exact values included."""
        demand(math.isfinite(factor) and factor > 0, f"the scale must be a positive number, not {factor!r}")

        def grown(name: str, value: Any) -> Any:
            exponent = LENGTH_EXPONENT.get(name, 0)
            return value * factor**exponent if exponent else value

        return dataclasses.replace(
            self,
            points=self.points * factor,
            exact={name: grown(name, column) for name, column in self.exact.items()},
            facts={name: grown(name, fact) for name, fact in self.facts.items()},
            limit={name: grown(name, total) for name, total in self.limit.items()},
        )


@dataclass(frozen=True)
class Parameter:
    """One keyword of a sample: its name, type (int, float or bool) and default."""

    name: str
    kind: type
    default: int | float | bool


@dataclass(frozen=True)
class SampleSpec:
    """A surface of the catalogue; calling it with its parameters makes the sample."""

    name: str
    summary: str
    exact: str
    function: Callable[..., Sample]

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Its parameters, in the order of its definition."""
        signature = inspect.signature(self.function, eval_str=True)
        return tuple(Parameter(p.name, p.annotation, p.default) for p in signature.parameters.values())

    def parse(self, settings: Mapping[str, str]) -> dict[str, int | float | bool]:
        """Parse keywords from text such as {"size": "2000"}. Errors: UsageError for an unknown name or a wrong type."""
        kinds = {parameter.name: parameter.kind for parameter in self.parameters}
        values: dict[str, int | float | bool] = {}
        for name, text in settings.items():
            key = name.strip().replace("-", "_")
            self._demand_known(key, name)
            values[key] = _value(key, text.strip(), kinds[key])
        return values

    def _demand_known(self, key: str, typed: str) -> None:
        known = [parameter.name for parameter in self.parameters]
        way_out = suggestion(typed, known) if known else "; it has none"
        demand(key in known, f"sample {self.name} has no parameter {typed!r}{way_out}")

    def __call__(self, **values: int | float | bool) -> Sample:
        """Make the surface. Errors: UsageError for an unknown parameter or an impossible value."""
        for name, value in values.items():
            self._demand_known(name, name)
            demand(math.isfinite(value), f"{name} must be finite, not {value!r}")
        made = self.function(**values)
        # Writers and readers of raw memory need contiguous rows.
        points, faces = np.ascontiguousarray(made.points), np.ascontiguousarray(made.faces)
        return dataclasses.replace(made, points=points, faces=faces, name=self.name, description=self.exact)


def demand(condition: bool, otherwise: str) -> None:
    """Raise UsageError with the message `otherwise` unless the condition holds."""
    if not condition:
        raise UsageError(otherwise)


def demand_positive(**values: float) -> None:
    """Raise UsageError unless every value is above zero."""
    for name, value in values.items():
        demand(value > 0, f"{name} must be positive, not {value!r}")


def _value(name: str, text: str, kind: type) -> int | float | bool:
    try:
        if kind is bool:
            return _WORDS[text.lower()]
        return int(text) if kind is int else float(text)
    except (KeyError, ValueError):
        wanted = {bool: "true or false", int: "a whole number", float: "a number"}[kind]
        raise UsageError(f"{name} must be {wanted}, not {text!r}") from None
