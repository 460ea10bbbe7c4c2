"""The measured errors as tables of Markdown and as pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from curvcli.report.compare.exact import ErrorNorms

from .cases import Case

Measured = Mapping[Case, Mapping[str, ErrorNorms]]


def pages(measured: Measured, key: str) -> Iterator[str]:
    """For each surface a table of sizes and one of noise; key: K or h."""
    for surface in dict.fromkeys(case.surface for case in measured):
        of_surface = {case: found for case, found in measured.items() if case.surface == surface}
        yield f"#### {surface}, {'Gauss' if key == 'K' else 'mean'} curvature\n"
        clean = [case for case in of_surface if not case.noise]
        middle = [case for case in of_surface if case.size == _noisy_size(of_surface)]
        sizes = sorted({case.size for case in clean})
        yield table(
            [f"{size:,}" for size in sizes], _rows(clean, of_surface, key, [("size", s) for s in sizes], len(sizes) > 1)
        )
        noise = sorted({case.noise for case in middle})
        if len(noise) > 1:
            heads = [f"noise {part:g}" for part in noise]
            yield table(heads, _rows(middle, of_surface, key, [("noise", part) for part in noise], False))


def _noisy_size(of_surface: Measured) -> int:
    return next((case.size for case in of_surface if case.noise), -1)


def _rows(
    chosen: Sequence[Case], measured: Measured, key: str, heads: Sequence[tuple[str, float]], order: bool
) -> Iterator[list[str]]:
    for triangulation in dict.fromkeys(case.triangulation for case in chosen):
        cells = [case for case in chosen if case.triangulation == triangulation]
        names = dict.fromkeys(name for case in cells for name in measured[case] if _is_of(name, key))
        for name in names:
            values = []
            for field, wanted in heads:
                case = next((case for case in cells if getattr(case, field) == wanted), None)
                found = measured[case].get(name) if case is not None else None
                values.append(math.nan if found is None else size_of(found))
            yield [triangulation, f"`{name}`", *map(_number, values), *([_order(values, heads)] if order else [])]


def _is_of(name: str, key: str) -> bool:
    return name.startswith(f"{key}_") or name.endswith(f" {key}")


def size_of(found: ErrorNorms) -> float:
    """The relative L² error; where the exact values are zero, the root of the mean square; NaN without any value."""
    known = (found.relative_l2, found.rms, math.nan)
    return next(value for value in known if value is not None)


def _order(values: Sequence[float], heads: Sequence[tuple[str, float]]) -> str:
    """Order of the error in the edge length, between the first and the last size; – for rounding."""
    first, last = values[0], values[-1]
    if not (math.isfinite(first) and math.isfinite(last)) or len(values) < 2 or first < 1e-9 or last <= 0:
        return "–"
    return f"{2 * math.log(first / last) / math.log(heads[-1][1] / heads[0][1]):.1f}"


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.2g}" if value < 1e5 else "> 10⁵"


def table(heads: Sequence[str], rows: Iterator[list[str]]) -> str:
    """Markdown."""
    listed = list(rows)
    width = max((len(row) for row in listed), default=0)
    headers = ["triangulation", "column", *heads, *(["order"] if width > len(heads) + 2 else [])]
    lines = [headers, ["---", "---", *["---:"] * (len(headers) - 2)], *listed]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def draw(folder: Path, measured: Measured) -> list[Path]:
    """One picture for each surface: errors over sizes and over noise, K above h."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    written = []
    for surface in dict.fromkeys(case.surface for case in measured):
        of_surface = {case: found for case, found in measured.items() if case.surface == surface}
        kinds = list(dict.fromkeys(case.triangulation for case in of_surface))
        figure = Figure(figsize=(4.2 * len(kinds), 9), layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplots(3, len(kinds), squeeze=False, sharey="row")
        for column, kind in enumerate(kinds):
            cells = [case for case in of_surface if case.triangulation == kind]
            clean = sorted((case for case in cells if not case.noise), key=lambda case: case.size)
            noisy = sorted((case for case in cells if case.noise), key=lambda case: case.noise)
            for row, (key, chosen, along) in enumerate(
                (("K", clean, "size"), ("h", clean, "size"), ("h", noisy, "noise"))
            ):
                panel = panels[row, column]
                for name in dict.fromkeys(name for case in chosen for name in of_surface[case] if _is_of(name, key)):
                    known = [case for case in chosen if name in of_surface[case]]
                    found = [max(size_of(of_surface[case][name]), 1e-16) for case in known]
                    style = "o--" if " " in name else "o-"
                    panel.loglog([getattr(case, along) for case in known], found, style, markersize=3, label=name)
                panel.set_title(f"{kind}: {key} over {'vertices' if along == 'size' else 'noise'}", fontsize=9)
                panel.grid(alpha=0.3)
        for row in range(3):
            panels[row, 0].set_ylabel("relative L² error")
            panels[row, -1].legend(fontsize=7)
        path = folder / f"{surface}.png"
        figure.savefig(path, dpi=110)
        written.append(path)
    return written
