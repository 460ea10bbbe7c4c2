"""From a file or a stream to its content, through trimesh: the one entrance."""

from __future__ import annotations

import importlib
import io
import os
import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from dataclasses import replace
from typing import Any, BinaryIO, Generic, NamedTuple, TypeVar

from ..errors import InputError, UsageError
from ..mesh.file import MeshFile
from ..support.memory import require_polars
from ..support.words import escape_text
from .content import DamagedError, inflate, open_regular, read_limited
from .elsewhere import FORMATS
from .limits import check_faces, parse_weld
from .pieces import Pieces
from .recognise import format_of_name, recognise
from .text import SMALL

_PREFIX = "curvcli-"
_GZIP = b"\x1f\x8b"

Made = TypeVar("Made")


class Wanted(NamedTuple):
    """What is read of a file beside its surface: the normals, and the texture coordinates, of an OBJ file."""

    normals: bool = False
    texture: bool = False


def read_mesh_file(
    source: str | bytes | os.PathLike[Any] | BinaryIO,
    *,
    input_format: str | None = None,
    weld: str | float = "auto",
    max_faces: int | None = None,
    max_bytes: int | None = None,
    normals: str = "mesh",
) -> MeshFile:
    """The content of a mesh file, in file order, with the hash of its bytes.

    source: a path, or a binary stream (its path is reported as `-`). input_format: `obj`, `ply` or `stl` instead of
    the suffix. weld: `auto` (exact for STL, none otherwise), `none`, `exact`, or a tolerance relative to the diagonal
    of the bounding box. max_faces, max_bytes: refuse larger files. normals: `file` also reads those of an OBJ file.
    Errors: InputError, one line that names the file, the place, what was found and what was expected; UsageError for
    an unknown format or way of welding.
    """
    return read_and_make(lambda mesh: mesh, source, input_format, weld, max_faces, max_bytes, normals)


def read_and_make(
    make: Callable[[MeshFile], Made],
    source: str | bytes | os.PathLike[Any] | BinaryIO,
    input_format: str | None = None,
    weld: str | float = "auto",
    max_faces: int | None = None,
    max_bytes: int | None = None,
    normals: str = "mesh",
    texture: bool = False,
) -> Made:
    """What `make` makes of the content of a mesh file, read, and refused, as `read_mesh_file` does it."""
    weld = parse_weld(weld)
    if input_format is not None and input_format.lower() not in FORMATS:
        raise UsageError(f"input format `{input_format}` is not known; {', '.join(FORMATS)} are")
    path = os.fsdecode(source) if isinstance(source, str | bytes | os.PathLike) else "-"
    try:
        kind = input_format and input_format.lower()
        return _read(make, source, path, kind, weld, max_faces, max_bytes, Wanted(normals == "file", texture))
    except InputError as error:
        place, hint = error.place and escape_text(error.place), error.hint and escape_text(error.hint)
        raise InputError(escape_text(error.problem), path=escape_text(path), place=place, hint=hint) from None


