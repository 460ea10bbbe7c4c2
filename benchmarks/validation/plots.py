"""Errors over edge lengths as pictures, one for each surface."""

from __future__ import annotations

from pathlib import Path

from .convergence import ROUNDING, Course

# Rows of a picture; the tables have all rows.
SHOWN = (
    "h_signed",
    "K_density",
    "h_ring",
    "h_corrected",
    "K_corrected",
    "h_fit",
    "K_fit",
    "libigl `principal_curvature`, κ₁",
    "VTK mean, twice",
)


def draw(path: Path, title: str, courses: dict[str, dict[str, Course]]) -> None:
    """Two panels, regular and irregular: root mean square errors, both axes logarithmic; rounding is not drawn."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import NullLocator

    figure = Figure(figsize=(9, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(courses), sharey=True)
    shown = [name for name in SHOWN if all(name in each for each in courses.values())]
    for panel, (triangulation, each) in zip(panels, courses.items(), strict=True):
        begin = float("inf")
        for number, name in enumerate(shown):
            course = each[name]
            style = "o--" if " " in name else "o-"
            if max(course.mean) < ROUNDING:  # an empty line keeps the place in the legend
                panel.loglog([], [], style, color=f"C{number}", markersize=3, label=f"{name}: rounding")
            else:
                begin = min(begin, 0.5 * course.mean[0])
                panel.loglog(course.edge, course.mean, style, color=f"C{number}", markersize=3, label=name)
        edges = each[shown[0]].edge
        panel.loglog(edges, [begin * (edge / edges[0]) ** 2 for edge in edges], "k:", label="second order")
        panel.set_title(f"{title}, {triangulation}", fontsize=10)
        panel.set_xlabel("mean edge length")
        panel.set_xticks(edges, [f"{edge:.2g}" for edge in edges])
        panel.xaxis.set_minor_locator(NullLocator())
        panel.grid(True, which="major", alpha=0.3)
    panels[0].set_ylabel("error / largest curvature")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, [text.replace("`", "") for text in labels], loc="outside right", fontsize=8)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110, metadata={"Software": None})
