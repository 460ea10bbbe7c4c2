"""Checks of limits and options before any reading or allocation."""

from __future__ import annotations

import math

from ..errors import InputError, UsageError
from ..support.words import number_of


def check_faces(faces: int, allowed: int | None) -> None:
    """Raise InputError for more faces than allowed (None: any number)."""
    if allowed is not None and faces > allowed:
        raise InputError(
            f"{number_of(faces, 'face')} found, at most {allowed} allowed", hint="--max-faces sets the limit"
        )


def parse_weld(weld: str | float) -> str | float:
    """Parse `--weld`: `auto`, `none`, `exact`, or a tolerance relative to the diagonal of the bounding box.

    Errors: UsageError for any other value.
    """
    if isinstance(weld, str) and weld in ("auto", "none", "exact"):
        return weld
    try:
        tolerance = float(weld)
    except ValueError:
        tolerance = math.nan
    if not 0 < tolerance < 1:
        raise UsageError(f"--weld {weld}: expected auto, none, exact or a tolerance between 0 and 1")
    return tolerance
