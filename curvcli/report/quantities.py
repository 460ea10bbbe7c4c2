"""Facts of the quantities, as data and as the page of the documentation."""

from __future__ import annotations

from typing import Any, TypedDict

from ..curvatures.catalogue import load_passes, resolve
from ..curvatures.derived import DerivedTotal, derived
from ..curvatures.quantity import CELL_AREA, NO_QUANTITIES, Configurable, Quantity
from ..curvatures.registry import passes
from ..curvatures.setting_values import format_scalar
from ..errors import UsageError
from ..support.words import suggestion

_BOLD = str.maketrans("", "", "*")


class ParameterFacts(TypedDict):
    """Parameter of a pass: the name behind `--set`, its type, default, unit and meaning."""

    name: str
    type: str
    default: bool | int | float | str
    unit: str
    parity: str
    by_region: bool
    description: str


class Facts(TypedDict):
    """Declaration of a quantity, under the names used everywhere."""

    name: str
    symbol: str
    on: str
    kind: str
    columns: list[str]
    description: str
    formula: str
    unit: str
    length_exponent: int
    mean_degree: int
    parity: str
    boundary: str
    preserves: str
    total: str | None
    source: str
    needs: list[str]
    preset: str
    parameters: list[ParameterFacts]


def public() -> list[Quantity]:
    """All public quantities in the order of the tables, vertices first."""
    load_passes()
    return passes.quantities()


def find(name: str) -> Quantity:
    """Find a quantity by its name or by the name of one of its columns; vertices come before edges.

    Errors: UsageError with the nearest names.
    """
    known = {column: quantity for quantity in reversed(public()) for column in (quantity.name, *quantity.columns)}
    if name not in known:
        way_out = suggestion(name, [*known, *derived], "`curvcli passes` lists them")
        raise UsageError(f"unknown quantity {name!r}{way_out}")
    return known[name]


def asked_by(total: DerivedTotal) -> str:
    """Options that compute a derived total."""
    owner = derived[total.name]
    while not owner.beside and not owner.settings:
        owner = derived[owner.needs[0]]
    return f"-p {owner.beside}" if owner.beside else f"--set {owner.name}.{owner.settings[0].name}=VALUE"


def unmarked(text: str) -> str:
    """Text of a declaration without the Markdown that makes vectors bold."""
    return text.translate(_BOLD)


def facts(quantity: Quantity) -> Facts:
    """Facts of a quantity."""
    return {
        "name": quantity.name,
        "symbol": unmarked(quantity.symbol),
        "on": quantity.on,
        "kind": quantity.kind,
        "columns": list(quantity.columns),
        "description": unmarked(quantity.description),
        "formula": unmarked(quantity.formula),
        "unit": quantity.unit(None),
        "length_exponent": quantity.length_exponent,
        "mean_degree": quantity.mean_degree,
        "parity": quantity.parity,
        "boundary": unmarked(quantity.boundary),
        "preserves": unmarked(quantity.preserves),
        "total": f"totals.{quantity.total}" if quantity.total else None,
        "source": quantity.source,
        "needs": ["the area chosen by --area" if need == CELL_AREA else need for need in _needs(quantity.name)],
        "preset": smallest_preset(quantity),
        "parameters": parameters(passes.provider(quantity.name)),
    }


def facts_of_total(total: DerivedTotal) -> Facts:
    """Facts of a derived total."""
    quantity = Quantity(total.name, length_exponent=total.length_exponent, energy=total.energy)
    return {
        "name": total.name,
        "symbol": unmarked(total.symbol),
        "on": "component",
        "kind": "total",
        "columns": [],
        "description": unmarked(total.description),
        "formula": unmarked(total.formula),
        "unit": quantity.unit(None),
        "length_exponent": total.length_exponent,
        "mean_degree": 0,
        "parity": total.parity,
        "boundary": "null on a piece that is open, not connected or without an orientation",
        "preserves": "",
        "total": f"totals.{total.name}",
        "source": total.source,
        "needs": [f"totals.{need}" for need in total.needs],
        "preset": asked_by(total),
        "parameters": parameters(total),
    }


def parameters(owner: Configurable) -> list[ParameterFacts]:
    """Parameters of a pass or of a derived total."""
    return [
        {
            "name": each.key(owner.name),
            "type": each.kind,
            "default": each.default,
            "unit": Quantity("", length_exponent=each.length_exponent).unit(None),
            "parity": each.parity,
            "by_region": each.by_region,
            "description": each.description,
        }
        for each in owner.settings
    ]


