"""The list of every sample: `@sample` enters a surface, `get` and `names` find it again."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..errors import UsageError
from ..support.words import suggestion

if TYPE_CHECKING:
    from .model import Sample, SampleSpec

FAMILIES = (
    "polyhedra",
    "spheres",
    "tubes",
    "assembled",
    "flat",
    "graphs",
    "revolution",
    "constant_mean",
    "minimal",
    "nonorientable",
    "defects",
)
"""The modules that hold the surfaces, in the order they are listed in."""

_registry: dict[str, SampleSpec] = {}


def sample(*, summary: str, exact: str) -> Callable[[Callable[..., Sample]], SampleSpec]:
    """Enter a surface under the name of its function.

    summary: a noun phrase for lists. exact: one sentence on its exact values.
    """

    def enter(function: Callable[..., Sample]) -> SampleSpec:
        from .model import SampleSpec

        spec = SampleSpec(function.__name__, summary, exact, function)
        _registry[spec.name] = spec
        return spec

    return enter


def specs() -> tuple[SampleSpec, ...]:
    """Every sample, family by family."""
    for family in FAMILIES:
        importlib.import_module(f"{__package__}.{family}")
    order = {f"{__package__}.{family}": place for place, family in enumerate(FAMILIES)}
    return tuple(sorted(_registry.values(), key=lambda spec: order.get(spec.function.__module__, len(order))))


def names() -> tuple[str, ...]:
    """The name of every sample, family by family."""
    return tuple(spec.name for spec in specs())


def get(name: str) -> SampleSpec:
    """The sample of that name. Errors: UsageError for an unknown name, with similar ones."""
    known = {spec.name: spec for spec in specs()}
    spec = known.get(name.strip().lower().replace("-", "_"))
    if spec is None:
        way_out = suggestion(name, known, "`curvcli sample` lists them")
        raise UsageError(f"there is no sample named {name!r}{way_out}")
    return spec
