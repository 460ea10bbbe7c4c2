"""What a configuration file has to do with a verdict, in every report and in one sentence."""

from __future__ import annotations

import json
from typing import Any

import msgspec

from ..support.words import escape_text


class Configuration(msgspec.Struct, frozen=True):
    """The configuration file that applied and what it set that a verdict can depend on, by the names of options."""

    file: str
    sets: dict[str, Any]

    @property
    def sentence(self) -> str:
        """For people, on one line."""
        return escape_text(f"configuration: {self.file} sets {self.words}")

    @property
    def words(self) -> str:
        """Every option with its value."""
        return escape_text(
            ", ".join(f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in self.sets.items())
        )


Configured = Configuration | msgspec.UnsetType
"""The field of a report; absent where no configuration file has to do with the verdict."""


def configured(found: Configuration | None) -> Configured:
    """The field of a report."""
    return msgspec.UNSET if found is None else msgspec.structs.replace(found, file=escape_text(found.file))


def sentence(found: Configured) -> str | None:
    """The sentence of a field, None where it is absent."""
    return None if isinstance(found, msgspec.UnsetType) else found.sentence