def parameter_sentence(knob: ParameterFacts) -> str:
    """A parameter in one line for people."""
    unit = "" if knob["unit"] == "1" else f" {knob['unit']}"
    clauses = [knob["description"], f"default {format_scalar(knob['default'])}{unit}"]
    clauses += ["one value, or one for each region"] * knob["by_region"]
    clauses += ["changes sign when all faces are reversed"] * (knob["parity"] == "odd")
    return "; ".join(clause for clause in clauses if clause)


def _needs(name: str) -> list[str]:
    """Public quantities that it is computed from; a hidden one is replaced by its own needs."""
    public_needs: list[str] = []
    for need in passes.provider(name).needs:
        if need == CELL_AREA or (need not in NO_QUANTITIES and passes.quantity(need).public):
            public_needs.append(need)
        elif need not in NO_QUANTITIES:
            public_needs += _needs(need)
    return list(dict.fromkeys(public_needs))


def smallest_preset(quantity: Quantity) -> str:
    """Smallest preset that has the quantity."""
    presets = ("core", "paper", "estimates", "folding")
    return next((preset for preset in presets if quantity.name in resolve([preset])), "all")


def as_data(name: str | None) -> Any:
    """Facts of one quantity or derived total, or of all quantities."""
    return facts_named(name) if name else [facts(quantity) for quantity in public()]


def facts_named(name: str) -> Facts:
    """Facts of a quantity, of one of its columns, or of a derived total.

    Errors: UsageError with the nearest names.
    """
    load_passes()
    return facts_of_total(derived[name]) if name in derived else facts(find(name))


def _reversed(quantity: Quantity) -> str:
    """Change of the column when all faces are reversed; empty if it does not change."""
    if quantity.parity == "even" and not quantity.partner:
        return ""
    return f"becomes {'−' if quantity.parity == 'odd' else ''}`{quantity.partner or quantity.name}`"


_HEADINGS = {"vertex": "Vertices", "edge": "Edges", "face": "Faces"}
_MEAN = {0: "", 1: "halved", 2: "quartered"}


def page() -> str:
    """Documentation page of all quantities, in Markdown."""
    sections = [
        "# Quantities\n",
        "Made by `curvcli passes --markdown`. H = κ₁ + κ₂, positive where the surface is convex seen from the side its "
        "normal points to. A measure is integrated over the star of a vertex; a density is per area. At a vertex that "
        "no face uses, everything but its status is null.\n",
    ]
    element = ""
    for quantity in public():
        if quantity.on != element:
            element = quantity.on
            sections.append(f"## {_HEADINGS[element]}\n")
        shown = facts(quantity)
        columns = ", ".join(f"`{column}`" for column in quantity.columns)
        rows = [
            ("columns" if quantity.vector else "column", columns if quantity.columns != (quantity.name,) else ""),
            ("formula", shown["formula"]),
            ("kind, unit", f"{shown['kind']}, {shown['unit']}"),
            ("boundary", quantity.boundary),
            ("faces reversed", _reversed(quantity)),
            ("`--mean average`", _MEAN[quantity.mean_degree]),
            ("preserves", shown["preserves"]),
            ("sum", f"`{shown['total']}`" if shown["total"] else ""),
            ("preset", shown["preset"]),
            ("source", shown["source"]),
            ("needs", ", ".join(shown["needs"])),
            *((f"`--set {knob['name']}=…`", parameter_sentence(knob)) for knob in shown["parameters"]),
        ]
        sections.append(f"### `{quantity.name}` {shown['symbol']}\n")
        sections.append(f"{quantity.description}\n")
        sections.append("\n".join(f"* {label}: {value}" for label, value in rows if value) + "\n")
    sections.append("## Totals of components\n")
    sections.append(
        "Computed from other totals; null on a piece that is open, not connected or without an orientation.\n"
    )
    for total in derived.values():
        shown = facts_of_total(total)
        rows = [
            ("formula", shown["formula"]),
            ("unit", shown["unit"]),
            ("faces reversed", f"becomes −`{total.name}`" if total.parity == "odd" else ""),
            ("computed with", f"`{shown['preset']}`"),
            ("source", shown["source"]),
            ("needs", ", ".join(shown["needs"])),
            *((f"`--set {knob['name']}=…`", parameter_sentence(knob)) for knob in shown["parameters"]),
        ]
        sections.append(f"### `{total.name}` {shown['symbol']}\n")
        sections.append(f"{total.description}\n")
        sections.append("\n".join(f"* {label}: {value}" for label, value in rows if value) + "\n")
    return "\n".join(sections)