def _read(
    make: Callable[[MeshFile], Made],
    source: str | bytes | os.PathLike[Any] | BinaryIO,
    path: str,
    input_format: str | None,
    weld: str | float,
    max_faces: int | None,
    max_bytes: int | None,
    asked: Wanted,
) -> Made:
    with ExitStack() as stack:
        raw: io.FileIO | bytes
        wanted = input_format
        if isinstance(source, str | bytes | os.PathLike):
            raw = stack.enter_context(open_regular(source, max_bytes))
            wanted = wanted or format_of_name(path)
        else:
            raw = read_limited(source, max_bytes)
        hashed = stack.enter_context(Pieces(raw))
        del raw
        pool = stack.enter_context(ThreadPoolExecutor(2))
        importing = []
        if "trimesh" not in sys.modules and hashed.size > SMALL:
            # Before trimesh: polars parses outside the interpreter, which only one import at a time can have. Those who
            # take all bytes at once wait for it least often, and the memory of the bytes serves for what follows.
            importing.append(pool.submit(_import_polars, hashed.size))
            hashed.whole()
        pieces = hashed
        if hashed.ahead()[:2] == _GZIP:
            pieces = stack.enter_context(Pieces(_inflated(hashed.rest(), max_bytes), hashed=False))
        if not pieces.size:
            raise InputError("no data found, a mesh expected")
        kind, notices = recognise(pieces, wanted, by_name=input_format is None)

        def content() -> Made:
            try:
                mesh = _parse(pieces, kind, weld, max_faces, asked)
            except InputError:
                hashed.check()  # what is wrong with a file that changes is that it changes
                raise
            pieces.clear()
            hashed.clear()
            check_faces(mesh.polygons, max_faces)
            merged = ("exact" if kind == "stl" else "none") if weld == "auto" else str(weld)
            notes = (*notices, *mesh.notices)
            return make(replace(mesh, path=escape_text(path), sha256=hashed.sha256(), weld=merged, notices=notes))

        made = pool.submit(content)  # made while trimesh is imported
        wait(importing)
        return _through_trimesh(made, kind)


def _inflated(data: bytes, max_bytes: int | None) -> bytes:
    """The content of gzip data, or the data themselves where they are binary STL whose header begins as gzip does.

    Errors: InputError for gzip data that are damaged or inflate to too much.
    """
    from .stl import has_room

    try:
        return inflate(data, max_bytes)
    except DamagedError:
        if has_room(data[: Pieces.window], len(data)):
            return data
        raise


def _import_polars(data: int) -> None:
    require_polars(data)
    importlib.import_module("polars")


class _Content(io.BytesIO, Generic[Made]):
    """The content behind a stream without bytes or name: trimesh can resolve no reference to another file."""

    def __init__(self, made: Future[Made]) -> None:
        super().__init__()
        self.made = made


def _through_trimesh(made: Future[Made], kind: str) -> Made:
    """The content as trimesh hands it on."""
    from trimesh.exchange.load import load_scene, mesh_loaders

    # A name of our own: importing curvcli changes nothing for other users of trimesh in this process.
    mesh_loaders.setdefault(_PREFIX + kind, _load)
    stream = _Content(made)
    scene = load_scene(stream, file_type=_PREFIX + kind, process=False)
    (mesh,) = scene.geometry.values()
    # The objects of trimesh refer to each other in circles, and would keep the content until somebody cuts them.
    del stream.made
    content: Made = mesh.metadata.pop("curvcli")
    return content


def _load(file_obj: _Content[Any], **_: Any) -> dict[str, Any]:
    """A trimesh loader: the keyword arguments of a Trimesh, and the whole content of the file under its metadata."""
    import numpy as np

    # trimesh would turn corners into int64 and rows into columns; who wants a Trimesh builds it from the surface.
    nothing = np.empty((0, 3))
    return {"vertices": nothing, "faces": nothing.astype(np.int64), "metadata": {"curvcli": file_obj.made.result()}}


def _parse(pieces: Pieces, kind: str, weld: str | float, max_faces: int | None, asked: Wanted) -> MeshFile:
    """The content of a file of a known kind, equal positions merged where that is asked for."""
    import numpy as np

    from ..mesh.welding import welded

    with np.errstate(invalid="ignore"):  # signalling NaNs; who uses a NaN refuses it
        return welded(_content(pieces, kind, weld, max_faces, asked), weld)


def _content(pieces: Pieces, kind: str, weld: str | float, max_faces: int | None, asked: Wanted) -> MeshFile:
    if kind == "obj":
        from .obj import parse_obj

        return parse_obj(pieces.rest(), max_faces=max_faces, normals=asked.normals, texture=asked.texture)
    if kind == "ply":
        from .ply import parse_ply

        return parse_ply(pieces, max_faces=max_faces)
    from .stl import parse_stl

    return parse_stl(pieces, weld=weld != "none", max_faces=max_faces)
