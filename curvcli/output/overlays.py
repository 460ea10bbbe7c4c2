"""Overlays: columns of vertices as GIFTI arrays or FreeSurfer's curv, to be laid over the surface that was read."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ..errors import MissingExtraError, Notice, UsageError
from ..mesh.file import Labels
from ..support.words import escape_text, pluralize
from .appearance import Appearance
from .coloring import coloring
from .distributions import vertex_quantities
from .registry import OverlayFormat, format_of
from .tables.columns import vertex_properties

if TYPE_CHECKING:
    from ..analysis.result import Result


def overlay_columns(path: str, format: OverlayFormat, appearance: Appearance, chosen: list[str]) -> list[str]:
    """The columns of an overlay: the one at the end of its name, as in lh.K.curv, else --color-by, else the default.

    Errors: UsageError for a column that is not computed, for none, and for several where the format holds one.
    """
    from ..curvatures.registry import passes

    columns = vertex_quantities(chosen)
    stem = os.path.basename(path)[: -len(format.suffix)] if path.lower().endswith(format.suffix) else ""
    named = stem.rpartition(".")[2]
    if named in columns:
        return [named]
    colored = [name for name in appearance.color_by if name in columns]
    others = vertex_quantities([quantity.name for quantity in passes.quantities("vertex")])
    place = escape_text(path)
    if named in others and not colored:
        raise UsageError(f"{place}: {named} is not computed; -p core,{others[named].name} adds it")
    if len(colored) > 1 and not format.several:
        raise UsageError(
            f"{place}: {format.suffix} holds one column; name it in the path, as lh.{colored[0]}{format.suffix}"
        )
    if appearance.color_by and not colored:
        raise UsageError(f"{place}: --color-by {appearance.color_by[0]}: an overlay needs a column of vertices")
    default = coloring(appearance, chosen)
    if not colored and default is None:
        raise UsageError(f"{place}: no column for it is computed; -p core adds some")
    return colored or [str(default)]


def check_overlays(paths: Iterable[str], appearance: Appearance, chosen: list[str], name: str | None) -> None:
    """Refuse overlays of columns that will not be there, before any work. Errors: UsageError."""
    for path in paths:
        format = format_of(path, name=name if path == "-" else None)
        if isinstance(format, OverlayFormat):
            overlay_columns(path, format, appearance, chosen)


def write_overlay(
    stream: BinaryIO, analysis: Result, path: str, format: OverlayFormat, appearance: Appearance
) -> tuple[str, tuple[Notice, ...]]:
    """Write the columns of an overlay.

    Returns a line with the columns, and a notice of values that float32 cannot hold, which become undefined.
    """
    names = overlay_columns(path, format, appearance, analysis.chosen)
    all_columns = vertex_properties(analysis)
    columns = {name: _single(all_columns[name]) for name in names}
    lost = sum(count for _, count in columns.values())
    format.write(stream, {name: values for name, (values, _) in columns.items()}, analysis.surface.n_faces)
    message = pluralize(lost, "[value|values] beyond the range of float32, left undefined")
    notice = Notice("overlay_float32", lost, message, "tables and .ply hold doubles")
    return ", ".join(names), (notice,) if lost else ()


def _single(column: Any) -> tuple[NDArray[Any], int]:
    """A column as int32 or float32, the types of GIFTI, and the number of values that were lost; NaN is undefined."""
    if isinstance(column, Labels):
        return column.codes.astype(np.int32), 0
    if isinstance(column, np.ma.MaskedArray):
        column = np.where(np.ma.getmaskarray(column), np.nan, np.ma.getdata(column))
    if column.dtype.kind in "iub":
        return column.astype(np.int32), 0
    with np.errstate(over="ignore", under="ignore"):
        values = column.astype(np.float32)
    lost = (np.isinf(values) | (values == 0)) & np.isfinite(column) & (column != 0)
    values[lost] = np.nan
    return values, int(np.count_nonzero(lost))


def require_nibabel() -> None:
    """Errors: MissingExtraError without nibabel."""
    from importlib.util import find_spec

    if find_spec("nibabel") is None:
        raise MissingExtraError("GIFTI needs nibabel: `pip install 'curvcli[cortex]'`")


def write_gifti(stream: BinaryIO, columns: Mapping[str, NDArray[Any]], _faces: int) -> None:
    """Write columns as arrays under their names, float32 or int32, in base64 of zlib data."""
    from nibabel.gifti import GiftiDataArray, GiftiImage, GiftiMetaData

    arrays = [
        GiftiDataArray(values, "NIFTI_INTENT_SHAPE", meta=GiftiMetaData(Name=name)) for name, values in columns.items()
    ]
    stream.write(GiftiImage(darrays=arrays).to_bytes())


def write_curv(stream: BinaryIO, columns: Mapping[str, NDArray[Any]], faces: int) -> None:
    """Write the only column as big-endian float32 behind the numbers of vertices, faces and values per vertex."""
    (values,) = columns.values()
    stream.write(b"\xff\xff\xff" + np.array([len(values), faces, 1], ">i4").tobytes())
    stream.write(values.astype(">f4").tobytes())
