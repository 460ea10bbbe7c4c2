"""Errors, one class per cause with its exit code, and notices."""

from __future__ import annotations

import os
import traceback
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from .support.words import pluralize


class CurvcliError(Exception):
    """Base class of errors in inputs, options and outputs; other exceptions are defects of the program."""


class UsageError(CurvcliError):
    """An unknown or unsuitable option, name or configuration key."""


class MissingExtraError(UsageError):
    """A missing optional package; the message gives the command that installs it."""


class LackingError(UsageError):
    """A region, property or scale that an option names and one mesh lacks; other meshes of the run may have it."""


class InputError(CurvcliError):
    """A mesh that is missing, cannot be read, is empty, or breaks a rule that no option relaxes.

    The text is one line: `path: place: finding, expectation; remedy`.
    """

    def __init__(self, problem: str, *, path: str | None = None, place: str | None = None, hint: str | None = None):
        self.problem, self.path, self.place, self.hint = problem, path, place, hint
        super().__init__(problem)

    def __str__(self) -> str:
        path = "''" if self.path == "" else self.path
        line = ": ".join(part for part in (path, self.place, self.problem) if part)
        return f"{line}; {self.hint}" if self.hint else line


class OutputError(CurvcliError):
    """An output that exists already, that cannot be written, or that two options name."""


class NoMatchError(CurvcliError):
    """A pattern without a matching file."""


def defect(error: BaseException) -> str:
    """The message for an exception outside these classes, with the place that raised it."""
    where = traceback.extract_tb(error.__traceback__)[-1]
    place = f"{os.path.basename(where.filename)}:{where.lineno}"
    return f"internal error: {type(error).__name__}: {error} ({place})"


@dataclass(frozen=True)
class Notice:
    """A warning about an accepted input: a stable code, a count, a message and a remedy (`hint`).

    examples: the first five places, as indices in the file's own numbering from 0 or labels of regions.
    """

    code: str
    count: int
    message: str
    hint: str | None = None
    examples: tuple[int | str, ...] = ()

    @classmethod
    def at(cls, code: str, indices: Sequence[Any] | Any, message: str, hint: str | None = None) -> Notice:
        """A notice about these indices (a sequence or an array); `[one|many]` in the texts follows their number."""
        return cls.of(code, [int(index) for index in indices[:5]], message, hint, len(indices))

    @classmethod
    def of(cls, code: str, some: Sequence[int | str], message: str, hint: str | None, count: int) -> Notice:
        """A notice with a count and the first few examples; `[one|many]` in the texts follows the count."""
        advice = None if hint is None else pluralize(count, hint)
        return cls(code, count, pluralize(count, message), advice, tuple(some[:5]))


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
    """The exit code of an exception."""
    return next((code for cause, code in _OF_CAUSES if isinstance(error, cause)), INTERNAL)


def exit_code_of_one(error: BaseException) -> int:
    """The exit code of an exception that stops one of several inputs."""
    return INPUT if isinstance(error, LackingError) else exit_code(error)


def stops_all(error: BaseException) -> bool:
    """Test whether an exception concerns the options, and so stops all inputs."""
    return isinstance(error, UsageError) and not isinstance(error, LackingError)


def worst(codes: Iterable[int]) -> int:
    """The exit code of several inputs: the most severe of theirs."""
    return min(codes, key=_WORST_FIRST.index, default=OK)
