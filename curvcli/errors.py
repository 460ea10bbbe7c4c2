"""Everything that can go wrong, one class per cause, with its exit code."""

from __future__ import annotations

import os
import traceback
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from .support.words import pluralize


class CurvcliError(Exception):
    """Base of every error that is the input's, the option's or the output's fault, never the program's."""


class UsageError(CurvcliError):
    """An option, a name or a configuration key that is not known or does not fit."""


class MissingExtraError(UsageError):
    """A feature whose optional packages are not installed; the message says how to install them."""


class LackingError(UsageError):
    """What an option names and a mesh lacks; of several meshes, an error of that one, which the others may have."""


class InputError(CurvcliError):
    """A mesh that is missing, cannot be read, is empty, or breaks a rule that no option relaxes.

    The text is one line: `path: place: what was found, what was expected; the way out`.
    """

    def __init__(self, problem: str, *, path: str | None = None, place: str | None = None, hint: str | None = None):
        self.problem, self.path, self.place, self.hint = problem, path, place, hint
        super().__init__(problem)

    def __str__(self) -> str:
        path = "''" if self.path == "" else self.path
        line = ": ".join(part for part in (path, self.place, self.problem) if part)
        return f"{line}; {self.hint}" if self.hint else line


class OutputError(CurvcliError):
    """An output that exists already, cannot be written, or would be written twice."""


class NoMatchError(CurvcliError):
    """A pattern that no file matched."""


def defect(error: BaseException) -> str:
    """What is said of an exception that none of these classes explains, and where it was raised."""
    where = traceback.extract_tb(error.__traceback__)[-1]
    place = f"{os.path.basename(where.filename)}:{where.lineno}"
    return f"internal error: {type(error).__name__}: {error} ({place})"


@dataclass(frozen=True)
class Notice:
    """Something accepted but worth knowing: a stable code, how often, in words, and the way out.

    `examples` holds the first few concerned: indices in the file's own numbering from 0, or the labels of regions.
    """

    code: str
    count: int
    message: str
    hint: str | None = None
    examples: tuple[int | str, ...] = ()

    @classmethod
    def at(cls, code: str, indices: Sequence[Any] | Any, message: str, hint: str | None = None) -> Notice:
        """A notice of what stands at these indices (an array will do); `[one|many]` in its words as there are many."""
        return cls.of(code, [int(index) for index in indices[:5]], message, hint, len(indices))

    @classmethod
    def of(cls, code: str, some: Sequence[int | str], message: str, hint: str | None, count: int) -> Notice:
        """A notice of so many, the first few of which are known."""
        words = None if hint is None else pluralize(count, hint)
        return cls(code, count, pluralize(count, message), words, tuple(some[:5]))


# The exit codes of the interface.
OK, FAILED_CHECK, USAGE, INPUT, OUTPUT, NO_MATCH, INTERNAL, INTERRUPTED = 0, 1, 2, 3, 4, 5, 70, 130

EXIT_CODES = {
    OK: "done",
    FAILED_CHECK: "a check, requirement, assertion or comparison failed; analyze and batch: only with --strict",
    USAGE: "usage, configuration, an unknown name, or an extra that is not installed",
    INPUT: "an input is missing, cannot be read or used, or has a suffix that is not promised",
    OUTPUT: "an output cannot be written or exists already",
    NO_MATCH: "no file matched a pattern",
    INTERNAL: "internal error; -vv shows the traceback",
    INTERRUPTED: "interrupted",
}

_OF_CAUSES: tuple[tuple[type[BaseException], int], ...] = (
    (UsageError, USAGE),
    (InputError, INPUT),
    (OutputError, OUTPUT),
    (NoMatchError, NO_MATCH),
)

_WORST_FIRST = (INTERNAL, OUTPUT, INPUT, FAILED_CHECK, OK)


def exit_code(error: BaseException) -> int:
    """The exit code of a cause."""
    return next((code for cause, code in _OF_CAUSES if isinstance(error, cause)), INTERNAL)


def exit_code_of_one(error: BaseException) -> int:
    """The exit code of a cause that stops one of several inputs."""
    return INPUT if isinstance(error, LackingError) else exit_code(error)


def stops_all(error: BaseException) -> bool:
    """Whether a cause lies in the options, and so in none of several inputs."""
    return isinstance(error, UsageError) and not isinstance(error, LackingError)


def worst(codes: Iterable[int]) -> int:
    """The exit code of several inputs, each of which was done, failed a check, was refused, or met a defect."""
    return min(codes, key=_WORST_FIRST.index, default=OK)
