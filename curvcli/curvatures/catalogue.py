"""Catalogue of passes: built-ins, plug-ins, presets, and the order of the table."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from ..errors import UsageError
from ..mesh.scale import EstimatorSettings
from ..support.words import suggestion
from .quantity import AT_SCALE, Quantity
from .registry import Registry, passes

# Modules of this folder that declare no pass.
WITHOUT_PASSES = ("catalogue", "derived", "engine", "quantity", "registry", "setting", "setting_values")

# The default preset, in the order of the table.
CORE = (
    *("status", "degree", "K", "kappa_g", "A", "A_vec", "H_vec", "h", "h_signed", "K_density"),
    *("kappa_1", "kappa_2", "willmore", "willmore_hks"),
)


# Rectified integrals and the indices of cortical folding.
FOLDING = ("K_positive", "K_negative", "K_rectified", "H_rectified", "folding_index", "intrinsic_index")

# Standard deviations of K and h for noisy coordinates.
UNCERTAINTIES = ("K_sigma", "h_sigma")


def defaults(scaled: bool, noisy: bool) -> tuple[str, ...]:
    """Default quantities: core, with estimates if a scale is given, and uncertainties if noise is given."""
    return ("core", *(("estimates",) if scaled else ()), *(UNCERTAINTIES if noisy else ()))


def presets() -> dict[str, Sequence[str]]:
    """The quantities of each preset."""
    load_passes()
    public = passes.quantities()
    return {
        "topology": ["status", "degree"],
        "core": CORE,
        "paper": [q.name for q in public if q.source.startswith("Sullivan")],
        "estimates": [q.name for q in public if _estimates(q)],
        "folding": FOLDING,
        "all": [q.name for q in public],
    }


def _estimates(quantity: Quantity) -> bool:
    """Test for a curvature, a shape index or an energy at a scale, as opposed to directions and conditions."""
    curvature = quantity.kind in ("density", "measure") or quantity.signed
    return curvature and passes.depends_on_scale(quantity.name) and not quantity.energy


def resolve(names: Iterable[str]) -> list[str]:
    """Resolve names, stems of vectors, comma lists and presets to quantity names in table order.

    Errors: UsageError for an unknown name, with similar ones.
    """
    named = presets()
    public = {quantity.name: quantity for quantity in passes.quantities()}
    stems = {column: q.name for q in reversed(public.values()) for column in (q.stem, *q.columns)}
    wanted: set[str] = set()
    for name in (part.strip() for entry in names for part in entry.split(",")):
        if name in named:
            wanted.update(named[name])
        elif name in public or name in stems:
            wanted.add(stems.get(name, name))
        else:
            way_out = suggestion(name, [*named, *public], "`curvcli passes` lists them")
            raise UsageError(f"unknown pass {name!r}{way_out}")
    return [name for name in public if name in wanted]


def at_scales(names: Iterable[str], settings: EstimatorSettings) -> list[str]:
    """Expand names that depend on the scale, once per scale if there are several: `K_ring@2e`."""
    load_passes()
    if len(settings.scales) == 1:
        return list(names)
    each = [AT_SCALE + scale.name for scale in settings.scales]
    return [name + scale for name in names for scale in (each if passes.depends_on_scale(name) else [""])]


@cache
def load_passes() -> None:
    """Import the built-in passes and the plug-ins of the entry-point group `curvcli.passes`, once.

    Errors: UsageError for a plug-in that fails to import or has an invalid declaration.
    """
    from importlib.metadata import entry_points

    with passes.in_any_order():
        for module in iter_modules(import_module(__package__).__path__):
            if not module.ispkg and module.name not in WITHOUT_PASSES:
                import_module(f".{module.name}", __package__)
    for plug_in in entry_points(group="curvcli.passes"):
        try:
            plug_in.load()
        except Exception as error:
            where = f"plug-in {plug_in.name} ({plug_in.value})"
            raise UsageError(f"{where} cannot be loaded: {type(error).__name__}: {error}") from error


def loaded() -> Registry:
    """All passes, built-ins and plug-ins."""
    load_passes()
    return passes
