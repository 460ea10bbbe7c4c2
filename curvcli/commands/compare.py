"""`curvcli compare`: compare two meshes or reports; with --map, measure the map between two surfaces."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from ..errors import FAILED_CHECK, OK
from ..loading.limits import parse_weld
from . import candidates, options
from .config_notes import configuration
from .groups import GROUP_OPTIONS, are_groups, group_options
from .limits import bounded
from .meshes import input_of
from .outputs import one_stdout, print_report, tables_and_reports
from .settings import merge_settings, setting

if TYPE_CHECKING:
    from ..analysis.maps import SurfaceMap

TABLES = ("vertices", "faces")
# B of --map: the texture coordinates of A.
TEXTURE = "uv"
_SETTINGS = ("parameters", "spontaneous_curvature", "bending_rigidity")
# Options that need --map, and options that exclude it.
_DIFFERENCES = (
    *("rtol", "atol", "only", "ignore", "common", "passes", "area", "mean", "orient", "unit", "regions"),
    *("rings", "radius", "normals", "noise", "exact", *_SETTINGS),
)
_MAP = ("tables",)
_CONVENTIONS = (
    *("passes", "area", "mean", "orient", "weld", "unit", "regions", "rings", "radius", "normals", "noise", "rtol"),
    *_SETTINGS,
)


@click.command("compare", short_help="Compare two meshes, reports or groups of reports; --map: measure a map.")
@click.argument("a", metavar="A")
@click.argument("b", metavar="B")
@click.option(
    "--rtol",
    type=options.Finite(0),
    default=1e-9,
    show_default=True,
    help="Relative tolerance; 0: equal to the last bit.",
)
@click.option("--atol", type=options.Finite(0), default=0.0, show_default=True, help="Absolute tolerance.")
@click.option(
    "--only", metavar="KEY", multiple=True, help="Compare only these keys, such as totals or 'columns.K*'; repeatable."
)
@click.option("--ignore", metavar="KEY", multiple=True, help="Skip these keys, such as 'warnings.*'; repeatable.")
@click.option(
    "--common",
    is_flag=True,
    help="Compare only keys that both have; otherwise a missing key is a difference.",
)
@click.option(
    "--exact", is_flag=True, help="B is a table of exact values: print error norms. Tables of `sample` imply it."
)
@click.option(
    "--map", "as_map", is_flag=True, help="Measure A → B, or A to its texture (B = uv), as a map on the same faces."
)
@click.option(
    "-o",
    "--output",
    "outputs",
    metavar="PATH",
    multiple=True,
    help="Write .csv .tsv .parquet .npz (the differences; with --map the vertex table) or .json (report); repeatable. "
    "`-` is stdout.",
)
@click.option(
    "--table",
    "tables",
    metavar="KIND=PATH",
    shell_complete=candidates.tables(lambda: TABLES),
    multiple=True,
    help="With --map: write a table, KIND faces (singular values, orientation) or vertices (harmonic residual); "
    "repeatable.",
)
@click.option(
    "--vertexwise",
    is_flag=True,
    help="A and B are groups of meshes with the same faces: mean, difference, t, p and q at every vertex.",
)
@group_options
@options.as_json
@options.get("totals.nonconformality")
@options.stream_format
@options.precision
@options.passes
@options.regions
@options.estimating
@setting
@options.reading
@options.force
@options.schema
@options.talking
@bounded
def command(a: str, b: str, as_map: bool, **settings: Any) -> int:
    """Compare A with B beyond tolerance: topology, totals, checks, columns. Exits with 1 if anything differs.

    A and B are meshes, reports (.json) or vertex tables (.csv .tsv .parquet .jsonl) of `curvcli analyze`. A mesh
    is analysed with the passes and conventions of the report or table on the other side, unless you give
    them: a stored report guards a mesh in CI. Two meshes with equally many vertices are also compared
    vertex by vertex.

    A value differs if its change exceeds atol + rtol · its size and a bound on the rounding error. For
    values that can cancel, size means the size of their terms.

    A mesh against a table of exact values (of `curvcli sample NAME -o MESH.ply -o EXACT.csv`, or any with
    --exact): error norms of every column that has one, weighted by area; K_* are set against K_density,
    h_* against h_signed, kappa_1_* and kappa_2_* against kappa_1 and kappa_2. With --rtol, exits with 1
    if a relative L2 error is above it.

    With --map: the map that sends each vertex of A to the vertex of the same index of B, linear on faces.
    The report has its Dirichlet energy, the area of its image, its non-conformality (0 for conformal maps),
    the singular values σ₁ ≥ σ₂ ≥ 0 on every face, and its distance from harmonic. A and B must have the same
    faces. Flipped faces are counted: into a plane by the sign of det df, in space against their neighbours.
    With B = uv, the map goes to A's own texture coordinates: A is cut open along the seams of its texture,
    which are counted, and the energy is the sum over the faces. Exits with 1 when an identity fails.

    Two groups: A and B are folders with reports (.json), patterns in quotes, or folders of `curvcli batch` (with
    --save json or --long). Every total, and the area-weighted mean of every column, of the whole and of each
    region, is tested for a difference of the means of the groups: Welch's t or permutations, with a confidence
    interval of B − A, Hedges' g, the number of missing values, and a correction for the number of tests. Numbers
    that differ by rounding only are not tested. The exit code is 0, with --strict 1 if a difference is significant.

    With --vertexwise: A and B are folders or patterns of meshes that all have the same faces. -o writes a table or a
    mesh with the mean shape of A: for each column of -p (K_density, h_signed) the mean of A and of B, the difference,
    Welch's t, p, q over all vertices, and the numbers of values. One mesh at a time is in memory.

    \b
      curvcli compare bunny.obj bunny.json
      curvcli compare old.ply new.ply --rtol 1e-6 --ignore vertices
      curvcli compare bunny.obj bunny.json --only totals --only checks
      curvcli compare torus.ply exact.csv --rings 3
      curvcli compare controls/ patients/ -o differences.csv -o differences.pdf
      curvcli compare 'out/control*.json' 'out/patient*.json' --test permutation
      curvcli compare 'a/*.ply' 'b/*.ply' --vertexwise -p h_signed -o map.ply
      curvcli compare mesh.obj flattened.obj --map
      curvcli compare mesh.obj --map uv
      curvcli compare mesh.obj flattened.obj --map --get totals.nonconformality
      curvcli compare mesh.obj flattened.obj --map --table faces=distortion.csv
    """
    context = click.get_current_context()
    for name in _DIFFERENCES if as_map else _MAP:
        if name in settings and context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            flag = next(p for p in context.command.params if p.name == name).opts[-1]
            raise click.UsageError(f"{flag} goes {'without' if as_map else 'with'} --map", context)
    if settings.pop("vertexwise"):
        return _compare_vertices(context, a, b, as_map, settings)
    if are_groups(a, b):
        return _compare_groups(context, a, b, as_map, settings)
    for name in GROUP_OPTIONS:
        if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            flag = next(p for p in context.command.params if p.name == name).opts[-1]
            raise click.UsageError(f"{flag} goes with two groups of reports: folders, or patterns in quotes", context)
        del settings[name]
    if a == "-" == b:
        raise click.UsageError("A and B cannot both be stdin; give one of them a path", context)
    if not as_map:
        from .compare_values import compare

        given = {name for name in _CONVENTIONS if context.get_parameter_source(name) is not ParameterSource.DEFAULT}
        del settings["tables"]
        return compare(a, b, given=given, **settings)
    return compare_map(a, b, **{name: value for name, value in settings.items() if name not in _DIFFERENCES})


def _compare_vertices(context: click.Context, a: str, b: str, as_map: bool, settings: dict[str, Any]) -> int:
    from .vertexwise import REFUSED, compare_vertices

    for name in REFUSED:
        if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            flag = next(p for p in context.command.params if p.name == name).opts[-1]
            raise click.UsageError(f"{flag} goes without --vertexwise", context)
    merge_settings(settings)
    return compare_vertices(a, b, **{name: value for name, value in settings.items() if name not in REFUSED})


def _compare_groups(context: click.Context, a: str, b: str, as_map: bool, settings: dict[str, Any]) -> int:
    from ..report.groups.means import TestOptions
    from .groups import USED, compare_groups

    for name in (*settings, "as_map"):
        if name not in USED and context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            flag = next(p for p in context.command.params if p.name == name).opts[-1]
            raise click.UsageError(f"{flag} goes without groups of reports, which are not analysed again", context)
    test = TestOptions(**{name: settings[name] for name in ("test", "alpha", "correction", "resamples", "seed")})
    return compare_groups(a, b, test=test, **{name: settings[name] for name in USED if name not in vars(test)})


def compare_map(
    a: str,
    b: str,
    *,
    outputs: tuple[str, ...],
    tables: tuple[str, ...],
    as_json: bool,
    get: tuple[str, ...],
    stream_format: str | None,
    precision: str,
    weld: str,
    force: bool,
    quiet: bool,
    verbose: int,
    **limits: Any,
) -> int:
    """Check the options, read both surfaces, measure the map A → B, write and print it; return the exit code."""
    from ..output.atomic import Outputs
    from ..output.tables.write import parse_precision
    from ..report.maps import build
    from ..report.terminal.maps import show

    specs = tables_and_reports(outputs, tables, TABLES, stream_format)
    to_stdout = one_stdout([spec.path for spec in specs], as_json, get, stream_format)
    parse_precision(precision)
    welding = parse_weld(weld)

    # Outputs are checked before the first surface is read.
    with Outputs([spec.path for spec in specs], force) as files:
        surface_map = _read(a, b, welding, quiet, limits)
        surface_map.configuration = configuration()
        for spec in specs:
            with files.open(spec.path) as stream:
                _write(stream, surface_map, spec.kind, spec.suffix, precision)
        print_report(partial(build, surface_map), partial(show, surface_map), as_json, get, quiet or to_stdout)
    return FAILED_CHECK if any(check.status == "fail" for check in surface_map.checks) else OK


def _read(a: str, b: str, weld: str | float, quiet: bool, limits: dict[str, Any]) -> SurfaceMap:
    from ..analysis.maps import SurfaceMap
    from ..analysis.texture import TextureMap
    from ..loading.load import load
    from .progress import phase

    texture, surfaces = b == TEXTURE, []
    for path in (a,) if texture else (a, b):
        with phase(f"reading {path}", quiet):
            surfaces.append(load(input_of(path), weld=weld, texture=texture, **limits))
    with phase("computing", quiet):
        surface_map = TextureMap(*surfaces) if texture else SurfaceMap(*surfaces)
        _ = surface_map.checks
    return surface_map


def _write(stream: Any, surface_map: SurfaceMap, kind: str, suffix: str, precision: str) -> None:
    from ..output.tables.write import write_table
    from ..report.maps import build
    from ..report.model import encode

    if kind == "report":
        stream.write(encode(build(surface_map)))
    else:
        table = surface_map.vertex_table() if kind == "vertices" else surface_map.face_table()
        write_table(stream, table, suffix, precision=precision)
