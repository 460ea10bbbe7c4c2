"""Registry of output formats by suffix: each is one module of `formats`, found there by its name."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Any, BinaryIO, Literal, get_args

from ..errors import UsageError
from ..support.words import escape_text, suggestion

if TYPE_CHECKING:
    from threading import Event

    from ..analysis.result import Result
    from ..errors import Notice
    from .appearance import Appearance
    from .distributions import MeshSamples

OutputKind = Literal["table", "mesh", "triangles", "overlay", "report", "page", "picture"]


@dataclass(frozen=True, kw_only=True)
class Format:
    """A kind of file.

    suffix: with the dot. kind: `triangles` is a mesh without columns. description: a line for the help. place: in lists
    of its kind, the lowest first. shows: the columns that it shows in colours, from the appearance and the names of
    quantities; None for no colours. edges: whether these may be columns of edges. require: raises MissingExtraError
    where the library of an extra is not installed.
    """

    suffix: str
    kind: OutputKind
    description: str
    place: int = 100
    shows: Callable[[Appearance, list[str]], Iterable[str]] | None = None
    edges: bool = False
    require: Callable[[], None] = lambda: None


@dataclass(frozen=True, kw_only=True)
class TableFormat(Format):
    """A format of tables.

    write: takes a stream, columns by name, the precision, and an Event that ends the writing or None. totals: writes
    the totals of a result where -o names the format, in place of the table of vertices. brief: whether tables of
    regions and components leave out counts and other values that a paper seldom shows.
    """

    kind: OutputKind = "table"
    write: Callable[[BinaryIO, Mapping[str, Any], str | int, Event | None], None]
    totals: Callable[[BinaryIO, Result, Appearance], None] | None = None
    brief: bool = False


@dataclass(frozen=True, kw_only=True)
class MeshFormat(Format):
    """A format of meshes.

    write: takes a stream, points, faces and the keywords of `MeshAttributes`; returns notices of
    what the format cannot hold.
    properties: whether it holds columns. labels: whether it holds the labels of the input with their words. quality:
    whether the column of the colours may stand there as `quality` too.
    """

    kind: OutputKind = "mesh"
    write: Callable[..., tuple[Notice, ...]]
    properties: bool = False
    labels: bool = False
    quality: bool = False


@dataclass(frozen=True, kw_only=True)
class OverlayFormat(Format):
    """A format of columns of vertices without the surface.

    write: takes a stream, columns by name and the number of faces. several: whether it holds more than one column.
    """

    kind: OutputKind = "overlay"
    write: Callable[[BinaryIO, Mapping[str, Any], int], None]
    several: bool = False


@dataclass(frozen=True, kw_only=True)
class DocumentFormat(Format):
    """A format of reports, pages and pictures.

    write: takes a stream, the result, the appearance and the command line or None; returns a line for each column that
    a picture shows. camera: whether it draws the surface from a view. page: whether that is an image on a page of text
    and lines. panels: the number of its panels, None for one per column. several: draws several
    meshes in one picture.
    """

    write: Callable[[BinaryIO, Result, Appearance, str | None], list[str]]
    camera: bool = False
    page: bool = False
    panels: Callable[[Appearance, list[str]], int] | None = None
    several: Callable[[BinaryIO, MeshSamples, Appearance], list[str]] | None = None


_KINDS = get_args(OutputKind)
_registered: dict[str, Format] = {}


def register(format: Format) -> None:
    """Add a format. Errors: ValueError for a suffix that another format has."""
    if format.suffix in _registered:
        raise ValueError(f"two output formats with the suffix {format.suffix}")
    _registered[format.suffix] = format


@cache
def output_formats() -> Mapping[str, Format]:
    """All formats by suffix, in the order of the documentation."""
    folder = import_module(".formats", __package__)
    for module in iter_modules(folder.__path__):
        import_module(f"{folder.__name__}.{module.name}")
    order = sorted(_registered.values(), key=lambda format: (_KINDS.index(format.kind), format.place, format.suffix))
    return {format.suffix: format for format in order}


def mesh_color(appearance: Appearance, chosen: list[str]) -> list[str]:
    """The column that colours a mesh, if there is one."""
    from .coloring import coloring

    name = coloring(appearance, chosen)
    return [] if name is None else [name]


def listed(*kinds: OutputKind) -> str:
    """The suffixes of these kinds in a sentence."""
    return " ".join(suffixes(kinds))


def suffixes(kinds: Collection[OutputKind] | None = None) -> tuple[str, ...]:
    """Suffixes of these kinds, or of all, in the order of the documentation."""
    return tuple(suffix for suffix, format in output_formats().items() if kinds is None or format.kind in kinds)


def format_of(path: str, *, name: str | None = None, kinds: Collection[OutputKind] | None = None) -> Format:
    """Format of an output: `name` (as in `--format csv`) if given, else by the suffix of the path.

    Errors: UsageError for an unknown suffix or name, with the known ones.
    """
    promised = suffixes(kinds)
    given = name if name is not None else _suffix(path)
    if name is None and path == "-":
        raise UsageError(f"-: a stream has no suffix; give --format one of {_listed(promised, dot=False)}")
    suffix = "." + given.lower().lstrip(".")
    if suffix in promised:
        return output_formats()[suffix]
    where = f"--format {name}" if name is not None else escape_text(path)
    problem = f"unknown format {given!r}" if given else "a name without a suffix"
    known = promised if name is None else [known_suffix.removeprefix(".") for known_suffix in promised]
    written = suffix if name is None else given
    way_out = suggestion(written, known, f"known here are {_listed(promised, dot=name is None)}")
    raise UsageError(f"{where}: {problem}{way_out}")


def _suffix(path: str) -> str:
    """Suffix of a path: the longest known one, such as `.hist.png`, else the text behind the last dot."""
    stem, last = os.path.splitext(path)
    both = os.path.splitext(stem)[1] + last
    return both if both.lower() in output_formats() else last


def _listed(promised: tuple[str, ...], *, dot: bool) -> str:
    return " ".join(promised if dot else (suffix.removeprefix(".") for suffix in promised))
