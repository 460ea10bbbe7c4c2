"""Analysis: the columns, totals, checks and notices of one surface."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import findings
from .checks import Check, rules
from .checks.listing import known_checks, summarised
from .columns import Columns, named
from .conventions import Conventions
from .declare import AT_SCALE, CELL_AREAS, Element, Quantity, passes
from .errors import Notice, UsageError
from .finite import or_none
from .groups import Groups
from .loading.surfaces import Orient, as_surface
from .pipeline import at_scales, defaults, evaluate, prepare, presented, resolve, schedule
from .precision import precision
from .regions import Regions, cut_apart, find_regions
from .regions import findings as region_findings
from .resolution import beside, of_stars, unscaled
from .settings import DEFAULTS, Settings, parse_scales
from .surface import Surface
from .totals import lost, lost_totals, summed, totals

if TYPE_CHECKING:
    from .report.configuration import Configuration

Array = NDArray[Any]

# Checks of components and regions are listed one by one up to this many; beyond, those that fail.
LISTED_GROUPS = 100

# What the report's statistics and the default check need whatever is asked for.
_ALWAYS = ("status", "degree", "star_area", "star_vector", "face_area", "degenerate_face", "K", "kappa_g")


class Analysis:
    """Everything computed of one surface: `vertices`, `edges`, `faces`, `totals`, `checks`, `notices`, `report()`.

    Columns are in the file's unit of length and in the chosen convention for H; NaN is undefined.
    """

    def __init__(
        self,
        surface: Surface,
        chosen: list[str],
        conventions: Conventions,
        regions: Regions | None = None,
        checks: Iterable[str] | None = None,
        settings: Settings = DEFAULTS,
    ) -> None:
        self.surface, self.chosen, self.conventions, self.regions = surface, chosen, conventions, regions
        self.settings = settings
        self.timings: dict[str, float] = {}
        self.extra_notices: list[Notice] = []
        self.configuration: Configuration | None = None
        self._rules = self._applicable_rules() if checks is None else [rules[name] for name in checks]
        wanted = {
            *chosen,
            *_ALWAYS,
            *self._totalled,
            *self._flags,
            *beside(chosen),
            *(need for rule in self._rules for need in rule.needs),
        }
        prepare(surface, wanted, conventions.area)
        self.columns = evaluate(surface, wanted, area=conventions.area, settings=settings)
        self._later: dict[str, Array] = {}
        self._shown: dict[str, Array] = {}
        self._named: dict[Element, dict[str, tuple[Quantity, int | None]]] = {}
        self.cut: Analysis | None = None
        if regions is not None:
            cut, self.cut_groups = cut_apart(surface, regions)
            self.cut = Analysis(cut, chosen, conventions, checks=[rule.name for rule in self._rules], settings=settings)

    @cached_property
    def _closure(self) -> set[str]:
        """Every quantity that is computed on the way to the chosen ones."""
        plain = (name.partition(AT_SCALE)[0] for name in self.chosen)
        order = schedule([*plain, *_ALWAYS], self.conventions.area)
        return {quantity.name for one in order for quantity in one.provides}

    @cached_property
    def _totalled(self) -> list[str]:
        """What is summed: of several scales, that of each for which the column itself is chosen."""
        scaled = [name for name in self.chosen if AT_SCALE in name]
        plain = [name for name in self._closure if not (scaled and passes.depends_on_scale(name))]
        return [quantity.name for quantity in summed([*plain, *scaled])]

    @cached_property
    def _flags(self) -> list[str]:
        """Hidden flags on the way to the chosen columns: what they mark is reported."""
        flags = (name for name in self._closure if passes.quantity(name).kind == "flag")
        return at_scales(flags, self.settings)

    def _applicable_rules(self) -> list[Any]:
        """Checks whose needs the chosen passes meet."""
        return [rule for rule in rules.values() if self._closure.issuperset(rule.needs)]

    # ------------------------------------------------------------------ columns

    def column(self, name: str) -> Array:
        """One column as a user sees it: (n,), (n, 3), or strings for labels."""
        return presented(passes.quantity(name), self._column(name), self.surface, self.conventions.mean)

    def shown(self, name: str) -> Array:
        """The same, kept for whoever asks again."""
        if name not in self._shown:
            self._shown[name] = self.column(name)
        return self._shown[name]

    def _column(self, name: str) -> Array:
        """A column as computed; those of a table asked for later are kept apart, so that no report depends on it."""
        if name not in self.columns and name not in self._later:
            known = {**self.columns, **self._later}
            area, settings = self.conventions.area, self.settings
            self._later = evaluate(self.surface, [name], area=area, settings=settings, known=known)
        return self.columns[name] if name in self.columns else self._later[name]

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
        """Columns refer to their analysis, so that it must not keep them: a circle would hold its memory."""
        if element not in self._named:
            self._named[element] = named(self, element)
        return Columns(self, self._named[element])

    # ------------------------------------------------------------------ integrals

    def totals_of(self, groups: Groups) -> dict[str, NDArray[np.float64]]:
        """Totals of each group, (G,) or (G, 3); NaN where undefined."""
        return totals(self.surface, groups, self.columns, self.conventions.mean)

    @cached_property
    def totals(self) -> dict[str, float | list[float] | None]:
        """Totals of the whole surface by the report's keys; None where undefined."""
        return {key: plain(values[0]) for key, values in self.totals_of(self.surface.whole).items()}

    @cached_property
    def checks(self) -> list[Check]:
        """Every identity that the chosen passes allow to be tested, on the whole and on each component."""
        found = [check for rule in self._rules for check in rule.run(self.surface, self.surface.whole, self.columns)]
        if self.surface.components.count > 1:
            found += self._checked(self.surface.components)
        if self.cut is not None:
            found += self.cut._checked(self.cut_groups)
        return found

    def _checked(self, groups: Groups) -> list[Check]:
        """The checks of every group, or of those that fail where there are very many."""
        found: list[Check] = []
        for rule in self._rules:
            each = rule.run(self.surface, groups, self.columns)
            found += each if groups.count <= LISTED_GROUPS else summarised(each, f"{groups.kind}s")
        return found

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not any(check.status == "fail" for check in self.checks)

    @property
    def notices(self) -> list[Notice]:
        """What was accepted but should be said: the loader's notices and the surface's defects."""
        return [*self.surface.notices, *self._findings, *self.extra_notices]

    @cached_property
    def _findings(self) -> list[Notice]:
        found = findings.of_surface(self.surface, self.columns)
        asked = self.settings.scales != DEFAULTS.scales
        found += of_stars(self.surface, self.columns, self.chosen, self.totals, asked)
        found += findings.out_of_range(self._lost)
        if self.cut is not None and self.regions is not None:
            found += region_findings(self.cut.surface, self.cut_groups, self.regions)
        return found

    @property
    def _lost(self) -> Counter[str]:
        """How many values of each chosen column and total no double holds in the file's unit."""
        found: Counter[str] = Counter()
        if self.surface.unit_exponent:
            for quantity in map(passes.quantity, self.chosen):
                if not quantity.labels:
                    values = self.columns[quantity.name]
                    found[quantity.stem] += lost(self.surface, values, quantity.length_exponent)
            found.update(lost_totals(self.surface, self.columns))
        return found

    # ------------------------------------------------------------------ outputs

    def report(self) -> dict[str, Any]:
        """The report of the interface, as plain Python values ready for JSON."""
        from .report.build import build

        return build(self)

    def write(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the vertex table, a coloured mesh, a picture or the report, as the suffix says; whole or not at all."""
        from .output.write import write_outputs

        write_outputs(self, [str(path)], force=force)


def plain(value: Any) -> Any:
    """A number or a vector for JSON, None where undefined."""
    if np.ndim(value):
        return [plain(x) for x in value] if np.isfinite(value).any() else None
    return or_none(float(value))


def analyze(
    surface: Any,
    passes: str | Iterable[str] | None = None,
    *,
    area: Literal["barycentric", "mixed", "voronoi"] = "barycentric",
    mean: Literal["sum", "average"] = "sum",
    orient: Orient | None = None,
    weld: str | float = "auto",
    unit: str | None = None,
    regions: str | os.PathLike[str] | NDArray[np.integer[Any]] | None = None,
    checks: str | Iterable[str] | None = None,
    rings: str | int | Iterable[str | int] | None = None,
    radius: str | float | Iterable[str | float] | None = None,
    normals: Literal["mesh", "file"] = "mesh",
    noise: float | None = None,
) -> Analysis:
    """Compute curvatures of a surface, its totals and the identities that prove them.

    surface: a Surface, a path, a trimesh.Trimesh or a pair (points (V, 3), faces (F, 3)).
    passes: a preset (`topology`, `core`, `paper`, `estimates`, `all`) or names; None is `core`, with `estimates` where
    a scale is asked for. area: the cell of `K_density`. mean: whether H is κ₁ + κ₂ or their average. orient: `file`, or
    `outward` to turn closed patches that are inside out; None is what a Surface was made with, else `file`. weld: how
    the vertices of a file are merged, see `curvcli.load`. unit: a label for lengths. regions: a label per face
    (negative: none), or the name of the file, record or property that holds them. checks: names of the identities to
    test, whatever they need; None is those whose needs the chosen passes meet. rings, radius: how far estimates look,
    in rings of edges or at a radius (a length, or mean edge lengths such as `3e`); several (`2e,4e`, or a list) give
    one column for each. normals: whose normals the corrected curvatures use, the mesh's or those the file gives. noise:
    the standard deviation of each coordinate, for `K_sigma` and `h_sigma`; None is the precision of the coordinates.
    Errors: UsageError for an unknown name or an option that does not fit, InputError for a mesh that is no surface.
    """
    scales = parse_scales(rings, radius)
    settings = Settings(scales or DEFAULTS.scales, normals, noise)
    chosen = choose(passes, settings, bool(scales))
    options = (
        ("area", area, tuple(CELL_AREAS)),
        ("mean", mean, ("sum", "average")),
        ("orient", orient or "file", ("file", "outward")),
        ("normals", normals, ("mesh", "file")),
    )
    for option, value, known in options:
        if value not in known:
            raise UsageError(f"{option} is {value!r}, expected one of {', '.join(known)}")
    found = as_surface(surface, orient=orient, weld=weld, normals=normals)
    if isinstance(regions, os.PathLike):
        regions = os.fspath(regions)
    named = regions if regions is None or isinstance(regions, str) else "array"
    weld = found.file.weld if found.file else "none"
    conventions = Conventions(mean, area, found.orient, weld, unit, named, *told(chosen, settings, found))
    named_checks = None if checks is None else known_checks(checks)
    labels = None if regions is None else find_regions(found, regions)
    analysis = Analysis(found, chosen, conventions, labels, named_checks, settings)
    analysis.extra_notices += unscaled(chosen, scales)
    return analysis


def choose(passes: str | Iterable[str] | None, settings: Settings, scaled: bool) -> list[str]:
    """The columns of an analysis: those named, or `core`, with `estimates` where a scale is asked for.

    A name may say at which of several scales: `K_fit@2e`.
    """
    if passes is None:
        passes = defaults(scaled, settings.noise is not None)
    names = [passes] if isinstance(passes, str) else list(passes)
    at_one = [name for name in names if AT_SCALE in name]
    return list(dict.fromkeys([*at_scales(resolve(name for name in names if AT_SCALE not in name), settings), *at_one]))


def told(chosen: Iterable[str], settings: Settings, surface: Surface) -> tuple[str | None, str | None, str | None]:
    """The scales, the normals and the noise that the chosen columns depend on, None where they do not."""
    plain = {name.partition(AT_SCALE)[0] for name in chosen}
    scaled = any(passes.depends_on_scale(name) for name in plain)
    used = {need for one in schedule(plain, "barycentric") for need in one.needs}
    scales = ",".join(scale.name for scale in settings.scales)
    noise = None
    if "noise" in used:
        noise = repr(precision(surface) if settings.noise is None else settings.noise)
    return scales if scaled else None, settings.normals if "normals" in used else None, noise
