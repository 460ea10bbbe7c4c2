"""`curvcli compare --vertexwise`: compare two groups of meshes that share their faces, vertex by vertex."""

from __future__ import annotations

import glob
import os
from functools import partial
from typing import TYPE_CHECKING, Any, BinaryIO

from ..errors import FAILED_CHECK, OK, InputError, NoMatchError, UsageError
from ..loading.limits import parse_weld
from ..support.words import escape_text
from .config_notes import configuration
from .outputs import one_stdout, print_report
from .progress import phase

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..analysis.moments_of_meshes import VertexMoments
    from ..mesh.surface import Surface
    from ..output.registry import Format
    from ..report.groups.means import Correction
    from ..support.arrays import Floats

_DEFAULT = ("K_density", "h_signed")
# Options that other comparisons have alone.
REFUSED = (
    *("rtol", "atol", "only", "ignore", "common", "exact", "as_map", "tables", "regions"),
    *("test", "resamples", "seed", "stat"),
)


def compare_vertices(
    a: str,
    b: str,
    *,
    alpha: float,
    correction: Correction,
    strict: bool,
    outputs: tuple[str, ...],
    as_json: bool,
    get: tuple[str, ...],
    stream_format: str | None,
    precision: str,
    force: bool,
    quiet: bool,
    verbose: int,
    passes: tuple[str, ...],
    input_format: str | None,
    max_faces: int | None,
    max_bytes: int | None,
    **conventions: Any,
) -> int:
    """Read mesh after mesh, test every vertex, write and print; the exit code, 1 with `strict` where one differs.

    Errors: InputError for a mesh with other faces; NoMatchError for a group without meshes; UsageError for a group of
    one mesh or a column that is no number of vertices.
    """
    from ..analysis.configuration import configured
    from ..output.atomic import Outputs
    from ..output.registry import format_of
    from ..output.tables.write import parse_precision
    from ..report.groups import vertexwise
    from ..report.model import as_dict
    from ..report.terminal.vertexwise import show

    formats = [
        format_of(path, name=stream_format if path == "-" else None, kinds=("table", "mesh", "report"))
        for path in outputs
    ]
    to_stdout = one_stdout(outputs, as_json, get, stream_format)
    parse_precision(precision)
    conventions["weld"] = parse_weld(conventions["weld"])
    limits = {"input_format": input_format, "max_faces": max_faces, "max_bytes": max_bytes}
    paths = [_meshes(path) for path in (a, b)]
    for path, meshes in zip((a, b), paths, strict=True):
        if len(meshes) < 2:
            raise UsageError(f"{path}: one mesh, a group needs two or more")
    with Outputs(list(outputs), force) as files:
        reader = _GroupReader(passes or _DEFAULT, conventions, limits, quiet)
        moments = [reader.read(meshes) for meshes in paths]
        columns = vertexwise.vertex_map(moments[0], moments[1], reader.bounds, correction)
        report = vertexwise.build(((a, paths[0]), (b, paths[1])), columns, alpha, correction)
        report.configuration = configured(configuration())
        for path, format in zip(outputs, formats, strict=True):
            with files.open(path) as stream:
                _write(stream, format, reader, moments[0].positions, columns, as_dict(report), precision)
        print_report(partial(as_dict, report), partial(show, report), as_json, get, quiet or to_stdout)
    return FAILED_CHECK if strict and any(each.significant for each in report.vertexwise) else OK


def _meshes(path: str) -> list[str]:
    """Meshes of a folder, or of a pattern, in the order of their names."""
    from ..loading.registry import suffixes

    if os.path.isdir(path):
        names = [os.path.join(path, name) for name in os.listdir(path)]
        endings = tuple(f".{suffix}{packed}" for suffix in suffixes() for packed in ("", ".gz"))
        names = [name for name in names if name.lower().endswith(endings)]
    else:
        names = glob.glob(path, recursive=True)
    files = sorted(name for name in names if os.path.isfile(name))
    if not files:
        raise NoMatchError(f"{escape_text(path)}: no mesh matches; expected a folder, or a pattern in quotes")
    return files


class _GroupReader:
    """Meshes one after the other: their columns, as long as their faces are those of the first."""

    def __init__(
        self, passes: tuple[str, ...], conventions: Mapping[str, Any], limits: Mapping[str, Any], quiet: bool
    ) -> None:
        self.passes, self.conventions, self.limits, self.quiet = passes, conventions, limits, quiet
        self.first: Surface | None = None
        self.bounds: dict[str, float] = {}

    def read(self, meshes: list[str]) -> VertexMoments:
        """The moments of one group."""
        from ..analysis.moments_of_meshes import VertexMoments
        from ..analysis.request import Request
        from ..analysis.result import Result, compute
        from ..loading.load import load

        moments = None
        for path in meshes:
            with phase(f"reading {path}", self.quiet):
                conventions = {key: self.conventions[key] for key in ("weld", "orient", "normals")}
                surface = load(path, **conventions, **self.limits)
                self._check(surface, path)
                result = compute(surface, Request(passes=self.passes, **self.conventions), Result)
            columns = self._columns(result)
            if moments is None:
                moments = VertexMoments(list(columns), surface.n_vertices)
            moments.add(surface.xyz_given.T, columns)
        assert moments is not None
        return moments

    def _check(self, surface: Surface, path: str) -> None:
        import numpy as np

        if self.first is None:
            self.first = surface
        elif surface.n_vertices != self.first.n_vertices or not np.array_equal(surface.faces, self.first.faces):
            first = self.first.file.path if self.first.file is not None else "the first mesh"
            raise InputError(
                f"other faces than {first}; a comparison vertex by vertex needs the same faces in every mesh", path=path
            )

    def _columns(self, result: Any) -> dict[str, Floats]:
        import numpy as np

        from ..curvatures.registry import passes
        from ..output.distributions import vertex_quantities
        from ..report.compare.values import noise_of, power

        numbers = {name: q for name, q in vertex_quantities(result.chosen).items() if not q.labels}
        if not numbers:
            raise UsageError(f"-p {','.join(self.passes)}: no column of numbers of vertices")
        area = float(np.sum(result.column("face_area")))
        edge = power(area / max(1, result.surface.n_faces), 0.5)
        for name, quantity in numbers.items():
            exponent = passes.quantity(quantity.name).length_exponent
            self.bounds[name] = max(self.bounds.get(name, 0.0), noise_of(name, exponent, edge))
        used = result.surface.referenced
        return {name: np.where(used, result.vertices[name].astype(np.float64), np.nan) for name in numbers}


def _write(
    stream: BinaryIO,
    format: Format,
    reader: _GroupReader,
    positions: Floats,
    columns: dict[str, Floats],
    report: dict[str, Any],
    precision: str,
) -> None:
    from ..output.registry import MeshFormat
    from ..output.tables.write import write_table
    from ..report.groups.vertexwise import table
    from ..report.model import encode

    if format.kind == "report":
        stream.write(encode(report))
    elif isinstance(format, MeshFormat):
        from ..output.pictures.colors import colorize

        assert reader.first is not None
        format.require()
        colored = next(name for name in columns if name.endswith("_t"))
        scale = colorize(columns[colored], signed=True)
        format.write(
            stream,
            positions,
            reader.first.faces,
            vertex_colors=scale.rgb,
            vertex_properties=columns if format.properties else {},
            face_properties={},
            comments=[f"curvcli: mean shape of {report['path_a']}; colour: {colored}, NaN is not tested"],
            triangles=reader.first.faces,
            polygons=None,
            active=colored,
        )
    else:
        write_table(stream, table(positions, columns), format.suffix, precision=precision)
