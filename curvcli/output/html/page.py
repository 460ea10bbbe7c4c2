"""Page: report and surface through one template, within a limit on its size."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from ...analysis.configuration import sentence
from ...checks.catalogue import identities
from ...report.build import model
from ...report.conclusion import conclusion, holds
from ...report.phrases import RESULTS, SHOWN_ROWS, conventions, listed, number, shape, verdict
from ...report.quantities import unmarked
from ...support.words import escape_text
from ..pictures.camera import frame
from ..pictures.options import VIEWS, PictureOptions, parse_view
from .columns import PageColumn, columns, hex_color
from .display import Display, simplified, whole
from .edges import bend, cell, in_cells
from .packing import differences, packed, scaled, steps
from .three_js import engine

if TYPE_CHECKING:
    from jinja2 import Template

    from ...analysis.result import Result
    from ..appearance import Appearance

# Limit of 15 MB for the page; everything but the surface is well below 2 MB.
SURFACE_BYTES = 12_500_000
# A screen shows no more vertices, and a telephone has to turn them.
MOST_VERTICES = 200_000


def page(analysis: Result, appearance: Appearance, colored: tuple[str, ...], command: str | None) -> bytes:
    """Page of an analysis. colored: the columns asked for; the first is shown first.
    command: the shell command that made it.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    def finalize(value: Any) -> Any:
        return escape_text(value) if isinstance(value, str) and not hasattr(value, "__html__") else value

    templates = Environment(
        loader=PackageLoader("curvcli.output.html"),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=finalize,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters |= {"number": number, "hex": hex_color, "exact": _exact, "coded": _coded, "unmarked": unmarked}
    source: Callable[[str], str] = lambda name: templates.loader.get_source(templates, name)[0]  # type: ignore[union-attr]  # noqa: E731
    chosen = columns(analysis, appearance, colored)
    display, blocks = _fitted(analysis, chosen)
    lines = bend(analysis, appearance, colored, display)
    shades = [] if lines is None else lines.shades
    if lines is not None and shades:
        blocks["bend"] = packed(steps(lines.pairs))
    code = "".join(source(name) for name in ("data.js", "scene.js", "page.js"))
    scripts = [engine(), f'(async () => {{\n"use strict";\n{code}}})();\n']
    style = source("style.css")
    report = model(analysis)
    pieces = {name: getattr(report, name) for name in ("components", "loops", "regions")}
    first = {name: rows[:SHOWN_ROWS] for name, rows in pieces.items()}
    facts = msgspec.to_builtins(msgspec.structs.replace(report, **first))
    text = _rendered(
        templates.get_template("page.html"),
        report=facts,
        title={None: "arrays in memory", "-": "stdin"}.get(report.input.path, report.input.path),
        verdict=verdict(report),
        holds=holds(report),
        proof=conclusion(report),
        configuration=sentence(report.configuration),
        shape=shape(report.topology),
        conventions=conventions(report),
        checks=listed(report.checks),
        more_checks=len(report.checks) - len(listed(report.checks)),
        results=RESULTS,
        rules=identities(),
        counts={name: len(rows) for name, rows in pieces.items()},
        totals=_totals(),
        columns=chosen,
        units={column.name: column.unit for column in chosen},
        gradients={column.scale.cmap: column.scale.gradient for column in chosen},
        first=_first(chosen, colored),
        display=display,
        bend=lines,
        surface=analysis.surface,
        data=_data(analysis, appearance, display, chosen, blocks.pop("meta")) | {"bend": shades},
        blocks={name: Markup(text) for name, text in blocks.items()},
        command=command,
        style=Markup(style),
        scripts=[Markup(script) for script in scripts],
        policy=_policy(style, scripts),
    )
    return text.encode("utf-8")


def _rendered(template: Template, **values: Any) -> str:
    """Text of a template; its macros and its context refer to each other, so that the context is emptied."""
    context = template.new_context(values)
    try:
        return "".join(template.root_render_func(context))
    finally:
        context.parent.clear()
        context.vars.clear()


def _first(shown: list[PageColumn], colored: tuple[str, ...]) -> str | None:
    names = [column.name for column in shown]
    return next((name for name in (*colored, *names) if name in names), None)


def _totals() -> dict[str, Any]:
    """Quantity that each total sums."""
    from ...curvatures.registry import passes

    return {quantity.total or "": quantity for quantity in passes.totals()}


def _policy(style: str, scripts: list[str]) -> str:
    """Content security policy: only the scripts and styles of the page, and no network access.

    'unsafe-eval' is for programs that drive browsers: they evaluate text to wait for conditions; the page does not.
    """
    allowed = " ".join([*map(_digest, scripts), "'unsafe-eval'"])
    return (
        f"default-src 'none'; script-src {allowed}; style-src {_digest(style)}; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def _digest(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode('utf-8')).digest()).decode('ascii')}'"


def _exact(value: Any) -> str:
    """Number for other programs: the shortest text that reads back to the same double, empty where undefined."""
    if isinstance(value, list):
        return " ".join(map(_exact, value))
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def _coded(text: str) -> Any:
    """Text with the parts between backticks as code."""
    from markupsafe import Markup

    segments = escape_text(text).split("`")
    if len(segments) % 2 == 0:
        return text
    return Markup("").join(Markup("<code>{}</code>").format(part) if k % 2 else part for k, part in enumerate(segments))


def _fitted(analysis: Result, shown: list[PageColumn]) -> tuple[Display, dict[str, Any]]:
    """Surface, simplified to the limit of the page, and its blocks of data."""
    surface = analysis.surface
    # Deflated and in base64 a float takes about 4.4 bytes, the two faces of a vertex about 14.
    per_vertex = 4.4 * (len(shown) + 3) + 22
    most = min(MOST_VERTICES, int(SURFACE_BYTES / per_vertex))
    used = int(np.count_nonzero(surface.referenced))
    display = whole(surface) if used <= most and surface.n_faces <= 4 * most else simplified(surface, most)
    while True:
        blocks = _blocks(analysis, display, shown)
        size = sum(len(text) for name, text in blocks.items() if name != "meta")
        if size <= SURFACE_BYTES:
            return display, blocks
        most = int(min(most, len(display.vertices)) * 0.95 * SURFACE_BYTES / size)
        display = simplified(surface, most)


def _blocks(analysis: Result, display: Display, shown: list[PageColumn]) -> dict[str, Any]:
    """Data of the page by name; `meta` has the encoding of numbers."""
    vertices = display.vertices
    meta: dict[str, Any] = {"columns": {}}
    axes = [scaled(axis[vertices]) for axis in analysis.surface.xyz_given]
    meta["axes"] = [{"exponent": axis.exponent} for axis in axes]
    rests = [axis.rest for axis in axes if axis.rest is not None]
    if rests:
        rests = [np.zeros_like(axis.values) if axis.rest is None else axis.rest for axis in axes]
    blocks: dict[str, Any] = {
        "positions": packed(np.stack([*(axis.values for axis in axes), *rests], axis=1)),
        "vertices": packed(differences(vertices)),
        "faces": packed(steps(display.faces)),
        "boundary": packed(steps(display.boundary)),
        "crowded": packed(steps(display.crowded)),
        "normals": packed(_normals(analysis, display)),
    }
    if "status" in analysis.vertices:
        codes = analysis.columns["status"][vertices].astype(np.uint8)
        blocks["status"] = packed(codes)
    for index, column in enumerate(shown):
        numbers = scaled(column.values[vertices])
        meta["columns"][column.name] = {"exponent": numbers.exponent}
        blocks[f"column-{index}"] = packed(numbers.columns)
        if column.scale.rounded is not None:
            blocks[f"rounded-{index}"] = packed(column.scale.rounded[vertices].astype(np.uint8))
    return {**blocks, "meta": meta}


def _normals(analysis: Result, display: Display) -> Any:
    """(n, 3) int8: unit normals of the full surface for its shading, 0 where it has none."""
    normals = analysis.columns["star_vector"][:, display.vertices]
    if not analysis.surface.orientable:
        return np.zeros((len(display.vertices), 3), np.int8)
    largest = np.abs(normals).max(axis=0)
    unit = normals / np.where(largest > 0, largest, 1.0)
    size = np.sqrt((unit * unit).sum(axis=0))
    return np.nan_to_num(np.rint(127 * unit / np.where(size > 0, size, 1.0))).astype(np.int8).T


def _camera(picture: PictureOptions) -> list[list[float]]:
    """First direction of view and the axis that points up; `fit` is for pictures."""
    angles = parse_view(picture.view) or VIEWS["iso"]
    _, above, towards = frame(*angles)
    turned = [[v[0], v[2], -v[1]] if picture.up == "y" else list(v) for v in (towards, above)]
    return [[float(part) for part in vector] for vector in turned]


def _data(
    analysis: Result, appearance: Appearance, display: Display, shown: list[PageColumn], meta: dict[str, Any]
) -> dict[str, Any]:
    """Data for the script of the page."""
    from ...curvatures.registry import passes

    creased = in_cells(analysis, display)
    described = [
        {
            "name": column.name,
            **meta["columns"][column.name],
            "low": column.scale.low,
            "high": column.scale.high,
            "rounded": column.scale.rounded is not None,
            "cells": creased and cell(column.painted),
            "map": column.scale.cmap,
            "undefined": [int(part) for part in column.scale.undefined],
        }
        for column in shown
    ]
    maps = {column.scale.cmap: packed(column.scale.gradient.ravel()) for column in shown}
    labels = passes.quantity("status").labels if "status" in analysis.vertices else ()
    return {
        "columns": described,
        "axes": meta["axes"],
        "maps": maps,
        "status": labels,
        "vertices": len(display.vertices),
        "of": analysis.surface.n_vertices,
        "smooth": len(display.faces) > 5000,
        "view": _camera(appearance.picture),
        "up": appearance.picture.up,
        "edges": appearance.picture.edges,
    }
