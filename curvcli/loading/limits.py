"""Limits that are checked before anything large is allocated."""

from __future__ import annotations

from ..errors import InputError
from ..plurals import number_of


def check_faces(found: int, allowed: int | None) -> None:
    """Errors: InputError for more faces than allowed (None: any number)."""
    if allowed is not None and found > allowed:
        raise InputError(
            f"{number_of(found, 'face')} found, at most {allowed} allowed", hint="--max-faces sets the limit"
        )
