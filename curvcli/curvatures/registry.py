"""Pass and Registry: declaration of passes, and lookup of quantities.

A pass is one pure function. Its name is the column, its parameters are the quantities it needs, and its decorator
describes the column; tables, schema, documentation, invariance tests and benchmarks are derived from them.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from importlib import import_module
from operator import getitem
from typing import Any, get_args

from ..errors import UsageError
from ..mesh.scale import PARAMETERS
from ..support.order import topological_order
from ..support.words import suggestion
from .quantity import AT_SCALE, CELL_AREA, MASKS, NO_QUANTITIES, SURFACE, Element, Quantity
from .setting import Setting, split_signature

# The names of scales at the end of a column: `3rings`, `2.5e`, `r0.1`.
_SCALE = re.compile(r"r\d[\d.e+-]*|\d[\d.e+-]*(rings|e)")


@dataclass(frozen=True)
class Pass:
    """A registered function with the quantities it provides and the names of its needs.

    pointwise: its values at a vertex depend on the arguments at that vertex only. Arguments are then columns and masks
    of vertices, results are numbers and flags, and the function is called with blocks of vertices.
    settings: its parameters with defaults. of_faces: for a measure of vertices whose settings differ from face to face,
    the function of the same arguments that splits it: (F,) parts of the faces, and (F,) sizes of their terms.
    registry: the registry of the pass.
    """

    name: str
    compute: Callable[..., Any]
    provides: tuple[Quantity, ...]
    needs: tuple[str, ...]
    pointwise: bool = False
    settings: tuple[Setting, ...] = ()
    of_faces: Callable[..., tuple[Any, Any]] | None = None
    registry: Registry | None = field(default=None, repr=False, compare=False)

    def __reduce__(self) -> tuple[Callable[..., Pass], tuple[Registry | None, str]]:
        """Pickle a pass by the name of its function."""
        return getitem, (self.registry, self.name)

    def __call__(self, surface: Any, **values: Any) -> Any:
        """Its column on a surface ((V, 3) for a vector), or a dictionary of them if it provides several.

        surface: a Surface, a path, a trimesh.Trimesh or a pair (points, faces). values: of its parameters, in the unit
        of the file. Errors: UsageError for an unknown parameter or a value of another type.
        """
        # scipy, which these import, is not needed to look a quantity up
        from ..loading.load import as_surface
        from ..mesh.scale import EstimatorSettings
        from .engine import evaluate, in_file_unit

        surface = as_surface(surface)
        given = [self._value(key, value, surface) for key, value in values.items()]
        settings = EstimatorSettings(values=dict(given))
        names = [quantity.name for quantity in self.provides]
        columns = evaluate(self.registry or passes, surface, names, settings=settings)
        shown = {q.name: in_file_unit(q, columns[q.name], surface) for q in self.provides}
        return shown[self.provides[0].name] if len(shown) == 1 else shown

    def _value(self, key: str, value: Any, surface: Any) -> tuple[str, Any]:
        """The full name and the value of a parameter; an array has one for each face."""
        known = {setting.name: setting for setting in self.settings}
        if key not in known:
            way_out = suggestion(key, known) if known else "; it has none"
            raise UsageError(f"pass {self.name} has no parameter {key!r}{way_out}")
        if known[key].by_region and getattr(value, "shape", ()) == (surface.n_faces,):
            return known[key].key(self.name), value
        full = known[key].key(self.name)
        return full, known[key].convert(value, full)


class Registry(Mapping[str, Pass]):
    """All passes by name; quantities are looked up with `provider` and `quantity`.

    home: the module that fills the registry at import; another process finds the registry there.
    """

    def __init__(self, home: str = "") -> None:
        self._home = home
        self._passes: dict[str, Pass] = {}
        self._providers: dict[str, Pass] = {}
        self._waiting: list[Pass] | None = None

    def __reduce__(self) -> str | tuple[Any, ...]:
        """Pickle a registry by its home, and one without a home as an object."""
        return (_passes_of, (self._home,)) if self._home else super().__reduce__()

    def __getitem__(self, name: str) -> Pass:
        return self._passes[name]

    def __getattr__(self, name: str) -> Pass:
        # No pass has a name that starts with an underscore; a copy in the making has no passes yet.
        if name.startswith("_") or name not in self._passes:
            raise AttributeError(name)
        return self._passes[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._passes)

    def __len__(self) -> int:
        return len(self._passes)

    def add(self, new: Pass) -> Pass:
        """Register a pass and return it as registered.

        Its needs must be known and its columns new, so that a misspelling fails at import. Errors: UsageError.
        """
        for need in self._unknown(new):
            if self._waiting is not None:
                self._waiting.append(new)
                return new
            way_out = suggestion(need, [*self._providers, *NO_QUANTITIES, CELL_AREA])
            raise UsageError(f"pass {new.name} needs {need}, which no pass provides{way_out}")
        apart = {need for need in new.needs if need == SURFACE or need in PARAMETERS}
        apart |= {need for need in new.needs if need in self._providers and self.quantity(need).on != "vertex"}
        apart |= {setting.name for setting in new.settings if setting.by_region}
        if new.pointwise and apart:
            raise UsageError(
                f"pass {new.name} looks at one vertex at a time and needs {', '.join(sorted(apart))}, "
                f"expected columns of vertices, {CELL_AREA}, {' or '.join(MASKS)}"
            )
        names = [quantity.name for quantity in new.provides]
        for name in names:
            if name in self._providers or names.count(name) > 1:
                raise UsageError(f"pass {new.name} provides {name}, which exists already")
        if new.name in self._passes:
            raise UsageError(f"a pass {new.name} exists already")
        provides = tuple(self._settled(quantity, new.needs) for quantity in new.provides)
        new = replace(new, provides=provides, registry=self)
        self._passes[new.name] = new
        self._providers.update({quantity.name: new for quantity in new.provides})
        return new

    def _unknown(self, new: Pass) -> list[str]:
        """The needs of a pass that no registered pass provides."""
        return [need for need in new.needs if need not in self._providers and need not in (*NO_QUANTITIES, CELL_AREA)]

    @contextmanager
    def in_any_order(self) -> Iterator[None]:
        """Within it, a pass may be added before those that it needs. Errors at the end: UsageError, as of `add`."""
        self._waiting = []
        try:
            yield
            todo = self._waiting
        finally:
            self._waiting = None
        while todo:
            # Where none is ready, the first one fails.
            ready = [new for new in todo if not self._unknown(new)] or todo
            for new in ready:
                self.add(new)
            todo = [new for new in todo if new.name not in self._passes]

    def _settled(self, quantity: Quantity, needs: tuple[str, ...]) -> Quantity:
        """The quantity with `rooted` set, inherited from its needs if None."""
        if quantity.rooted is not None:
            return quantity
        return replace(quantity, rooted=any(self.quantity(need).rooted for need in needs if need in self._providers))

    def provider(self, quantity: str) -> Pass:
        """The pass that provides a quantity."""
        return self._providers[quantity]

    def quantity(self, name: str) -> Quantity:
        """The declaration of a quantity, also of one at a scale."""
        base, _, scale = name.partition(AT_SCALE)
        quantity = next(provided for provided in self._providers[base].provides if provided.name == base)
        if not scale:
            return quantity
        total = f"{quantity.total}_{scale}" if quantity.total else None
        return replace(quantity, name=name, column=f"{quantity.stem}_{scale}", total=total)

    def depends_on_scale(self, name: str) -> bool:
        """Test whether a quantity, or one that it needs, uses neighbourhoods."""
        needs = self._providers[name].needs
        return "scale" in needs or any(self.depends_on_scale(need) for need in needs if need in self._providers)

    def looks_around(self, name: str) -> bool:
        """Test for a quantity of vertices, perhaps at a scale, that depends on neighbourhoods."""
        base = name.partition(AT_SCALE)[0]
        return self.depends_on_scale(base) and self.quantity(base).on == "vertex"

    def quantities(self, on: Element | None = None, public: bool = True) -> list[Quantity]:
        """Quantities in the order of the tables, vertices first; others follow in the order of declaration."""
        elements = get_args(Element) if on is None else (on,)
        placed = topological_order(self._declared(), lambda quantity: quantity.name, lambda quantity: quantity.after)
        return [
            quantity
            for element in elements
            for quantity in placed
            if quantity.on == element and (quantity.public or not public)
        ]

    def totals(self) -> list[Quantity]:
        """Quantities with a total, in the order of the report."""
        declared = (quantity for quantity in self._declared() if quantity.total)
        return topological_order(declared, lambda quantity: quantity.total or "", lambda quantity: quantity.total_after)

    def flags(self) -> list[Quantity]:
        """Hidden flags with a notice, in the order of the notices."""
        noticed = [(quantity, quantity.notice) for quantity in self._declared() if quantity.notice]
        return [
            quantity
            for quantity, _ in topological_order(noticed, lambda pair: pair[1].code, lambda pair: pair[1].after)
        ]

    def column(self, name: str, on: Element = "vertex") -> Quantity | None:
        """The quantity of a column of a table, also at a scale (`K_fit_2e`); None for other columns."""
        result: Quantity | None = None
        for quantity in self._declared():
            if quantity.on == on and quantity.public:
                if name in quantity.columns:
                    return quantity
                start, scale = f"{quantity.stem}_", name[:-2] if quantity.vector else name
                if (
                    scale.startswith(start)
                    and _SCALE.fullmatch(scale[len(start) :])
                    and self.depends_on_scale(quantity.name)
                ):
                    result = quantity
        return result

    def _declared(self) -> Iterator[Quantity]:
        return (quantity for registered in self._passes.values() for quantity in registered.provides)


def _passes_of(home: str) -> Registry:
    """The registry of a module, filled."""
    result: Registry = import_module(home).loaded()
    return result


passes = Registry("curvcli.curvatures.catalogue")


def curvature_pass(
    provides: tuple[Quantity, ...] = (),
    *,
    pointwise: bool = False,
    settings: Mapping[str, Setting] | None = None,
    of_faces: Callable[..., tuple[Any, Any]] | None = None,
    **declaration: Any,
) -> Callable[[Callable[..., Any]], Pass]:
    """Register a function as a pass.

    Without `provides`, the function's name is its one quantity and the keywords are the fields of `Quantity`; with it,
    the function returns a tuple of arrays in that order. `pointwise`, `of_faces`: see `Pass`. Parameters
    of the function that have a default are its settings; `settings` describes them by name.
    """

    def register(function: Callable[..., Any]) -> Pass:
        name = function.__name__
        text = inspect.cleandoc(function.__doc__ or "")
        quantities = provides or (Quantity(name, **declaration),)
        quantities = tuple(q if q.description else replace(q, description=text) for q in quantities)
        needs, described = split_signature(function, settings or {})
        new = Pass(name, function, quantities, needs, pointwise, described, of_faces)
        return passes.add(new)

    return register
