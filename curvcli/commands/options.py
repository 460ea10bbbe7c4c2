"""Options that several commands share."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from ..loading.registry import input_formats
from . import candidates

if TYPE_CHECKING:
    pass

_CUT = ", ".join(format.title for format in input_formats().values() if format.separate_corners or format.seams)
"""Formats whose files give each triangle corners of its own."""

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class Finite(click.FloatRange):
    """Finite number within bounds; click's own accepts NaN."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number as a float."""
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number.", param, ctx)
        return number


def _verbosity(context: click.Context, option: click.Parameter, value: int) -> int:
    if value and not context.resilient_parsing:
        from .config import META
        from .config_notes import print_configuration

        if META in context.meta:
            print_configuration(context)
    return value


def _schema(context: click.Context, option: click.Parameter, value: bool) -> None:
    if value and not context.resilient_parsing:
        from .schemas import say

        say(context.command.name or "")
        context.exit()


as_json = click.option("--json", "as_json", is_flag=True, help="Print the report as JSON on stdout.")


def get(example: str) -> Decorator:
    """Option `--get`; may be repeated."""
    text = f"Print one value of the report, such as {example}; repeatable, a line for each."
    return click.option("--get", metavar="KEY", multiple=True, help=text)


stream_format = click.option(
    "--format",
    "stream_format",
    metavar="NAME",
    shell_complete=candidates.formats,
    help="Format of `-o -`, such as csv.",
)
precision = click.option(
    "--precision", metavar="shortest|N", default="shortest", show_default=True, help="Significant digits in tables."
)
schema = click.option(
    "--schema",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_schema,
    help="Print the JSON Schema of the JSON output and exit.",
)
quiet = click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
verbose = click.option(
    "-v",
    "--verbose",
    count=True,
    callback=_verbosity,
    help="Print more, e.g. the configuration file used; -vv: tracebacks.",
)
force = click.option("--force", is_flag=True, help="Overwrite outputs that exist.")
passes = click.option(
    "-p",
    "--pass",
    "passes",
    metavar="NAME[,NAME]",
    shell_complete=candidates.passes,
    multiple=True,
    help="Columns to compute, or a preset: topology, core (default), paper, estimates, folding, all. `curvcli passes` "
    "lists them.",
)
area = click.option(
    "--area",
    type=click.Choice(["barycentric", "mixed", "voronoi"]),
    default="barycentric",
    show_default=True,
    help="Vertex area that K_density divides by.",
)
mean = click.option(
    "--mean",
    type=click.Choice(["sum", "average"]),
    default="sum",
    show_default=True,
    help="Convention for H: k1 + k2 (2/r on a sphere) or their average.",
)
orient = click.option(
    "--orient",
    type=click.Choice(["file", "outward"]),
    default="file",
    show_default=True,
    help="Keep the file's orientation, or turn closed patches that are inside out: bodies get a positive volume, "
    "cavities in them a negative one.",
)
weld = click.option(
    "--weld",
    metavar="auto|none|exact|TOL",
    default="auto",
    show_default=True,
    help=f"Merge vertices at equal positions; auto: exact for {_CUT}, else none; TOL: relative to the bounding box.",
)
regions = click.option(
    "--regions",
    metavar="FILE|groups|objects|materials|solids|PROPERTY",
    help="Labels of faces or vertices: totals and checks are also computed per region.",
)

stat = click.option(
    "--stat",
    metavar="NAME[,NAME]",
    multiple=True,
    help="Statistics of every column for each region and component, in their tables and in the report: count, nulls, "
    "mean, std, min, max, absmax, sum, median, percentiles such as p02 or p97.5; area_mean, area_std, area_median and "
    "area_p02 weigh by area.",
)


def _printable(_context: click.Context, _option: click.Parameter, name: str | None) -> str | None:
    if name is not None and not name.isprintable():
        raise click.BadParameter(f"{name!r} has characters that cannot be printed")
    return name


unit = click.option(
    "--unit", metavar="NAME", callback=_printable, help="Name of the unit of length, for tables and legends."
)
input_format = click.option(
    "--input-format",
    metavar="FORMAT",
    type=click.Choice(list(input_formats())),
    help="Format of the input, overriding its suffix; `curvcli help formats` lists them.",
)
max_faces = click.option("--max-faces", type=click.IntRange(1), help="Refuse meshes with more polygons than this.")
max_bytes = click.option("--max-bytes", type=click.IntRange(1), help="Refuse files larger than this, unpacked.")
timeout = click.option(
    "--timeout", metavar="SECONDS", type=Finite(0, 1e9, min_open=True), help="Stop a command that takes longer."
)
max_memory = click.option(
    "--max-memory",
    metavar="MB",
    type=click.IntRange(512, 1 << 40),
    help="Stop a command that needs more memory than this beyond the program itself. Linux only.",
)
strict = click.option("--strict", is_flag=True, help="Exit with 1 when a check fails.")


def together(*options: Decorator) -> Decorator:
    """Several options as one decorator, in the order of the help."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


estimating = together(
    click.option(
        "--rings",
        metavar="N[,N]",
        help="Neighbourhood of estimates (K_ring, K_corrected, K_fit and so on), in rings of edges; several give one "
        "column for each.  [default: 2]",
    ),
    click.option(
        "--radius",
        metavar="R[,R]",
        help="Neighbourhood as a radius: a length, or mean edge lengths such as 3e. With --rings or --radius and "
        "without -p, the preset estimates is added to core.",
    ),
    click.option(
        "--normals",
        type=click.Choice(["mesh", "file"]),
        default="mesh",
        show_default=True,
        help="Normals that corrected curvatures use: of the triangles, or those in the file (nx ny nz, vn).",
    ),
    click.option(
        "--noise",
        type=Finite(0),
        metavar="SIGMA",
        help="Standard deviation of each coordinate, for K_sigma and h_sigma; adds both to core if -p is not "
        "given.  [default: the precision of the file]",
    ),
)
reading = together(area, mean, orient, weld, unit, input_format, max_faces, max_bytes)
talking = together(quiet, verbose)


def chosen(passes: tuple[str, ...], settings: dict[str, Any]) -> tuple[list[str], list[str]]:
    """Columns asked for by -p and the options of `estimating` and `setting`: their names, and the names at each scale.

    Errors: UsageError for an unknown name or an invalid scale.
    """
    from ..curvatures.catalogue import at_scales, defaults, resolve
    from ..curvatures.setting_values import implied
    from ..mesh.scale import DEFAULTS, EstimatorSettings, parse_scales

    scales = parse_scales(settings["rings"], settings["radius"])
    named = passes or defaults(bool(scales), settings.get("noise") is not None)
    names = resolve([*named, *implied(settings["parameters"], settings["bending_rigidity"])])
    return names, at_scales(names, EstimatorSettings(scales or DEFAULTS.scales))
