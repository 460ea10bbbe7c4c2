"""The Python interface: `load`, `analyze` and their results."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .analysis.request import Request
from .analysis.result import Result, compute
from .curvatures.catalogue import loaded
from .curvatures.registry import Registry
from .curvatures.setting_values import with_spontaneous_curvature
from .loading.load import load
from .mesh.file import Labels
from .mesh.surface import Orient, Surface
from .output.appearance import Appearance
from .output.distributions import samples_of
from .output.tables.columns import HISTOGRAM
from .output.tables.histogram import histogram_table
from .output.write import check_appearance, needs, write_outputs
from .report.build import build

__all__ = ["Analysis", "Registry", "Surface", "analyze", "load", "loaded"]


class Analysis(Result):
    """The results for one surface: `vertices`, `edges`, `faces`, `totals`, `checks`, `notices`, `report()`.

    Columns are in the file's unit of length and in the chosen convention for H; NaN is undefined.
    """

    def report(self) -> dict[str, Any]:
        """The report of `--json` as plain Python values ready for JSON."""
        return build(self)

    def histogram(
        self, *columns: str, bins: int | None = None, value_range: str | None = None
    ) -> dict[str, NDArray[Any]]:
        """The histogram of one vertex column, or of two against each other: the table of `--table histogram=`.

        bins: within the range, per column. value_range: `LO:HI` or `pNN`, as `--range`. Keys are the columns of the
        table: `column`, `part`, `low`, `high`, `vertices`, `area`, `vertex_share`, `area_share`; undefined is NaN.
        Errors: UsageError for an unknown column, labels against a column, or an invalid range.
        """
        appearance = Appearance(histograms=(columns,), bins=bins, value_range=value_range)
        check_appearance(appearance, self.chosen)
        self.include(needs((), [HISTOGRAM], appearance, self.chosen))
        table = histogram_table(samples_of(self, appearance), appearance)
        return {name: part.words() if isinstance(part, Labels) else part for name, part in table.items()}

    def write(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Write the vertex table, a coloured mesh, a picture or the report, chosen by the suffix, atomically.

        force: overwrite an existing file. Errors: OutputError for an existing or unwritable path; UsageError for an
        unknown suffix.
        """
        write_outputs(self, [str(path)], force=force)


def analyze(
    surface: Any,
    passes: str | Iterable[str] | None = None,
    *,
    area: Literal["barycentric", "mixed", "voronoi"] = "barycentric",
    mean: Literal["sum", "average"] = "sum",
    orient: Orient | None = None,
    weld: str | float = "auto",
    unit: str | None = None,
    regions: str | os.PathLike[str] | NDArray[np.integer[Any]] | None = None,
    checks: str | Iterable[str] | None = None,
    rings: str | int | Iterable[str | int] | None = None,
    radius: str | float | Iterable[str | float] | None = None,
    normals: Literal["mesh", "file"] = "mesh",
    noise: float | None = None,
    stat: str | Iterable[str] = (),
    settings: Mapping[str, Any] | Iterable[str] | None = None,
    spontaneous_curvature: float | Mapping[str, float] | None = None,
    bending_rigidity: str | None = None,
) -> Analysis:
    """Compute curvatures of a surface, their totals and the identities that they must satisfy.

    surface: a Surface, a path, a binary stream, a mesh of trimesh, pyvista, meshio, open3d, pymeshlab or nibabel, or a
    pair (points (V, 3), faces (F, 3)).
    passes: a preset (`topology`, `core`, `paper`, `estimates`, `folding`, `all`) or names; None is `core`, and
    `estimates` if `rings` or `radius` is given. area: the cell of `K_density`. mean: the convention for H, κ₁ + κ₂
    (`sum`) or half of it (`average`). orient: `file`, or `outward` to turn closed patches that are inside out; None
    keeps the choice of a Surface and is `file` otherwise. weld: the rule for merging vertices of a file, see
    `curvcli.load`. unit: a label for lengths. regions: a label per face or vertex (negative: none), or the name of
    the file, record or property that holds the labels. checks: names of the identities to test; None tests those
    whose quantities the passes provide. rings, radius: the scale of estimates, in rings of edges or as a radius (a
    length, or mean edge
    lengths such as `3e`); several (`2e,4e`, or a list) give one column each. normals: the normals of the corrected
    curvatures, those of the mesh or of the file. noise: the standard deviation of each coordinate, for `K_sigma` and
    `h_sigma`; None is the precision of the coordinates. stat: the statistics of every column for each region and
    component in the report, such as `count,mean,area_mean,p02`; without it, regions have those of the whole surface,
    and components have none. settings: values of the parameters of passes by PASS.NAME, such as `{"helfrich.c0": 0.5}`,
    in the file's unit of length. spontaneous_curvature: the same for `helfrich.c0`; by region, a mapping from its name
    to a value. bending_rigidity: `20kBT` or `8e-20J`, which energies are multiplied by.
    Errors: UsageError for an unknown name or an unsuitable option, InputError for a mesh that is no surface.
    """
    options: dict[str, Any] = {
        "area": area,
        "mean": mean,
        "orient": orient,
        "weld": weld,
        "unit": unit,
        "regions": regions,
        "checks": checks,
        "rings": rings,
        "radius": radius,
        "normals": normals,
        "noise": noise,
        "stat": stat,
        "parameters": with_spontaneous_curvature(settings, spontaneous_curvature),
        "bending_rigidity": bending_rigidity,
    }
    return compute(surface, Request(passes=passes, **options), Analysis)
