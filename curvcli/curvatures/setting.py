"""Setting: the declaration of a parameter of a pass that has a default, and the conversion of its values."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from numbers import Integral, Real
from typing import Any, Literal

from ..errors import UsageError

Scalar = bool | int | float | str
SettingKind = Literal["float", "int", "bool", "str"]

_EXPECTED = {
    "float": "a finite number",
    "int": "a whole number",
    "bool": "true or false",
    "str": "a text",
}
_TRUTH = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}
# Words in the annotation of a parameter that may differ from face to face.
_ARRAYS = {"Column", "NDArray", "ndarray"}


@dataclass(frozen=True)
class Setting:
    """A parameter of a pass with a default, set by `--set PASS.NAME=VALUE`.

    description: for people. length_exponent: how it scales with length, so that the pass gets it in the unit of
    computation. parity: the sign it takes when all faces are reversed. minimum: its least value, None for none.
    owner: the pass of the same parameter, whose values count here too, "" for none; `--set OWNER.NAME` sets both.
    name, kind, default, by_region come from the signature of the function; by_region: the annotation has `Column`, so
    that every region may have a value of its own, and the pass then gets one for each face.
    """

    description: str = ""
    length_exponent: int = 0
    parity: Literal["even", "odd"] = "even"
    minimum: float | None = None
    owner: str = ""
    name: str = ""
    kind: SettingKind = "float"
    default: Scalar = 0.0
    by_region: bool = False

    def key(self, step: str) -> str:
        """Its name behind `--set`, as a parameter of the pass of this name."""
        return f"{self.owner or step}.{self.name}"

    @property
    def expected(self) -> str:
        """Its type in words."""
        return _EXPECTED[self.kind] + ("" if self.minimum is None else f" of at least {self.minimum:g}")

    def convert(self, value: Any, place: str) -> Scalar:
        """A value, or the text of one, as its type.

        Errors: UsageError with the place for another type, a number that is not finite or is too small.
        """
        result = _converted(value, self.kind)
        if result is None or (isinstance(result, int | float) and self.minimum is not None and result < self.minimum):
            raise UsageError(f"{place} is {value!r}, expected {self.expected}")
        return result


def _converted(value: Any, kind: SettingKind) -> Scalar | None:
    """A value as its type; None where it is none."""
    try:
        match kind:
            case "str":
                return value if isinstance(value, str) else None
            case "bool":
                return _TRUTH.get(value.strip().lower()) if isinstance(value, str) else _flag(value)
            case "int":
                whole = isinstance(value, str) or (isinstance(value, Integral) and not isinstance(value, bool))
                return int(value) if whole else None
            case _:
                known = isinstance(value, str) or (isinstance(value, Real) and not isinstance(value, bool))
                number = float(value) if known else math.nan
                return number if math.isfinite(number) else None
    except (ValueError, OverflowError):
        return None


def _flag(value: Any) -> bool | None:
    return bool(value) if isinstance(value, bool) or type(value).__name__ in ("bool_", "bool") else None


def split_signature(
    function: Callable[..., Any], described: Mapping[str, Setting]
) -> tuple[tuple[str, ...], tuple[Setting, ...]]:
    """The names of a function's needs, and its settings: the parameters that have a default.

    described: descriptions and limits of the settings, by name.
    Errors: UsageError for a default of another type, or a description of no parameter.
    """
    name = function.__name__
    parameters = inspect.signature(function).parameters.values()
    needs = tuple(each.name for each in parameters if each.default is inspect.Parameter.empty)
    settings = tuple(
        _setting(name, each, described.get(each.name, Setting()))
        for each in parameters
        if each.default is not inspect.Parameter.empty
    )
    for key in described:
        if key not in {setting.name for setting in settings}:
            raise UsageError(f"pass {name} describes a parameter {key}, and its function has none with a default")
    return needs, settings


def _setting(function: str, parameter: inspect.Parameter, described: Setting) -> Setting:
    place = f"pass {function}: the default of {parameter.name}"
    given = parameter.annotation
    empty = given is inspect.Parameter.empty
    type_names = set(
        re.findall(r"\w+", given if isinstance(given, str) else getattr(given, "__name__", "") or str(given))
    )
    type_names |= set() if isinstance(given, str) else set(re.findall(r"\w+", str(given)))
    kinds = [kind for kind in _EXPECTED if kind in ({type(parameter.default).__name__} if empty else type_names)]
    if len(kinds) != 1:
        raise UsageError(f"{place} is {parameter.default!r}, expected a type among {', '.join(_EXPECTED)}")
    by_region = not empty and not type_names.isdisjoint(_ARRAYS)
    setting = replace(described, name=parameter.name, kind=kinds[0], by_region=by_region)  # type: ignore[arg-type]
    return replace(setting, default=setting.convert(parameter.default, place))
