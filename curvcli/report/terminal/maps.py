"""The summary of a map between two surfaces, for the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.table import Table

from ...support.words import format_rounded
from ..maps import Harmonic, MapReport, Range, model
from .console import MARKS, escape, report_console, show_configuration
from .tables import fitting, with_sentences

if TYPE_CHECKING:
    from ...analysis.maps import SurfaceMap


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
            (row.name, MARKS[row.status], format_rounded(row.residual, 2), format_rounded(row.tolerance, 2)),
            escape(row.detail),
            row.status != "pass",
        )
        for row in report.checks
    ]
    console.print(fitting(console, with_sentences(("check", "status", "residual", "allowed"), (), "detail", rows)))


def _quantities(report: MapReport) -> Iterator[Table]:
    harmonic = report.harmonic
    shown = {key: format_rounded(total, 12) for key, total in report.totals.items()}
    rows = (
        ("dirichlet", shown["dirichlet"], "E(f) = ½ Σ |∇f|² area"),
        ("area", shown["area"], "area of the source"),
        ("image_area", shown["image_area"], "area of the image"),
        (
            "nonconformality",
            shown["nonconformality"],
            "E(f) − area f(M) = Σ ½ (σ₁ − σ₂)² area; 0 if conformal",
        ),
        ("sigma_1", _between(report.sigma_1), "larger singular value per face"),
        ("sigma_2", _between(report.sigma_2), "smaller singular value per face, without sign"),
        ("area_distortion", _between(report.area_distortion), "area of the image per area, σ₁ σ₂"),
        ("orientation", f"{report.orientation.turned_over:,}", "faces that are turned over"),
        ("harmonic", format_rounded(harmonic.residual_max, 12), _where(harmonic)),
    )
    return with_sentences(
        ("quantity", "value"), (), "what it is", [((name, value), meaning, True) for name, value, meaning in rows]
    )


def _where(harmonic: Harmonic) -> str:
    if harmonic.vertex is None:
        return "max |∇_p E(f)|: no vertex off the boundary"
    return f"max |∇_p E(f)|, at vertex {harmonic.vertex}; rounding explains {format_rounded(harmonic.rounding, 2)}"


def _between(values: Range) -> str:
    ends = f"{format_rounded(values.min, 12)} … {format_rounded(values.max, 12)}"
    return f"{ends}, {values.nulls:,} undefined" if values.nulls else ends
