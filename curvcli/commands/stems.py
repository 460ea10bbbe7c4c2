"""Value of `{stem}` in the name of an output: a single name that cannot lead into another folder."""

from __future__ import annotations

import os

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
    kept = {end for one in input_formats().values() if whole.lower().startswith(one.starts) for end in one.endings}
    for suffix in ("gz", *suffixes()):
        if suffix not in kept and name.lower().endswith(f".{suffix}"):
            name = name[: -len(suffix) - 1]
    if not name.strip(". "):
        name = whole
    if windows and (name.partition(".")[0].strip().casefold() in _DEVICES or name[-1:] in (".", " ")):
        name += "_"
    return name
