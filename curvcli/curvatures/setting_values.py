"""Values of the parameters of passes, from texts such as `helfrich.c0=0.5` or from mappings."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping
from typing import Any

from ..errors import UsageError
from ..support.words import format_number, suggestion
from .catalogue import load_passes
from .derived import derived
from .quantity import Configurable
from .registry import Pass, passes
from .setting import Scalar, Setting

# A value, or one for each region by its name; the empty name stands for all other faces.
SettingValue = Scalar | dict[str, Scalar]
GivenSettings = str | Iterable[str] | Mapping[str, Any] | None
OTHERS = ""
_C0 = "helfrich.c0"


def parse_settings(given: GivenSettings) -> dict[str, SettingValue]:
    """Parse `PASS.NAME=VALUE` and `PASS.NAME=REGION=VALUE`, or a mapping from `PASS.NAME` to a value or, for each
    region, to values; the parameters of a pass may also stand in a mapping of their own.

    Errors: UsageError for an unknown pass or parameter, with the nearest; for a value of another type, one that is not
    finite, or one that is set twice.
    """
    result: dict[str, SettingValue] = {}
    for name, value in _entries(given):
        key, setting = find_setting(name)
        if isinstance(value, Mapping) and not setting.by_region:
            raise UsageError(f"{key} has values by region, expected {setting.expected}: the pass takes one value")
        each = value if isinstance(value, Mapping) else {OTHERS: value}
        for region, part in each.items():
            _add(result, key, setting, str(region), part)
    return {
        name: dict(sorted(value.items())) if isinstance(value, dict) else value
        for name, value in sorted(result.items())
    }


def with_spontaneous_curvature(given: GivenSettings, curvature: Any) -> GivenSettings:
    """Settings with a spontaneous curvature: a number, texts `C0` and `REGION=C0`, or a mapping from regions; None or
    nothing adds none.

    Errors: UsageError for one that both set, and those of `parse_settings`.
    """
    if curvature is None or curvature == ():
        return given
    texts = curvature if isinstance(curvature, tuple | list) else None
    more = parse_settings({_C0: curvature} if texts is None else [f"{_C0}={text}" for text in texts])
    known = parse_settings(given)
    if _C0 in known:
        raise UsageError(f"{_C0} is set twice: it is the spontaneous curvature")
    return known | more


def _add(result: dict[str, SettingValue], key: str, setting: Setting, region: str, value: Any) -> None:
    """Add one value; a parameter without values by region keeps a plain one."""
    if setting.by_region and isinstance(value, str) and "=" in value[1:]:
        region, _, value = value.rpartition("=")
    place = f"{key} of region {region!r}" if region else key
    known = result.get(key, {})
    by_region = known if isinstance(known, dict) else {OTHERS: known}
    if region in by_region:
        raise UsageError(f"{place} is set twice")
    by_region = {**by_region, region: setting.convert(value, place)}
    result[key] = by_region[OTHERS] if list(by_region) == [OTHERS] else by_region


def _entries(given: GivenSettings) -> Iterable[tuple[str, Any]]:
    """Names with their values."""
    if given is None:
        return
    if isinstance(given, Mapping):
        for name, value in given.items():
            if "." not in str(name) and isinstance(value, Mapping):
                yield from ((f"{name}.{key}", part) for key, part in value.items())
            else:
                yield str(name), value
        return
    texts = [given] if isinstance(given, str) else list(given) if isinstance(given, Iterable) else [given]
    for text in texts:
        if not isinstance(text, str):
            raise UsageError(f"settings {given!r}: expected a mapping from PASS.NAME to a value, or texts")
        name, equals, value = text.partition("=")
        if not equals:
            raise UsageError(f"--set {text}: expected PASS.NAME=VALUE, such as helfrich.c0=0.5")
        yield name, value


def find_setting(name: str) -> tuple[str, Setting]:
    """The full name of a parameter, `PASS.NAME`, and its declaration.

    Errors: UsageError for an unknown pass or parameter, with the nearest.
    """
    load_passes()
    owner, dot, key = name.strip().partition(".")
    owners: list[Configurable] = [*passes.values(), *derived.values()]
    having = {setting.key(each.name): setting for each in owners for setting in each.settings}
    known = derived.get(owner) or _pass_of(owner)
    if known is None:
        way_out = suggestion(owner, [full.partition(".")[0] for full in having], "`curvcli passes` lists the passes")
        raise UsageError(f"--set {name}: unknown pass {owner!r}{way_out}")
    if not known.settings:
        raise UsageError(f"--set {name}: the pass {owner} has no parameters; those of others: {', '.join(having)}")
    names = {setting.name: setting for setting in known.settings}
    if key not in names:
        problem = f"no parameter {key!r}{suggestion(key, names)}" if dot else f"give one of {', '.join(names)}"
        raise UsageError(f"--set {name}: the pass {owner} has {problem}" if dot else f"--set {name}: {problem}")
    full = names[key].key(known.name)
    return full, having[full]


def _pass_of(name: str) -> Pass | None:
    """The pass of a name, or the pass that provides a quantity of this name."""
    if name in passes:
        return passes[name]
    return next((each for each in passes.values() if name in [quantity.name for quantity in each.provides]), None)


def implied(values: Mapping[str, SettingValue], rigidity: str | None = None) -> list[str]:
    """Public quantities of the passes that have a value, and the energies where a bending rigidity is given."""
    load_passes()
    owners = [passes[owner] for owner in dict.fromkeys(name.partition(".")[0] for name in values) if owner in passes]
    names = [quantity.name for owner in owners for quantity in owner.provides if quantity.public]
    energies = [quantity.name for quantity in passes.quantities() if quantity.energy and rigidity is not None]
    energies = [name for name in energies if not passes.depends_on_scale(name)]
    return list(dict.fromkeys([*names, *energies]))


def regions_of(values: Mapping[str, SettingValue]) -> list[tuple[str, str]]:
    """Parameters that have a value for a region, with the name of the region."""
    each = ((name, value) for name, value in values.items() if isinstance(value, dict))
    return [(name, region) for name, value in each for region in value if region != OTHERS]


def describe_settings(values: Mapping[str, SettingValue]) -> str:
    """The values as words of a shell that `parse_described` and, behind `--set`, the command line read back."""
    return shlex.join(
        f"{name}={region}={format_scalar(part)}" if region else f"{name}={format_scalar(part)}"
        for name, value in sorted(values.items())
        for region, part in (value if isinstance(value, dict) else {OTHERS: value}).items()
    )


def parse_described(text: str) -> dict[str, SettingValue]:
    """The values of a text by `describe_settings` that are not the defaults."""
    values = parse_settings(shlex.split(text))
    return {name: value for name, value in values.items() if value != find_setting(name)[1].default}


def format_scalar(value: Scalar) -> str:
    """Shortest text that reads back to the same value."""
    if isinstance(value, str):
        return value
    return str(value).lower() if isinstance(value, bool) else format_number(value)
