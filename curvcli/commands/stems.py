"""`{stem}` in the names of outputs: a single name that cannot lead into another folder, one output for each mesh."""

from __future__ import annotations

import os
from collections.abc import Sequence

from ..errors import OutputError, UsageError
from ..loading.registry import input_formats, suffixes

# Device names of Windows, whatever follows behind a dot.
_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10))}


def stem(mesh: str, windows: bool = os.name == "nt") -> str:
    """The name of a mesh's file without its suffixes.

    The whole name stands where nothing but dots is left without the suffix: `...ply` would be the folder above. A path
    that ends in no name, such as `..`, goes by the folder it means. On Windows a device, such as `NUL`, gets an
    underscore, and so do the dots and blanks at the end of a name, which Windows leaves out. Surfaces of
    FreeSurfer, such as lh.white and lh.pial, keep their whole names.
    """
    whole = os.path.basename(mesh)
    if whole in ("", os.curdir, os.pardir):
        whole = os.path.basename(os.path.abspath(mesh)) or "_"
    name = whole
    kept = {
        end
        for input_format in input_formats().values()
        if whole.lower().startswith(input_format.starts)
        for end in input_format.endings
    }
    for suffix in ("gz", *suffixes()):
        if suffix not in kept and name.lower().endswith(f".{suffix}"):
            name = name[: -len(suffix) - 1]
    if not name.strip(". "):
        name = whole
    if windows and (name.partition(".")[0].strip().casefold() in _DEVICES or name[-1:] in (".", " ")):
        name += "_"
    return name


def check_apart(meshes: Sequence[str], paths: Sequence[Sequence[str]]) -> None:
    """Errors: OutputError where `{stem}` gives two meshes one output."""
    taken: dict[str, int] = {}
    for index, each in enumerate(paths):
        for path in each:
            other = taken.setdefault(path, index)
            if path != "-" and other != index:
                both = f"{meshes[other]} and {meshes[index]}"
                raise OutputError(f"{path}: {both} would share this output; `curvcli batch` keeps their folders apart")


def expand(output: str, mesh: str, meshes: int) -> str:
    """An output's path for one mesh.

    Errors: UsageError when several meshes would share one output.
    """
    if "{stem}" not in output:
        if meshes > 1 and output != "-":
            raise UsageError(f"{output}: {meshes} meshes would share this output; put {{stem}} into its name")
        return output
    path = output.replace("{stem}", stem(mesh) if mesh != "-" else "stdin")
    return path if path != "-" else os.path.join(os.curdir, path)  # the name of a mesh is no stream
