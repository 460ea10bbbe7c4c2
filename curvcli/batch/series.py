"""Plots of a batch over its meshes, in the order of the summary: totals, statistics and counts of every frame."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from ..errors import UsageError
from ..output.atomic import Outputs
from ..output.destinations import folded
from ..output.registry import format_of
from ..report.compare.values import total_exponents
from ..report.entries import entries
from ..report.groups.members import key_of
from ..report.model import Topology
from ..support.arrays import Floats
from ..support.words import suggestion
from .model import OWN, BatchItem, Row

DEFAULT_NAME = "series.png"
_SECTIONS = ("totals", "topology", "checks", "columns", "regions")
_OF_LONG = ("columns", "regions")
_WILD = "*?["


@dataclass(frozen=True)
class Plot:
    """Keys of one plot, a panel each, and its file name in the folder of the batch. A key may have wildcards."""

    keys: tuple[str, ...]
    name: str


def parse_plots(texts: Sequence[str], folder: str, items: Sequence[BatchItem], long: bool) -> list[Plot]:
    """Plots from `KEY[,KEY][=NAME]`; a key without a section is a total.

    Errors: UsageError for an unknown total, a key that needs --long, a name that is no picture or is taken.
    """
    paths = {folded(os.path.join(folder, name)) for name in OWN}
    paths |= {folded(path) for item in items for _, path in item.outputs}
    plots = []
    for text in texts:
        listed, _, name = text.partition("=")
        keys = tuple(dict.fromkeys(_key(key.strip(), long) for key in listed.split(",") if key.strip()))
        name = name or DEFAULT_NAME
        if not keys:
            raise UsageError(f"--plot {text}: expected KEY[,KEY][=NAME], such as totals.willmore,totals.area=area.pdf")
        if os.path.basename(name) != name:
            raise UsageError(f"--plot {text}: {name} is a path; the plot is a file in the folder of -o, give its name")
        output = format_of(name, kinds=["picture"])
        if output.suffix.count(".") > 1:
            raise UsageError(f"--plot {text}: expected a name that ends with .png, .pdf or .svg")
        path = folded(os.path.join(folder, name))
        if path in paths:
            raise UsageError(f"--plot {text}: another output has the name {name}; choose another")
        paths.add(path)
        plots.append(Plot(keys, name))
    return plots


def _key(text: str, long: bool) -> str:
    section, _, rest = text.partition(".")
    key = text if section in _SECTIONS and rest else f"totals.{text}"
    section, _, name = key.partition(".")
    if section in _OF_LONG and not long:
        raise UsageError(f"--plot {text}: statistics of {section} are in the rows of --long only; add --long")
    if section == "totals" and not any(sign in name for sign in _WILD):
        known = [*total_exponents(), "K", "area"]
        stem = name[:-2] if name[-2:] in ("_x", "_y", "_z") else name
        if name not in known and stem not in known and "@" not in name and name.rpartition("_")[0] not in known:
            known += [f"topology.{field}" for field in Topology.__struct_fields__]
            near = f"topology.{name}" if name in Topology.__struct_fields__ else name
            raise UsageError(f"--plot {text}: there is no total {name!r}{suggestion(near, known)}")
    return key


def write_plots(folder: str, plots: Sequence[Plot], rows: Sequence[Row]) -> list[str]:
    """Draw the plots of the ended meshes, each whole or not at all; returns a line for each that has no value to draw.

    Errors: OutputError for a folder that cannot be written.
    """
    from ..output.pictures.series import write_series

    values = [_values(row) for row in rows]
    names = [row.path for row in rows]
    notes = []
    for plot in plots:
        panels = {key: _lines(key, values) for key in plot.keys}
        empty = [key for key, lines in panels.items() if not lines]
        notes += [f"{plot.name}: no mesh has {key}" for key in empty]
        drawn = {key: lines for key, lines in panels.items() if lines}
        path = os.path.join(folder, plot.name)
        if drawn:
            with Outputs([path], force=True) as outputs, outputs.open(path) as stream:
                write_series(stream, drawn, names, format_of(plot.name).suffix)
    return notes


def _values(row: Row) -> dict[str, float]:
    """Numbers of one mesh by dotted key."""
    values = {key_of(*entry[:3]): entry.value for entry in entries({"totals": row.totals, "regions": []})}
    values |= {f"topology.{name}": value for name, value in row.topology.items()}
    values |= {f"checks.{name}.residual": check.get("residual") for name, check in row.checks.items()}
    for part in row.statistics:
        for column, statistics in part.columns.items():
            values |= {key_of(part.region, column, name): value for name, value in statistics.items()}
    return {key: float(value) for key, value in values.items() if value is not None}


def _lines(key: str, values: Sequence[Mapping[str, float]]) -> dict[str, Floats]:
    """(n,) values of every key that matches, NaN where a mesh has none."""
    keys: Collection[str] = dict.fromkeys(name for each in values for name in each)
    matching = [key] if key in keys else [name for name in keys if fnmatchcase(name, key)]
    return {name: np.array([each.get(name, np.nan) for each in values], np.float64) for name in matching}
