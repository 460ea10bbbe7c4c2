"""The exit codes of the interface: of which cause, and of several inputs."""

from __future__ import annotations

from collections.abc import Iterable

from .errors import InputError, LackingError, NoMatchError, OutputError, UsageError

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
