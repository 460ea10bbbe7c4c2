"""Registry of input formats: each is one module or folder of `formats`, found there by its name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules
from typing import TYPE_CHECKING, NamedTuple

from ..errors import MissingExtraError

if TYPE_CHECKING:
    from ..mesh.file import MeshFile
    from .pieces import Pieces


class ParserOptions(NamedTuple):
    """Options of a parser.

    merge: merge equal positions, where the format gives each triangle corners of its own. max_faces: refuse more.
    normals, texture: read normals, texture coordinates, where the format has records of them. max_bytes: refuse data
    that expand to more.
    """

    merge: bool = True
    max_faces: int | None = None
    normals: bool = False
    texture: bool = False
    max_bytes: int | None = None


@dataclass(frozen=True, kw_only=True)
class InputFormat:
    """An input format.

    name: for --input-format, messages and, with a dot, the suffix. full_name: in sentences, if it is not the name in
    capitals. suffixes: all of them without the dot, if there are others. starts: first letters of the names of files
    that often have no suffix of the format; its content is recognised under any other name too. parse: makes a MeshFile
    with this `format` from the content; None: trimesh's own loader for the name reads it. has_sign: tests for the sign
    of the format without taking bytes. weak_sign: text of other formats may have it too, so their signs are tested
    first. any_start: tests content of this size that begins like an archive or a web page; the last argument is True if
    the name promises the format. separate_corners: triangles share no vertices, so `--weld auto` merges equal positions
    exactly. seams: vertices are cut where normals or texture jump, `--weld auto` merges equal positions exactly, and
    their rows stay. encodings, rows, digits, keeps, labels, polygons, curves: cells of the table in docs/formats.md.
    library, extra: module that the parser needs, and the extra of curvcli that installs it.
    """

    name: str
    has_sign: Callable[[Pieces], bool]
    parse: Callable[[Pieces, ParserOptions], MeshFile] | None = None
    full_name: str = ""
    suffixes: tuple[str, ...] = ()
    starts: tuple[str, ...] = ()
    weak_sign: bool = False
    any_start: Callable[[bytes, int, bool], bool] | None = None
    separate_corners: bool = False
    seams: bool = False
    encodings: str = "text"
    rows: str = "vertices"
    digits: str = "doubles"
    keeps: str = "nothing"
    labels: str = "none"
    polygons: str = "triangulated"
    curves: str = "none"
    library: str | None = None
    extra: str | None = None

    @property
    def title(self) -> str:
        """The name in sentences."""
        return self.full_name or self.name.upper()

    @property
    def endings(self) -> tuple[str, ...]:
        """All suffixes without the dot, in lower case."""
        return self.suffixes or (self.name,)

    def require(self) -> None:
        """Raise MissingExtraError if the library that the parser needs is not installed."""
        if self.library is not None and find_spec(self.library) is None:
            package = f"'curvcli[{self.extra}]'" if self.extra else self.library
            raise MissingExtraError(f"{self.title} needs {self.library}: `pip install {package}`")


_registered: dict[str, InputFormat] = {}


def register(format: InputFormat) -> InputFormat:
    """Add a format. Errors: ValueError for a name or suffix of another format."""
    taken = {ending for other in _registered.values() for ending in (other.name, *other.endings)}
    if twice := taken & {format.name, *format.endings}:
        raise ValueError(f"two input formats named {', '.join(sorted(twice))}")
    _registered[format.name] = format
    return format


@cache
def input_formats() -> Mapping[str, InputFormat]:
    """All formats by name, in alphabetical order."""
    folder = import_module(".formats", __package__)
    for module in iter_modules(folder.__path__):
        import_module(f"{folder.__name__}.{module.name}")
    return dict(sorted(_registered.items()))


def by_sign() -> list[InputFormat]:
    """All formats in the order of the tests of their signs."""
    return sorted(input_formats().values(), key=lambda format: format.weak_sign)


@cache
def suffixes() -> Mapping[str, str]:
    """The name of the format of each suffix, without the dot."""
    return {ending: format.name for format in input_formats().values() for ending in format.endings}
