"""Pages of small meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import curvcli
from curvcli.api import Analysis
from curvcli.output.appearance import Appearance
from curvcli.output.html.page import page
from curvcli.output.registry import output_formats
from curvcli.output.write import needs
from tests.helpers.meshes import Mesh
from tests.output.html.parsed import Page

HOSTILE = """<script>alert("x")</script>'&|</title><img src=x onerror=alert(1)>"""


def written(mesh: Mesh, path: Path) -> Path:
    """The mesh as an OBJ file with every digit."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in mesh.points.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def page_of(analysis: Analysis, command: str | None = "curvcli analyze x.obj", **look: Any) -> bytes:
    appearance = Appearance(**look)
    analysis.include(needs([output_formats()[".html"]], (), appearance, analysis.chosen))
    return page(analysis, appearance, ("K_density",), command)


def parsed(mesh: Any, passes: str = "core", **options: Any) -> tuple[Analysis, Page]:
    analysis = curvcli.analyze(mesh, passes, **options)
    return analysis, Page(page_of(analysis))


def labelled(mesh: Mesh, path: Path, name: str) -> Path:
    """The mesh in two groups, the first with a name of its own."""
    text = written(mesh, path).read_text().splitlines(keepends=True)
    faces = [line for line in text if line.startswith("f")]
    half = len(faces) // 2
    vertices = [line for line in text if line.startswith("v")]
    path.write_text("".join([*vertices, f"g {name}\n", *faces[:half], "g other\n", *faces[half:]]))
    return path


def singles(values: Any) -> Any:
    """As float32, which is what a page holds."""
    return np.asarray(values, np.float64).astype(np.float32)
