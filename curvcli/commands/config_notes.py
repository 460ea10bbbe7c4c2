"""Notes about the configuration file that applies: with -v, in a refusal, and in every verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from ..errors import UsageError
from .config import META, heading
from .talk import say

if TYPE_CHECKING:
    from ..analysis.configuration import Configuration

# Options that no verdict depends on, by the names of their parameters; every other one is named in the verdict.
_HARMLESS = {
    *("quiet", "verbose", "as_json", "get", "stream_format", "report_format", "precision", "unit", "save", "jobs"),
    *("resume", "color_by", "cmap", "value_range", "view", "up", "size", "background", "edges_on", "quality"),
    *("histograms", "bins", "dpi", "columns", "long"),
}


def print_configuration(context: click.Context) -> None:
    """Print on stderr the configuration file that applies to a command."""
    path, tables = context.meta.get(META, (None, {}))
    if path is not None:
        name = context.command.name or ""
        keys = ", ".join(tables.get(name, {}))
        say(f"configuration: {path}: " + (f"{heading(path, name)} sets {keys}" if keys else f"nothing for {name}"))


def with_configuration(context: click.Context, error: click.UsageError | UsageError) -> click.UsageError | UsageError:
    """An error in a command's options, with a note on the options that the file sets."""
    path, tables = context.meta[META]
    name = context.invoked_subcommand or ""
    keys = ", ".join(tables.get(name, {}))
    if not keys:
        return error
    note = f"; {heading(path, name)} of {path} sets {keys}"
    if isinstance(error, click.UsageError):
        return click.UsageError(error.format_message().rstrip(".") + note, error.ctx)
    return UsageError(f"{error}{note}")


def configuration(context: click.Context | None = None) -> Configuration | None:
    """Options that the file sets, the command line does not, and a verdict can depend on; None if there are none."""
    context = context or click.get_current_context(silent=True)
    path, tables = (None, {}) if context is None else context.meta.get(META, (None, {}))
    if context is None or path is None:
        return None
    table: dict[str, Any] = tables.get(context.command.name or "", {})
    names = {key: option.name for option in context.command.params for key in option.opts}
    sets = {}
    for key, value in table.items():
        name = names.get("--" + key.replace("_", "-"))
        if name in _HARMLESS or name is None or context.get_parameter_source(name) is not ParameterSource.DEFAULT_MAP:
            continue
        sets[key.replace("_", "-")] = value
    if not sets:
        return None
    from ..analysis.configuration import Configuration

    return Configuration(path, sets)
