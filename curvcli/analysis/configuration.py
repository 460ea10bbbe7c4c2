"""The configuration file that a verdict depends on, as a field of reports and as a sentence."""

from __future__ import annotations

import json
from typing import Any

import msgspec

from ..support.words import escape_text


class Configuration(msgspec.Struct, frozen=True):
    """Configuration file that applied, with the settings that a verdict can depend on, by the names of options."""

    file: str
    sets: dict[str, Any]

    @property
    def sentence(self) -> str:
        """One line for people."""
        return escape_text(f"configuration: {self.file} sets {self.settings}")

    @property
    def settings(self) -> str:
        """Every option with its value."""
        return escape_text(
            ", ".join(f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in self.sets.items())
        )


Configured = Configuration | msgspec.UnsetType
"""Field of a report; absent where the verdict does not depend on a configuration file."""


def configured(configuration: Configuration | None) -> Configured:
    """Configuration as the field of a report."""
    return (
        msgspec.UNSET
        if configuration is None
        else msgspec.structs.replace(configuration, file=escape_text(configuration.file))
    )


def sentence(field: Configured) -> str | None:
    """Sentence for a field of a report; None where it is absent."""
    return None if isinstance(field, msgspec.UnsetType) else field.sentence
