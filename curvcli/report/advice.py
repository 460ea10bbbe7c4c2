"""Choosing a curvature: five sentences and one table, for the terminal and the documentation."""

from __future__ import annotations

SENTENCES = (
    "Use K, H_vec and A for anything you sum (total curvature, forces, energies, regions): their sums are exact on "
    "every mesh.",
    "For the curvature at a point of a smooth surface, on an irregular mesh without noise, use K_fit, h_fit, "
    "kappa_1_fit and kappa_2_fit: they have the smallest errors and converge fastest. On regular grids that are coarse "
    "for the shape, K_density, h and *_corrected have smaller errors; where the mesh folds over, as a cortex does, "
    "fits are empty and *_corrected is defined.",
    "On a noisy mesh, such as a scan, use K_corrected, h_corrected, kappa_1_corrected and kappa_2_corrected at a "
    "radius well above the noise: --radius 2e,4e,8e gives one column for each; trust values on which neighbouring "
    "scales agree.",
    "If the file has good normals, use them with --normals file for the corrected curvatures; --rings 1 is then "
    "enough. With normals of the triangles, one ring is fast but does not converge on bad triangulations.",
    "K_ring and h_ring are the exact measure in a neighbourhood per area, a fact about the mesh; K_density, h and "
    "kappa_1 are the same for a single star. Use them as estimates on regular meshes only.",
)

# Maximum length of a line of text, on any terminal.
WIDEST = 100

# NOTE describes the numbers; docs/accuracy.md has them all, with the commands that measure them.
HEADER = ("columns", "definition", "on the boundary", "error of K", "error of H, noise")
ROWS = (
    ("K, H_vec, A", "measures of a star, exact in sum", "K null, kappa_g", "", ""),
    ("K_density, h", "measures of a star per area", "null", "0.27, 0.55, 0.26", "over 8 (one star)"),
    ("*_ring", "measures of a neighbourhood per area", "null", "0.033, 0.081, 0.042", "0.50, 0.42, 0.61"),
    ("*_corrected", "measures with interpolated normals", "from one side", "0.000, 0.046, 0.020", "0.19, 0.17, 0.25"),
    ("*_fit", "polynomial of least squares", "from one side", "0.000, 0.004, 0.001", "0.39, 0.34, 0.50"),
)
NOTE = (
    "Relative L² errors on 10,000 vertices of a sphere, a torus and an ellipsoid, triangulations of random points, at "
    "the default scale of 2 rings; H with noise of a thousandth of the size. Over 5 rings that noise leaves less: "
    "0.029, 0.032, 0.039 in h_corrected, 0.023, 0.030, 0.034 in h_fit (on regular meshes h_corrected is ahead), and "
    "0.12, 0.12, 0.17 in libigl's principal_curvature. On a regular grid of 504 vertices on "
    "the torus the errors of H without noise are 0.030 in h, 0.015 in h_corrected and 0.075 in h_fit, with 4,000 they "
    "are 0.0036, 0.0008 and 0.0012."
)


def markdown() -> str:
    """Sentences as a list, and the table."""
    lines = [f"{number}. {_marked(sentence)}" for number, sentence in enumerate(SENTENCES, 1)]
    lines += ["", "| " + " | ".join(HEADER) + " |", "|" + "---|" * len(HEADER)]
    lines += ["| " + " | ".join((_marked(row[0]), *row[1:])) + " |" for row in ROWS]
    return "\n".join([*lines, "", _marked(NOTE), ""])


def as_text(terminal: int | None = None) -> str:
    """Sentences and table as text; terminal: its width: a narrow one gets the numbers alone in the table."""
    from textwrap import wrap

    width = min(terminal or WIDEST, WIDEST)
    rows: list[tuple[str, ...]] = [HEADER, *ROWS]
    widths = [max(len(row[k]) for row in rows) for k in range(len(HEADER))]
    if terminal is not None and sum(widths) + 2 * len(widths) - 2 > terminal:
        rows, widths = [(row[0], *row[3:]) for row in rows], [widths[0], *widths[3:]]
    lines = ["# Choosing a curvature", ""]
    for sentence in SENTENCES:
        lines += [*wrap(sentence, width - 2, initial_indent="* ", subsequent_indent="  ", break_on_hyphens=False)]
    lines.append("")
    for row in rows:
        lines.append("  ".join(f"{cell:{space}}" for cell, space in zip(row, widths, strict=True)).rstrip())
    return "\n".join([*lines, "", *wrap(NOTE, width)]) + "\n"


def _marked(text: str) -> str:
    """Names of columns and options as code."""
    import re

    return re.sub(
        r"--[a-z]+(?: (?:file|\d[\de,]*))?|\*_\w+|\bprincipal_curvature\b|\b(?:[KH]_\w+|kappa_\w+|h_\w+)\b|\b[KAh]\b",
        r"`\g<0>`",
        text,
    )
