"""Files that match a pattern with wildcards: each folder is visited once and each file named once, despite links."""

from __future__ import annotations

import fnmatch
import os
import re
from collections import deque
from collections.abc import Callable, Iterator
from typing import NamedTuple

from ..loading.registry import suffixes

_PACKED = ".gz"
_WILD = re.compile(r"[*?[]")
_ALL = "**"


class _Visit(NamedTuple):
    """Folder to match against the parts of the pattern from `part` on, and the number of links on the way."""

    folder: str
    part: int
    links: int


def is_wild(part: str) -> bool:
    """True if a part of a path is a pattern."""
    return bool(_WILD.search(part))


def files_of(pattern: str) -> list[str]:
    """Files, sorted by their names; `*` and `?` match no leading dot, `**` matches any number of folders, and
    suffixes of meshes match in any case and packed too (`spellings`).

    A folder that several links lead to, or a link to a folder above itself, is visited once, and a file with several
    names is named once: by a name without links if there is one, else by the first. So the work is proportional to
    the folders times the parts of the pattern. Folders that cannot be listed are left out.
    """
    drive, rest = os.path.splitdrive(pattern)
    segments = [part for part in re.split(r"[/\\\\]" if os.sep == "\\" else "/", rest) if part]
    if not segments or rest.endswith(("/", os.sep)):
        return []
    root = drive + os.sep if rest.startswith(("/", os.sep)) else drive
    named: dict[str, tuple[int, str]] = {}
    of_folder: dict[str, str] = {}
    for path, links in _matches(root, segments):
        file, name = real_path(path, of_folder), (links, path)
        named[file] = min(named.get(file, name), name)
    return sorted(path for _, path in named.values())


def real_path(path: str, of_folder: dict[str, str]) -> str:
    """Path without links; those of folders are cached, for many files lie in one."""
    if os.path.islink(path):
        return os.path.realpath(path)
    folder, name = os.path.split(path)
    if folder not in of_folder:
        of_folder[folder] = os.path.realpath(folder)
    return os.path.join(of_folder[folder], name)


def _matches(root: str, segments: list[str]) -> Iterator[tuple[str, int]]:
    """Every file that matches, and the number of links on the way; folders are visited by the fewest."""
    seen: set[tuple[int, int, int]] = set()
    todo = deque([_Visit(root, 0, 0)])
    tests = [_test([part]) for part in segments[:-1]] + [_test(spellings(segments[-1]))]
    while todo:
        visit = todo.popleft()
        folder, part, links = visit
        try:
            status = os.stat(folder or os.curdir)
        except (OSError, ValueError):
            continue
        state = (status.st_dev, status.st_ino, part)
        if state in seen:
            continue
        seen.add(state)
        last = part == len(segments) - 1
        if not is_wild(segments[part]):
            path = os.path.join(folder, segments[part])
            if not os.path.isdir(path):
                if last and os.path.lexists(path):
                    yield path, links + os.path.islink(path)
            elif not last:
                _later(todo, visit, path, part + 1, os.path.islink(path))
            continue
        deep = segments[part] == _ALL
        if deep and not last:
            todo.appendleft(_Visit(folder, part + 1, links))
        for name, is_folder, is_link in _listed(folder or os.curdir):
            if not tests[part](name):
                continue
            path = os.path.join(folder, name)
            if is_folder and (deep or not last):
                _later(todo, visit, path, part if deep else part + 1, is_link)
            elif not is_folder and last:
                yield path, links + is_link


def _later(todo: deque[_Visit], visit: _Visit, path: str, part: int, is_link: bool) -> None:
    """Queue a folder found in another one: before all that lie behind one link more."""
    visit_later = _Visit(path, part, visit.links + is_link)
    if is_link:
        todo.append(visit_later)
    else:
        todo.appendleft(visit_later)


def spellings(part: str) -> list[str]:
    """Patterns for a part that ends with the suffix of a mesh, in any case and packed too; else the part itself.

    `*.ply` matches `A.PLY` and `b.ply.gz`, `*.ply.gz` only packed files.
    """
    packed = part[-len(_PACKED) :] if part.lower().endswith(_PACKED) else ""
    stem, dot, suffix = part.removesuffix(packed).rpartition(".")
    if not dot or suffix.lower() not in suffixes():
        return [part]
    packed_off = f"{stem}.{_any_case(suffix)}"
    unpacked = [] if packed else [packed_off]
    return [*unpacked, f"{packed_off}{_any_case(_PACKED)}"]


def _any_case(letters: str) -> str:
    return "".join(f"[{c.lower()}{c.upper()}]" if c.isalpha() else c for c in letters)


def _test(patterns: list[str]) -> Callable[[str], bool]:
    """Function that is true for names that match one of these patterns for a part."""
    fits = re.compile("|".join(fnmatch.translate(os.path.normcase(pattern)) for pattern in patterns)).match
    hidden = patterns[0].startswith(".")
    return lambda name: (hidden or not name.startswith(".")) and fits(os.path.normcase(name)) is not None


def _listed(folder: str) -> list[tuple[str, bool, bool]]:
    """Entries of a folder in the order of their names, each with whether it is a folder and whether it is a link."""
    listing = []
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                try:
                    listing.append((entry.name, entry.is_dir(), entry.is_symlink()))
                except OSError:
                    listing.append((entry.name, False, True))
    except OSError:
        return []
    return sorted(listing)
