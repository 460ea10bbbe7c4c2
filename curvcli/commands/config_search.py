"""Search for the configuration file that applies where none is named."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from typing import Any

OWN, SHARED = "curvcli.toml", "pyproject.toml"

# Mark of a repository's root; a file in worktrees and submodules.
_REPOSITORY = ".git"


def search(folder: str, table: Callable[[str], Any]) -> str | None:
    """The nearest curvcli.toml, or pyproject.toml with [tool.curvcli], in a folder or one above it.

    The search ends at the root of the repository, else at the home folder, and before a world-writable folder above,
    such as /tmp. table: returns the [tool.curvcli] table of a pyproject.toml.
    """
    home = os.path.realpath(os.path.expanduser("~"))
    while True:
        own, shared = (os.path.join(folder, name) for name in (OWN, SHARED))
        if os.path.isfile(own):
            return own
        if os.path.isfile(shared) and _has_table(shared, table):
            return shared
        above = os.path.dirname(folder)
        ends = os.path.lexists(os.path.join(folder, _REPOSITORY)) or os.path.realpath(folder) == home
        if ends or above == folder or _anybody_writes(above):
            return None
        folder = above


def _anybody_writes(folder: str) -> bool:
    try:
        return os.name == "posix" and bool(os.stat(folder).st_mode & stat.S_IWOTH)
    except OSError:
        return True


def _has_table(path: str, table: Callable[[str], Any]) -> bool:
    # Most such files never name us; those are not even parsed.
    try:
        with open(path, "rb") as stream:
            return b"curvcli" in stream.read() and table(path) is not None
    except OSError:
        return False
