"""Request: every option of an analysis that changes its numbers or their names, and the conventions it leads to."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..checks.catalogue import named_checks
from ..curvatures.catalogue import at_scales, defaults, resolve
from ..curvatures.derived import derived_for
from ..curvatures.engine import schedule
from ..curvatures.quantity import AT_SCALE, CELL_AREAS, Configurable, Quantity
from ..curvatures.registry import passes as registry
from ..curvatures.setting_values import (
    GivenSettings,
    SettingValue,
    describe_settings,
    implied,
    parse_settings,
    regions_of,
)
from ..errors import UsageError
from ..mesh.precision import precision
from ..mesh.scale import DEFAULTS, EstimatorSettings, parse_scales
from ..mesh.surface import Orient, Surface
from .rigidity import Rigidity, parse_rigidity
from .statistics import parse_statistics

Area = Literal["barycentric", "mixed", "voronoi"]
Mean = Literal["sum", "average"]
NormalSource = Literal["mesh", "file"]


@dataclass(frozen=True)
class Conventions:
    """Choices that change numbers or their names; every output states them."""

    mean: str = "sum"
    area: str = "barycentric"
    orient: str = "file"
    weld: str = "none"
    unit: str | None = None
    regions: str | None = None
    scale: str | None = None
    normals: str | None = None
    noise: str | None = None
    settings: str | None = None
    bending_rigidity: str | None = None

    @property
    def rigidity(self) -> Rigidity | None:
        """Bending rigidity that energies are multiplied by; None leaves them in units of κ."""
        return None if self.bending_rigidity is None else parse_rigidity(self.bending_rigidity)

    def unit_of(self, quantity: Quantity) -> str:
        """Unit of a quantity in outputs."""
        return quantity.unit(self.unit, None if self.rigidity is None else self.rigidity.unit)


@dataclass(frozen=True, kw_only=True)
class Request:
    """Options of an analysis, documented at `curvcli.analyze`.

    parameters: values of the parameters of passes, see `parse_settings`.
    besides: quantities that tables and colours need beside the report, computed in the same evaluation; the report does
    not depend on them.
    Errors: UsageError for an option or a name that is not known.
    """

    passes: str | Iterable[str] | None = None
    area: Area = "barycentric"
    mean: Mean = "sum"
    orient: Orient | None = None
    weld: str | float = "auto"
    unit: str | None = None
    regions: str | os.PathLike[str] | NDArray[np.integer[Any]] | None = None
    checks: str | Iterable[str] | None = None
    rings: str | int | Iterable[str | int] | None = None
    radius: str | float | Iterable[str | float] | None = None
    normals: NormalSource = "mesh"
    noise: float | None = None
    stat: str | Iterable[str] = ()
    parameters: GivenSettings = None
    bending_rigidity: str | None = None
    besides: Collection[str] = ()

    def __post_init__(self) -> None:
        known: dict[str, tuple[str, ...]] = {
            "area": tuple(CELL_AREAS),
            "mean": ("sum", "average"),
            "orient": ("file", "outward"),
            "normals": ("mesh", "file"),
        }
        for option, values in known.items():
            value = getattr(self, option)
            if value not in values and not (option == "orient" and value is None):
                raise UsageError(f"{option} is {value!r}, expected one of {', '.join(values)}")
        _ = self.rigidity
        for name, region in regions_of(self.values) if self.regions is None else ():
            raise UsageError(f"{name} has a value for region {region!r}, and there are no regions without --regions")

    @cached_property
    def values(self) -> dict[str, SettingValue]:
        """Values of the parameters of passes by PASS.NAME, as given."""
        return parse_settings(self.parameters)

    @cached_property
    def rigidity(self) -> Rigidity | None:
        """Bending rigidity; None leaves energies in units of κ."""
        return None if self.bending_rigidity is None else parse_rigidity(self.bending_rigidity)

    @property
    def energy(self) -> float:
        """Factor of energies, the bending rigidity in its unit."""
        return 1.0 if self.rigidity is None else self.rigidity.size

    @cached_property
    def settings(self) -> EstimatorSettings:
        """Scales, normals and noise of estimates, and parameters of passes, without values by region."""
        scales = parse_scales(self.rings, self.radius)
        values = {name: value for name, value in self.values.items() if not isinstance(value, dict)}
        return EstimatorSettings(scales or DEFAULTS.scales, self.normals, self.noise, values)

    @cached_property
    def chosen(self) -> list[str]:
        """Columns: those named, or `core`, with `estimates` where a scale is given; and those of passes with a setting.

        A name may give one of several scales: `K_fit@2e`.
        """
        named = self.passes
        if named is None:
            named = defaults(bool(parse_scales(self.rings, self.radius)), self.noise is not None)
        names = [named] if isinstance(named, str) else list(named)
        at_one = [name for name in names if AT_SCALE in name]
        resolved = resolve([*(name for name in names if AT_SCALE not in name), *self.implied])
        return list(dict.fromkeys([*at_scales(resolved, self.settings), *at_one]))

    @property
    def implied(self) -> list[str]:
        """Columns of the passes that have a setting, and of energies where a bending rigidity is given."""
        return implied(self.values, self.bending_rigidity)

    @cached_property
    def named_checks(self) -> list[str] | None:
        """Names of the checks; None stands for all whose needs the chosen passes meet."""
        return None if self.checks is None else named_checks(self.checks)

    @cached_property
    def statistics(self) -> tuple[str, ...]:
        """Statistics of the columns in each region and component; none for those of the report, in regions only."""
        return parse_statistics(self.stat)

    @property
    def labels(self) -> str | NDArray[np.integer[Any]] | None:
        """Source of the regions: a name, or labels."""
        return os.fspath(self.regions) if isinstance(self.regions, os.PathLike) else self.regions

    def conventions(self, surface: Surface) -> Conventions:
        """Conventions of the numbers of a surface; None for an option that no chosen column depends on."""
        base_names = {name.partition(AT_SCALE)[0] for name in self.chosen}
        scaled = any(registry.depends_on_scale(name) for name in base_names)
        order = schedule(registry, base_names, "barycentric")
        used = {need for step in order for need in step.needs}
        owners: list[Configurable] = [*order, *derived_for(self.chosen, self.values)]
        values: dict[str, SettingValue] = {
            each.key(owner.name): each.default for owner in owners for each in owner.settings
        }
        values |= {name: value for name, value in self.values.items() if name in values}
        settings = self.settings
        noise = None
        if "noise" in used:
            noise = repr(precision(surface) if settings.noise is None else settings.noise)
        labels = self.labels
        return Conventions(
            self.mean,
            self.area,
            surface.orient,
            surface.file.weld if surface.file else "none",
            self.unit or (surface.file.unit if surface.file else None),
            labels if labels is None or isinstance(labels, str) else "array",
            ",".join(scale.name for scale in settings.scales) if scaled else None,
            settings.normals if "normals" in used else None,
            noise,
            describe_settings(values) if values else None,
            None if self.rigidity is None else str(self.rigidity),
        )
