"""The vertex-wise comparison of two groups, for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...support.words import counted, format_rounded
from .console import escape, report_console, show_configuration
from .tables import roomy_table

if TYPE_CHECKING:
    from ..groups.vertexwise import VertexwiseReport


def show(report: VertexwiseReport) -> None:
    """Print how many vertices differ, column by column, to stdout."""
    console = report_console(120)
    for name, path, meshes in (("A", report.path_a, report.meshes_a), ("B", report.path_b, report.meshes_b)):
        console.print(f"{name} [bold]{escape(path)}[/bold] ({counted(len(meshes), 'mesh', 'meshes')})")
    show_configuration(console, report.configuration)
    rows = roomy_table("column", "vertices tested", f"q ≤ {report.alpha:g}", "largest t", "at vertex")
    for each in report.vertexwise:
        vertex = "" if each.vertex is None else str(each.vertex)
        rows.add_row(
            escape(each.column), f"{each.tested:,}", f"{each.significant:,}", format_rounded(each.t_max, 4, ""), vertex
        )
    console.print(rows)
    console.print(f"{report.vertices:,} vertices; t: Welch, B − A; q: false discovery rate ({report.correction})")
