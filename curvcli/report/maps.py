"""What is told of a map between two surfaces: as JSON and as a summary for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from rich.table import Table

from .._version import __version__
from ..analysis.configuration import Configured, configured
from ..support.arrays import or_none
from .model import CheckRow, Input, Remark, input_of, remarks
from .terminal.console import MARKS, escape, report_console, show_configuration
from .terminal.fitting import fitting, with_sentences

if TYPE_CHECKING:
    from ..analysis.maps import SurfaceMap


class Range(msgspec.Struct):
    """Smallest and largest value of a column, null where it has none, and how many are null."""

    min: float | None
    max: float | None
    nulls: int


class Turned(msgspec.Struct):
    """How many faces keep the way up of most of their patch, are turned over, and are neither: see `orientation`."""

    kept: int
    turned_over: int
    undefined: int


class Harmonic(msgspec.Struct):
    """The largest |∇_p E(f)| off the boundary, its vertex, and what rounding alone can make of it there."""

    residual_max: float | None
    vertex: int | None
    rounding: float | None


class MapReport(msgspec.Struct):
    """The report of `curvcli compare --map`; what is undefined is null.

    seams: edges along which a texture is cut, null for a map to another mesh.
    """

    schema_version: int
    curvcli: str
    source: Input
    image: Input
    seams: int | None
    totals: dict[str, float | None]
    sigma_1: Range
    sigma_2: Range
    nonconformality: Range
    area_distortion: Range
    orientation: Turned
    harmonic: Harmonic
    checks: list[CheckRow]
    warnings: list[Remark]
    configuration: Configured = msgspec.UNSET


def model(f: SurfaceMap) -> MapReport:
    """The report of a map."""
    residual, vertex, rounding = f.harmonic
    notices = [*f.source.notices, *f.image.notices, *f.notices]
    image = input_of(f.image.file, f.image.n_vertices, f.image.n_faces)
    if f.image_name is not None:
        image.path = f.image_name
    return MapReport(
        schema_version=1,
        curvcli=__version__,
        source=input_of(f.source.file, f.source_vertices, f.source.n_faces),
        image=image,
        seams=f.seams,
        totals={name: or_none(value) for name, value in f.totals.items()},
        sigma_1=_range(f.sigma_1),
        sigma_2=_range(f.sigma_2),
        nonconformality=_range(f.nonconformality),
        area_distortion=_range(f.area_distortion),
        orientation=_turned(f.orientation),
        harmonic=Harmonic(or_none(residual), vertex, or_none(rounding)),
        checks=[CheckRow(**vars(check)) for check in f.checks],
        warnings=remarks(notices),
        configuration=configured(f.configuration),
    )


def build(f: SurfaceMap) -> dict[str, Any]:
    """The report of a map as plain Python values."""
    found: dict[str, Any] = msgspec.to_builtins(model(f))
    return found


def show(f: SurfaceMap) -> None:
    """Print the summary of a map to stdout; rich where it is a terminal, plain text in a pipe."""
    report = model(f)
    console = report_console(100)
    names = (escape(side.path or "arrays in memory") for side in (report.source, report.image))
    console.print(f"[bold]{' → '.join(names)}[/bold]  V {f.source_vertices:,}  F {f.source.n_faces:,}")
    for remark in report.warnings:
        console.print(f"[yellow]warning[/yellow] {remark.code}: {remark.count:,} {escape(remark.message)}")
    show_configuration(console, report.configuration)
    console.print(fitting(console, _quantities(report)))
    rows = [
        (
            (row.name, MARKS[row.status], _text(row.residual, 2), _text(row.tolerance, 2)),
            escape(row.detail),
            row.status != "pass",
        )
        for row in report.checks
    ]
    console.print(fitting(console, with_sentences(("check", "status", "residual", "allowed"), (), "detail", rows)))


def _quantities(report: MapReport) -> Iterator[Table]:
    totals, harmonic = report.totals, report.harmonic
    rows = (
        ("dirichlet", _text(totals["dirichlet"]), "E(f) = ½ Σ |∇f|² area"),
        ("area", _text(totals["area"]), "area of the source"),
        ("image_area", _text(totals["image_area"]), "area of the image"),
        ("nonconformality", _text(totals["nonconformality"]), "E(f) − area f(M) = Σ ½ (σ₁ − σ₂)² area; 0 if conformal"),
        ("sigma_1", _between(report.sigma_1), "larger singular value per face"),
        ("sigma_2", _between(report.sigma_2), "smaller singular value per face, without sign"),
        ("area_distortion", _between(report.area_distortion), "area of the image per area, σ₁ σ₂"),
        ("orientation", f"{report.orientation.turned_over:,}", "faces that are turned over"),
        ("harmonic", _text(harmonic.residual_max), _where(harmonic)),
    )
    return with_sentences(
        ("quantity", "value"), (), "what it is", [((name, value), meaning, True) for name, value, meaning in rows]
    )


def _where(harmonic: Harmonic) -> str:
    if harmonic.vertex is None:
        return "max |∇_p E(f)|: no vertex off the boundary"
    return f"max |∇_p E(f)|, at vertex {harmonic.vertex}; rounding explains {_text(harmonic.rounding, 2)}"


def _turned(sign: np.typing.NDArray[np.float64]) -> Turned:
    return Turned(*(int(np.count_nonzero(mask)) for mask in (sign > 0, sign < 0, np.isnan(sign))))


def _range(values: np.typing.NDArray[np.float64]) -> Range:
    known = values[~np.isnan(values)]
    nulls = len(values) - len(known)
    return Range(float(known.min()), float(known.max()), nulls) if len(known) else Range(None, None, nulls)


def _between(values: Range) -> str:
    return f"{_text(values.min)} … {_text(values.max)}" + (f", {values.nulls:,} undefined" if values.nulls else "")


def _text(value: float | None, digits: int = 12) -> str:
    return "undefined" if value is None else f"{value:.{digits}g}"
