"""Result: the columns, totals, checks and notices of one surface."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..checks.base import SHARES, Check, CheckRule
from ..checks.catalogue import identities
from ..checks.partition import Share
from ..checks.summary import summarise_checks
from ..curvatures.catalogue import at_scales
from ..curvatures.derived import derived_for
from ..curvatures.engine import evaluate, in_file_unit, needs, parts_of_faces, prepare, schedule
from ..curvatures.quantity import AT_SCALE, CELL_AREA, Element
from ..curvatures.registry import passes
from ..errors import Notice
from ..loading.labels import Regions, cut_along_regions, find_regions, region_notices
from ..loading.load import as_surface
from ..mesh.borders import vertex_regions
from ..mesh.groups import Groups
from ..mesh.scale import DEFAULTS, EstimatorSettings, parse_scales
from ..mesh.surface import Surface
from ..support.arrays import Array, Floats, or_none
from . import notices as findings
from .by_region import settings_by_region, settings_of_faces, splits_faces
from .columns import Columns, named
from .request import Request
from .scale_notices import needs_of_stars, not_at_scale, star_notices
from .shares import Partition
from .totals import columns_for, overflow_counts, summed, totals

if TYPE_CHECKING:
    from .configuration import Configuration


# Up to this many components or regions, their checks are listed one by one; beyond, only those that fail.
LISTED_GROUPS = 100

# Needs of the report's statistics and of the default check, in every analysis.
_ALWAYS = ("status", "degree", "star_area", "star_vector", "face_area", "degenerate_face", "K", "kappa_g")


class Result:
    """Everything computed of one surface: `vertices`, `edges`, `faces`, `totals`, `checks`, `notices`.

    Columns are in the file's unit of length and in the chosen convention for H; NaN is undefined.
    """

    def __init__(
        self,
        surface: Surface,
        request: Request,
        regions: Regions | None = None,
        checks: Iterable[str] | None = None,
        settings: EstimatorSettings | None = None,
    ) -> None:
        self.surface, self.request, self.regions = surface, request, regions
        self.chosen, self.conventions = request.chosen, request.conventions(surface)
        self.settings = settings or settings_by_region(request.settings, request.values, regions)
        self.timings: dict[str, float] = {}
        self.extra_notices: list[Notice] = []
        self.configuration: Configuration | None = None
        self._derived = derived_for(self.chosen, self.settings.values)
        self._rules = self._applicable_rules() if checks is None else [identities()[name] for name in checks]
        wanted = [
            *self.chosen,
            *_ALWAYS,
            *self._totalled,
            *self._flags,
            *needs_of_stars(self.chosen),
            *(("star_extent",) if "h_signed" in self.chosen else ()),  # of the rounding of H
            *(need for rule in self._rules for need in rule.needs),
        ]
        besides = {*request.besides}.difference(wanted)
        names = [*wanted, *besides]
        prepare(passes, surface, names, request.area)
        computed = evaluate(passes, surface, names, area=request.area, settings=self.settings)
        self.columns = {name: computed[name] for name in wanted}
        self.besides = {name: computed[name] for name in besides}
        self._shown: dict[str, Array] = {}
        self.cut: Result | None = None
        if regions is not None:
            self._borders = vertex_regions(surface.faces, regions.face, surface.n_vertices)
            cut, self.cut_groups = cut_along_regions(surface, regions, self._borders)
            alone = replace(
                request,
                unit=self.conventions.unit,
                regions=None,
                parameters=None,
                passes=tuple(self.chosen),
                besides=(),
            )
            names = [rule.name for rule in self._rules if not rule.of_shares]
            self.cut = Result(cut, alone, checks=names, settings=settings_of_faces(self.settings, regions.face >= 0))

    @cached_property
    def _closure(self) -> set[str]:
        """Every quantity that is computed for the chosen ones."""
        base_names = (name.partition(AT_SCALE)[0] for name in self.chosen)
        order = schedule(passes, [*base_names, *_ALWAYS, *columns_for(self._derived)], self.request.area)
        return {quantity.name for step in order for quantity in step.provides}

    @cached_property
    def _totalled(self) -> list[str]:
        """Quantities with totals; of several scales, those whose column is chosen."""
        scaled = [name for name in self.chosen if AT_SCALE in name]
        unscaled = [name for name in self._closure if not (scaled and passes.depends_on_scale(name))]
        return [quantity.name for quantity in summed([*unscaled, *scaled])]

    @cached_property
    def _flags(self) -> list[str]:
        """Hidden flags that the chosen columns depend on; notices report the elements they mark."""
        flags = (name for name in self._closure if passes.quantity(name).kind == "flag")
        return at_scales(flags, self.settings)

    def _applicable_rules(self) -> list[CheckRule]:
        """Checks whose needs the chosen passes meet."""
        return [rule for rule in identities().values() if self._closure.issuperset(rule.needs)]

    # ------------------------------------------------------------------ columns

    def column(self, name: str) -> Array:
        """One column as in the outputs: (n,), (n, 3), or strings for labels."""
        mean, energy = self.request.mean, self.request.energy
        return in_file_unit(passes.quantity(name), self.computed(name), self.surface, mean, energy)

    def shown(self, name: str) -> Array:
        """The same column, cached, and computed where the request did not name it."""
        if name not in self._shown:
            self.include([name])
            self._shown[name] = self.column(name)
        return self._shown[name]

    def computed(self, name: str) -> Array:
        """A column in the unit of computation and the sum convention of H."""
        return self.columns[name] if name in self.columns else self.besides[name]

    def include(self, names: Iterable[str]) -> None:
        """Compute quantities that the request did not name; the report does not depend on them."""
        missing = {*names} - self.columns.keys() - self.besides.keys()
        if missing:
            known = {**self.columns, **self.besides}
            columns = evaluate(
                passes, self.surface, missing, area=self.request.area, settings=self.settings, known=known
            )
            self.besides |= {name: columns[name] for name in missing}

    def with_noise(self, names: Collection[str], noise: float) -> dict[str, Array]:
        """Quantities for another standard deviation of the coordinates, in the unit of computation."""
        settings = replace(self.settings, noise=noise)
        known = {name: column for name, column in self.columns.items() if name not in names}
        columns = evaluate(passes, self.surface, names, area=self.request.area, settings=settings, known=known)
        return {name: columns[name] for name in names}

    def depends_on_area(self, name: str) -> bool:
        """True if a quantity follows from the cell area of the request."""
        return any(CELL_AREA in step.needs for step in schedule(passes, [name], self.request.area))

    @property
    def vertices(self) -> Columns:
        """Vertex columns by name."""
        return self._columns_of("vertex")

    @property
    def edges(self) -> Columns:
        """Edge columns by name."""
        return self._columns_of("edge")

    @property
    def faces(self) -> Columns:
        """Face columns by name."""
        return self._columns_of("face")

    def _columns_of(self, element: Element) -> Columns:
        """Columns refer to their analysis, so the analysis does not keep them: a cycle would hold its memory."""
        return Columns(self, named(self, element))

    # ------------------------------------------------------------------ integrals

    def totals_of(self, groups: Groups) -> dict[str, NDArray[np.float64]]:
        """Totals of each group, (G,) or (G, 3); NaN where undefined."""
        mean, energy = self.request.mean, self.request.energy
        return totals(self.surface, groups, self.columns, mean, energy, self._derived, self.settings)

    @cached_property
    def totals(self) -> dict[str, float | list[float] | None]:
        """Totals of the whole surface by the report's keys; None where undefined."""
        return {key: or_null(values[0]) for key, values in self.totals_of(self.surface.whole).items()}

    @cached_property
    def checks(self) -> list[Check]:
        """Every identity that the chosen passes allow to be tested, on the whole and on each component."""
        checks = self._checked(self.surface.whole)
        if self.surface.components.count > 1:
            checks += self._checked(self.surface.components)
        if self.cut is not None:
            checks += self.cut._checked(self.cut_groups)
            for rule in self._rules:
                checks += rule.run(self.surface, self.surface.whole, {SHARES: self.shares}) if rule.of_shares else []
        return checks

    @cached_property
    def shares(self) -> list[Share]:
        """Shares of every total by region, and of the faces without one; none without regions."""
        if self.regions is None:
            return []
        area, borders = self.columns["face_area"], self._borders
        partition = Partition(self.surface, self.regions.face, self.regions.count, area, borders)
        split = {name: self._split(name) for name in self._totalled if splits_faces(name, self.settings)}
        return partition.shares({name: self.columns[name] for name in self._totalled}, split, self.settings)

    def _split(self, name: str) -> tuple[Floats, Floats]:
        """Parts of the faces in a measure that its pass splits, and the sizes of their terms."""
        base_name, at, scale = name.partition(AT_SCALE)
        step = passes.provider(base_name)
        names = needs(step, self.request.area)
        at_scale = [need + at + scale if passes.depends_on_scale(need) else need for need in names]
        self.include(at_scale)
        known = {need: self.computed(full) for need, full in zip(names, at_scale, strict=True)}
        return parts_of_faces(step, self.surface, known, self.request.area, self.settings)

    def _checked(self, groups: Groups) -> list[Check]:
        """Checks of every group; of very many groups, those that fail."""
        checks: list[Check] = []
        for rule in self._rules:
            if rule.of_shares:
                continue
            if groups.count <= LISTED_GROUPS:
                checks += rule.run(self.surface, groups, self.columns)
            else:
                checks += summarise_checks(rule.evaluate(self.surface, groups, self.columns), f"{groups.kind}s")
        return checks

    def shares_of_regions(self) -> dict[str, Floats]:
        """Shares of every total by region, (R,) or (R, 3), in the file's unit and the chosen convention for H."""
        shares: dict[str, Floats] = {}
        for share in self.shares:
            values = self.surface.in_file_unit(share.values[:-1], share.length_exponent)
            values = values * 0.5**share.mean_degree if self.request.mean == "average" else values
            shares[share.key] = values * self.request.energy if share.energy else values
        return shares

    @property
    def passed(self) -> bool:
        """True if no check failed."""
        return not any(check.status == "fail" for check in self.checks)

    @property
    def notices(self) -> list[Notice]:
        """Notices of the loader and of the surface's defects."""
        return [*self.surface.notices, *self._findings, *self.extra_notices]

    @cached_property
    def _findings(self) -> list[Notice]:
        notices = findings.of_surface(self.surface, self.columns)
        asked = self.settings.scales != DEFAULTS.scales
        notices += star_notices(self.surface, self.columns, self.chosen, self.totals, asked)
        notices += findings.out_of_range(overflow_counts(self.surface, self.columns, self.chosen))
        if self.cut is not None and self.regions is not None:
            notices += region_notices(self.cut.surface, self.cut_groups, self.regions)
        return notices


def or_null(value: Any) -> Any:
    """A number or a vector for JSON, None where undefined."""
    if np.ndim(value):
        return [or_null(x) for x in value] if np.isfinite(value).any() else None
    return or_none(float(value))


Kind = TypeVar("Kind", bound=Result)


def compute(given: Any, request: Request, kind: type[Kind]) -> Kind:
    """The result for a surface, a path, a mesh object or a pair (points, faces), as the given kind of `Result`.

    Errors: those of `curvcli.analyze`.
    """
    _ = request.chosen, request.statistics  # refuse an unknown name before a mesh is read
    surface = as_surface(given, orient=request.orient, weld=request.weld, normals=request.normals)
    labels = request.labels
    checks = request.named_checks
    result = kind(surface, request, None if labels is None else find_regions(surface, labels), checks)
    result.extra_notices += not_at_scale(request.chosen, parse_scales(request.rings, request.radius))
    return result
