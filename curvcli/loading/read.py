"""Reading a mesh file: open, hash, unpack, recognise, parse, merge."""

from __future__ import annotations

import os
from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING, Any, BinaryIO

from ..errors import InputError, UsageError
from ..support.words import escape_text
from .content import DamagedError, inflate, open_regular, read_limited
from .entrance import load_through_trimesh
from .limits import check_faces, parse_weld
from .pieces import Pieces
from .recognise import format_of_file, free_start, recognise
from .registry import ParserOptions, input_formats

if TYPE_CHECKING:
    from ..mesh.file import MeshFile

_GZIP = b"\x1f\x8b"


def read_mesh_file(
    source: str | bytes | os.PathLike[Any] | BinaryIO,
    *,
    input_format: str | None = None,
    weld: str | float = "auto",
    max_faces: int | None = None,
    max_bytes: int | None = None,
    normals: str = "mesh",
    texture: bool = False,
) -> MeshFile:
    """The content of a mesh file, in file order, with the hash of its bytes.

    source: a path, or a binary stream (its path is reported as `-`). input_format: the name of a format instead of the
    suffix. weld: `auto` (exact for formats that cut surfaces, such as STL and GLB, none otherwise), `none`, `exact`, or
    a tolerance relative to the diagonal of the bounding box. max_faces, max_bytes: refuse larger files. normals: `file`
    also reads those that records of the file give, texture its texture coordinates.
    Errors: InputError, one line that names the file, the place, what was found and what was expected; UsageError for
    an unknown format or way of welding; MissingExtraError for a format whose library is not installed.
    """
    weld, formats = parse_weld(weld), input_formats()
    kind = input_format and input_format.lower()
    if kind is not None and kind not in formats:
        raise UsageError(f"input format `{input_format}` is not known; {', '.join(formats)} are")
    path = os.fsdecode(source) if isinstance(source, str | bytes | os.PathLike) else "-"
    try:
        options = ParserOptions(weld != "none", max_faces, normals == "file", texture, max_bytes)
        return _read(source, path, kind, weld, max_bytes, options)
    except InputError as error:
        place, hint = error.place and escape_text(error.place), error.hint and escape_text(error.hint)
        raise InputError(escape_text(error.problem), path=escape_text(path), place=place, hint=hint) from None


def _read(
    source: str | bytes | os.PathLike[Any] | BinaryIO,
    path: str,
    input_format: str | None,
    weld: str | float,
    max_bytes: int | None,
    options: ParserOptions,
) -> MeshFile:
    import numpy as np

    from ..mesh.welding import welded

    with ExitStack() as stack:
        kind = input_format
        if isinstance(source, str | bytes | os.PathLike):
            file = stack.enter_context(open_regular(source, max_bytes))
            hashed = stack.enter_context(Pieces(file))
            kind = kind or format_of_file(path, hashed)
        else:
            hashed = stack.enter_context(Pieces(read_limited(source, max_bytes)))
        pieces = hashed
        if hashed.ahead()[:2] == _GZIP:
            pieces = stack.enter_context(Pieces(_inflated(hashed.rest(), max_bytes), hashed=False))
        if not pieces.size:
            raise InputError("no data found, a mesh expected")
        format, notices = recognise(pieces, kind, by_name=input_format is None)
        format.require()
        weld = "exact" if weld == "auto" and format.seams else weld
        exact = format.separate_corners and weld in ("auto", "exact")
        # Not during the import of trimesh: that took longer, by 4 % for 100,000 vertices of OBJ and 11 % of PLY.
        try:
            with np.errstate(invalid="ignore"):  # signalling NaNs; who uses a NaN refuses it
                mesh = load_through_trimesh(pieces, format, options)
                mesh = mesh if exact else welded(mesh, weld)
        except InputError:
            hashed.check()  # what is wrong with a file that changes is that it changes
            raise
        check_faces(mesh.polygons, options.max_faces)
        merged = "exact" if exact else "none" if weld == "auto" else str(weld)
        notices = (*notices, *mesh.notices)
        return replace(mesh, path=escape_text(path), sha256=hashed.sha256(), weld=merged, notices=notices)


def _inflated(data: bytes, max_bytes: int | None) -> bytes:
    """The content of gzip data, or the data themselves where they are of a format whose first bytes are free.

    Errors: InputError for gzip data that are damaged or inflate to too much.
    """
    try:
        return inflate(data, max_bytes)
    except DamagedError:
        if free_start(data[: Pieces.window], len(data), input_formats()):
            return data
        raise
