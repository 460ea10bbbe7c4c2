"""Plan: the meshes in order, and the paths of the outputs of each."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import count

from ..errors import NoMatchError, UsageError
from ..output.destinations import folded
from ..output.registry import format_of, output_formats
from ..output.tables.columns import TABLES
from ..support.words import escape_text, suggestion
from .locations import absolute, expand, is_url, listed, local, parts_of, read_url, root_of
from .model import OWN, BatchItem
from .walk import real_path

# Data in the memory of one process: the content is sent to the others.
_OF_ONE_PROCESS = "memory://"


def plan(patterns: Iterable[str], files_from: str | None, folder: str, save: Sequence[str]) -> list[BatchItem]:
    """Every mesh once: patterns in the order given with the files of each sorted, then the list in its order.

    A mesh with several names by links is taken by the first of them.
    The outputs of `scans/a/b.ply` by the pattern `scans/**/*.ply` are `a/b.ply.csv` and so on below `folder`: the tree
    below the deepest folder that all patterns share, and the whole name of the mesh, so that the outputs of a.obj, of
    a.ply and of the batch itself never collide. A file in `folder` is an output and matches no wildcard.
    Errors: NoMatchError for a pattern that no file matches, InputError for a list that cannot be read.
    """
    named: list[tuple[str, str]] = []
    roots: list[tuple[str, ...]] = []
    inside = os.path.join(absolute(folder), "")
    of_folder: dict[str, str] = {}
    within = inside, os.path.join(os.path.realpath(inside), "")
    for pattern in map(local, patterns):
        paths = [name for name in expand(pattern) if name == pattern or not _is_output(name, within, of_folder)]
        if not paths:
            raise NoMatchError(f"{escape_text(pattern)}: no file matches outside {escape_text(folder)}")
        named += [(name, _place(name)) for name in paths]
        roots.append(root_of(pattern))
    for name in map(local, listed(files_from) if files_from is not None else []):
        named.append((name, _place(name)))
        roots.append(parts_of(name)[:-1])
    if not named:
        raise NoMatchError(f"{escape_text(files_from or 'no pattern')}: names no file")
    base = _shared(roots)
    items, seen, names = [], set[str](), Counter[str]()
    free = _Free(inside, save)
    for name, place in named:
        file = place if is_url(place) else real_path(place, of_folder)
        if file in seen:
            continue
        seen.add(file)
        stem = free.stem(parts_of(place)[base:])
        content = read_url(place, None) if place.startswith(_OF_ONE_PROCESS) else None
        names[escape_text(name)] += 1
        again = (
            f"~{names[escape_text(name)]}" if names[escape_text(name)] > 1 else ""
        )  # two names that read alike once escaped
        items.append(BatchItem(escape_text(name) + again, place, outputs(stem, save), content))
    return items


def outputs(stem: str, save: Iterable[str]) -> tuple[tuple[str, str], ...]:
    """Kind and path of every output of one mesh."""
    return tuple((_split(entry)[0], f"{stem}.{entry}") for entry in save)


def saves(options: Iterable[str]) -> tuple[str, ...]:
    """Parse `--save csv,json` and `--save edges.csv`: suffixes, with an optional kind of table before one.

    Errors: UsageError for an unknown suffix or kind.
    """
    chosen: dict[str, None] = {}
    for text in (part.strip().lower().lstrip(".") for option in options for part in option.split(",")):
        kind, suffix = _split(text)
        if kind and (kind not in TABLES or kind == "vertices"):
            way_out = suggestion(kind, (kind for kind in TABLES if kind != "vertices"))
            raise UsageError(
                f"--save {escape_text(text)}: there is no table {escape_text(kind)!r}{way_out}; expected KIND.SUFFIX"
            )
        try:
            format_of(
                f"x.{suffix}", kinds=["table"] if kind else ["table", "mesh", "overlay", "report", "page", "picture"]
            )
        except UsageError as error:
            raise UsageError(f"--save {escape_text(text)}: {str(error).partition(': ')[2]}") from None
        chosen[text] = None
    return tuple(chosen)


def _split(save: str) -> tuple[str, str]:
    """Kind of table and suffix of `edges.csv`; no kind for a suffix alone, also one of two parts, as hist.png."""
    kind, _, suffix = ("", "", save) if f".{save}" in output_formats() else save.rpartition(".")
    return kind, suffix


def _shared(roots: Sequence[tuple[str, ...]]) -> int:
    """Number of parts that all roots begin with."""
    return next((k for k, level in enumerate(zip(*roots, strict=False)) if len(set(level)) > 1), min(map(len, roots)))


def _place(name: str) -> str:
    return name if is_url(name) else absolute(name)


def _is_output(name: str, within: tuple[str, ...], of_folder: dict[str, str]) -> bool:
    """True if a file lies in the folder of the batch, also behind a link."""
    place = _place(name)
    return place.startswith(within) or (not is_url(place) and real_path(place, of_folder).startswith(within))


class _Free:
    """Allocator of output paths below a folder: none collides with another or with the batch's own files.

    A name that is taken gets a number. Names that differ in case only are one name, as on disks that ignore case.
    """

    def __init__(self, folder: str, save: Sequence[str]):
        self._folder, self._save = folder, save
        self._files = {folded(os.path.join(folder, name)) for name in OWN}
        self._folders = {folded(os.path.normpath(folder))}

    def stem(self, folders: Sequence[str]) -> str:
        """Reserve and return the name of the outputs of one mesh without suffixes."""
        folder = self._folder
        for part in folders[:-1]:
            folder = next(path for path in _numbered(os.path.join(folder, part)) if folded(path) not in self._files)
            self._folders.add(folded(folder))
        for stem in _numbered(os.path.join(folder, *folders[-1:])):
            wanted = {folded(path) for _, path in outputs(stem, self._save)}
            if not wanted & (self._files | self._folders):
                break
        self._files |= wanted
        return stem


def _numbered(path: str) -> Iterator[str]:
    """The path, then its numbered variants."""
    yield path
    yield from (f"{path}~{number}" for number in count(2))
