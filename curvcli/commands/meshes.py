"""Read the meshes of a command one after the other: an error in one does not stop the others."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import BinaryIO, TypeVar

from ..errors import CurvcliError, LackingError, exit_code, exit_code_of_one, stops_all
from ..support.memory import is_out_of_memory, trim_heap
from .talk import internal, say

_Made = TypeVar("_Made")


def input_of(path: str) -> str | BinaryIO:
    """The path, or stdin for `-`."""
    return sys.stdin.buffer if path == "-" else path


def each_mesh(
    meshes: Sequence[str],
    work: Callable[[int], _Made],
    failed: Callable[[str, str, int], _Made],
    alone: type[CurvcliError] = CurvcliError,
) -> list[_Made]:
    """The result of every mesh; the error of a mesh is one line on stderr.

    work: the work on a mesh, from its number. failed: the result of a mesh that ends in an error, from its path, the
    message and the exit code. alone: errors that end the command where it has one mesh only.
    Errors: those that end the command, such as an output that cannot be written or too little memory.
    """
    single, made = len(meshes) == 1, []
    for number, mesh in enumerate(meshes):
        trim_heap()  # the memory of the mesh before
        try:
            made.append(work(number))
        except CurvcliError as error:
            if stops_all(error) or (single and isinstance(error, alone)):
                raise
            message = str(error).removeprefix(f"{mesh}: ")
            say(f"{mesh}: {message}" if isinstance(error, LackingError) else str(error))
            made.append(failed(mesh, message, exit_code_of_one(error)))
        except (MemoryError, OSError):
            raise
        except Exception as error:
            if single or is_out_of_memory(error):
                raise
            message = internal(error)
            say(f"{mesh}: {message}")
            made.append(failed(mesh, message, exit_code(error)))
    return made
