"""`curvcli sample`: write test surfaces from formulas, with their exact curvatures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from ..output.registry import listed
from . import candidates, options
from .outputs import one_stdout
from .talk import say

if TYPE_CHECKING:
    from ..output.registry import OutputKind
    from ..samples.model import Sample, SampleSpec

_NORMALS = {"normal_x": "nx", "normal_y": "ny", "normal_z": "nz"}


@click.command("sample", short_help="Write a test surface with known curvatures.")
@click.argument("name", required=False, shell_complete=candidates.samples)
@click.option(
    "-o",
    "--output",
    "outputs",
    metavar="PATH",
    multiple=True,
    help=f"Write {listed('mesh', 'triangles')} (the mesh; .ply .vtp .vtu with exact curvatures) or {listed('table')} "
    "(their table); repeatable. `-` is stdout.",
)
@click.option("--size", type=click.IntRange(4), help="Approximate number of vertices.")
@click.option("--scale", type=float, default=1.0, show_default=True, help="Multiply all lengths.")
@click.option(
    "--set",
    "settings",
    metavar="NAME=VALUE",
    shell_complete=candidates.sample_parameters,
    multiple=True,
    help="Set a parameter of the surface.",
)
@click.option("--ascii", "ascii_stl", is_flag=True, help="Write .stl as text, which keeps doubles.")
@options.stream_format
@options.force
@options.talking
def command(
    name: str | None,
    outputs: tuple[str, ...],
    size: int | None,
    scale: float,
    settings: tuple[str, ...],
    ascii_stl: bool,
    stream_format: str | None,
    force: bool,
    quiet: bool,
    verbose: int,
) -> None:
    """Make the surface NAME, with a table of its exact curvatures where they are known.

    Without NAME, lists all surfaces; without -o, prints the exact values of one.

    \b
      curvcli sample
      curvcli sample torus --set radius=3 --size 10000 -o torus.ply -o exact.csv
    """
    from ..report.terminal.samples import describe, listing
    from ..samples import get

    one_stdout(outputs, False, (), stream_format)
    if name is None:
        if outputs:
            raise click.UsageError("no NAME given for the outputs", click.get_current_context())
        listing()
        return
    spec = get(name)
    if scale <= 0:
        raise click.BadParameter(f"{scale} is not positive", param_hint="--scale")
    values = spec.parse(_pairs(settings))
    if size is not None:
        if all(parameter.name != "size" for parameter in spec.parameters):
            raise click.UsageError(f"{spec.name} has no size: it is always the same mesh", click.get_current_context())
        values["size"] = size
    if outputs:
        _write(spec, values, scale, outputs, stream_format, ascii_stl, force, quiet)
    else:
        describe(spec, spec(**values).scaled(scale))


def _pairs(settings: tuple[str, ...]) -> dict[str, str]:
    pairs = {}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals or not key:
            raise click.BadParameter(f"{setting!r} is not NAME=VALUE", param_hint="--set")
        pairs[key.strip()] = value.strip()
    return pairs


def _write(
    spec: SampleSpec,
    values: dict[str, Any],
    scale: float,
    outputs: tuple[str, ...],
    stream_format: str | None,
    ascii_stl: bool,
    force: bool,
    quiet: bool,
) -> None:
    from ..output.atomic import Outputs
    from ..output.registry import format_of

    kinds: tuple[OutputKind, ...] = ("table", "mesh", "triangles")
    formats = [format_of(path, name=stream_format if path == "-" else None, kinds=kinds) for path in outputs]
    with Outputs(outputs, force) as files:
        made = spec(**values).scaled(scale)
        for path, output_format in zip(outputs, formats, strict=True):
            with files.open(path) as stream:
                _write_one(stream, made, output_format.suffix, ascii_stl, quiet)


def _write_one(stream: Any, made: Sample, suffix: str, ascii_stl: bool, quiet: bool) -> None:
    import numpy as np

    from ..output.meshes.stl import write_stl_text
    from ..output.meshes.write import write_mesh
    from ..output.registry import output_formats, suffixes
    from ..output.tables.write import write_table

    output_formats()[suffix].require()
    if suffix == ".stl" and ascii_stl:
        write_stl_text(stream, made.points, made.faces)
    elif suffix in suffixes(("mesh", "triangles")):
        comments = [f"curvcli sample {made.name}: {made.description}"]
        # Names that other programs, and --normals file, read as normals.
        properties = {_NORMALS.get(name, name): column for name, column in made.exact.items()}
        for notice in write_mesh(
            stream, suffix, made.points, made.faces, vertex_properties=properties, comments=comments
        ):
            if not quiet:
                say(notice.message)
    else:
        index = {"vertex": np.arange(len(made.points), dtype=np.int32)}
        write_table(stream, index | dict(zip("xyz", made.points.T, strict=True)) | made.exact, suffix)
