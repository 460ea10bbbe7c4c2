"""Hints for input that curvcli does not read: other formats, folders, URLs, patterns."""

from __future__ import annotations

import os
import re
import shlex

from .registry import input_formats, suffixes

_MESHIO = "`meshio convert {file} OUT.ply` converts it (`pip install meshio`)"
_VTK = (
    """`python -c "import pyvista; pyvista.read('{path}').extract_surface().save('OUT.ply')"` converts it """
    "(`pip install 'curvcli[pictures]'`)"
)
_MESHLAB = (
    """`python -c "import pymeshlab; s = pymeshlab.MeshSet(); s.load_new_mesh('{path}'); """
    """s.generate_by_merging_visible_meshes(); s.save_current_mesh('OUT.ply')"` converts it (`pip install pymeshlab`)"""
)
_CAD = "export it as STL from a CAD program"
_GMSH = f"{_CAD}, or by `gmsh {{file}} -2 -o OUT.stl`"
_SCENE = "export it as PLY, OBJ or STL from Blender"
_POINTS = "points have no faces: reconstruct a surface first, for example with MeshLab"
_VOLUME = "a volume has no faces: extract a surface first, for example with skimage.measure.marching_cubes"
_UNPACK = "unpack it first"
_LABELS = "`curvcli analyze SURFACE --regions {file}` takes the labels"
_TABLE = "`curvcli compare` reads reports and tables"

# By suffix; every command was run.
_WAYS_OUT = {
    **dict.fromkeys(("avs", "bdf", "dat", "fem", "inp", "mdpa", "mesh", "meshb", "nas", "tec", "vol"), _MESHIO),
    **dict.fromkeys(("exo", "pvd", "pvtu", "vti", "vtkhdf", "vtm", "vtmb", "vtpd", "vtr", "vts"), _VTK),
    "pvtp": "it names files of pieces, which are never opened by reference: give the .vtp files themselves",
    **dict.fromkeys(("step", "stp", "iges", "igs", "brep"), _GMSH),
    **dict.fromkeys(
        ("3dm", "amf", "catpart", "dwg", "dxf", "f3d", "fcstd", "ipt", "jt", "prt", "scad", "sldprt", "x_t"),
        _CAD,
    ),
    **dict.fromkeys(("abc", "blend", "c4d", "fbx", "ma", "max", "mb", "usd", "usda", "usdz"), _SCENE),
    **dict.fromkeys(("3ds", "ctm", "dae", "wrl", "x3d"), _MESHLAB),
    **dict.fromkeys(("e57", "las", "laz", "pcd", "pts", "xyz"), _POINTS),
    **dict.fromkeys(("dcm", "mha", "mrc", "nhdr", "nii", "nrrd", "tif", "tiff"), _VOLUME),
    **dict.fromkeys(("7z", "bz2", "tar", "tgz", "xz", "zip", "zst"), _UNPACK),
    **dict.fromkeys(("annot", "label"), _LABELS),
    **dict.fromkeys(("csv", "json", "jsonl", "parquet", "tsv"), _TABLE),
}
_PLAIN = re.compile(r"[\w./ +-]+", re.ASCII)
_URL = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+://")
_MAGIC = re.compile(r"[*?[]")
# Largest number of entries of a folder that are searched for a suffix.
_LOOKED_AT = 1000


def known_suffix(path: str) -> str | None:
    """The format that the suffix names, in any case and before .gz, or the start of the name; None for none."""
    suffix, name = suffix_of(path), os.path.basename(path).lower()
    if suffix in suffixes() or suffix in _WAYS_OUT:
        return suffixes().get(suffix)
    return next(
        (input_format.name for input_format in input_formats().values() if name.startswith(input_format.starts)), None
    )


def suffix_of(path: str) -> str:
    """The suffix in lower case, without the dot and without .gz; empty if there is none."""
    name = os.path.basename(path).lower().removesuffix(".gz")
    return name.rpartition(".")[2] if "." in name else ""


def of_suffix(path: str) -> str:
    """A hint with a command that reads or converts a file with this suffix."""
    hint = _WAYS_OUT.get(suffix_of(path))
    if hint is None:
        return f"--input-format {'|'.join(input_formats())} reads a file of such a format under another name"
    return hint.format(file=_quoted(path), path=_inside_quotes(path))


def of_folder(path: str) -> str:
    """A hint with a command that reads the meshes in a folder."""
    suffix, inside = _suffix_inside(path), path.rstrip(os.sep) or os.sep
    pattern = os.path.join(inside, f"*.{suffix}")
    quoted = _quoted(inside).rstrip(os.sep) + f"/*.{suffix}"
    tree = shlex.quote(os.path.join(inside, "**", f"*.{suffix}")) if pattern.isprintable() else f"'DIR/**/*.{suffix}'"
    return f"{quoted} names the meshes in it, and `curvcli batch {tree} -o OUT` reads those of all its folders"


def of_missing(path: str) -> str | None:
    """A hint for a URL or a pattern that names no file; None for other names."""
    if _URL.match(path):
        if path.lower().startswith("file://"):
            return f"`curvcli batch {_quoted(path, 'URL')} -o OUT` reads a URL, other commands a path"
        return (
            f"`curvcli batch {_quoted(path, 'URL')} -o OUT` reads a URL (`pip install 'curvcli[remote]'`), "
            "other commands a file that was downloaded"
        )
    if _MAGIC.search(path):
        batch = f"`curvcli batch {_quoted(path, 'PATTERN')} -o OUT`"
        return f"{batch} expands patterns; the shell expands those without quotes"
    return None


def is_url(path: str) -> bool:
    """Test for a URL."""
    return bool(_URL.match(path))


def _suffix_inside(path: str) -> str:
    """The suffix of the first mesh in a folder, in its own case; `ply` if there is none."""
    try:
        with os.scandir(path) as entries:
            for entry, _ in zip(entries, range(_LOOKED_AT), strict=False):
                if known_suffix(entry.name):
                    name = entry.name
                    stem = name[: -len(".gz")] if name.lower().endswith(".gz") else name
                    return stem.rpartition(".")[2] + name[len(stem) :]
    except OSError:
        pass
    return "ply"


def _quoted(path: str, placeholder: str = "") -> str:
    """Quote a path for a shell; a placeholder for an unprintable path."""
    if path.isprintable():
        return shlex.quote(path)
    return placeholder or (f"IN.{suffix_of(path)}" if suffix_of(path).isprintable() else "IN")


def _inside_quotes(path: str) -> str:
    """A path for use inside quotes of Python and of a shell; a placeholder for a path that would end them."""
    return path if _PLAIN.fullmatch(path) else f"IN.{suffix_of(path)}"
