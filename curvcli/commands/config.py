"""Defaults of options from `[tool.curvcli]` of pyproject.toml or from curvcli.toml, one table per command."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any

import click

from ..errors import UsageError
from .talk import say

OWN, SHARED = "curvcli.toml", "pyproject.toml"

# Where the context remembers which file applied, and which tables it has.
META = "curvcli.configuration"

# Options that do something else than set a default.
_NOT_DEFAULTS = ("help", "schema")

Find = Callable[[str], click.Command | None]


def configure(context: click.Context, given: str | None, find: Find) -> None:
    """Take the defaults of the commands from the file given, or from the nearest one upward, if there is any.

    find: a command by its name. Errors: UsageError for a file that cannot be read, an unknown table or key (with the
    nearest), a value of the wrong type.
    """
    path = given or nearest(_here())
    if path is None:
        return
    tables = read(path)
    context.default_map = {name: defaults(path, name, table, find) for name, table in tables.items()}
    context.meta[META] = (path, tables)


def _here() -> str:
    """The working folder; the root of all where somebody has removed it."""
    try:
        return os.getcwd()
    except OSError:
        return os.path.abspath(os.sep)


def nearest(folder: str) -> str | None:
    """The nearest curvcli.toml, or pyproject.toml that speaks of curvcli, in a folder or one above it."""
    while True:
        own, shared = (os.path.join(folder, name) for name in (OWN, SHARED))
        if os.path.isfile(own):
            return own
        if os.path.isfile(shared) and _has_table(shared):
            return shared
        above = os.path.dirname(folder)
        if above == folder:
            return None
        folder = above


def _has_table(path: str) -> bool:
    # Most such files never name us; those are not even parsed.
    try:
        with open(path, "rb") as stream:
            return b"curvcli" in stream.read() and _table(path) is not None
    except OSError:
        return False


def read(path: str) -> dict[str, Any]:
    """The tables of a configuration file, by command.

    Errors: UsageError.
    """
    found = _table(path)
    if found is None:
        raise UsageError(f"{path}: there is no table [tool.curvcli] in it")
    return found


def _table(path: str) -> dict[str, Any] | None:
    import tomllib

    try:
        with open(path, "rb") as stream:
            content = tomllib.load(stream)
    except OSError as error:
        raise UsageError(f"{path}: the configuration cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError) as error:  # also for numbers of more digits than Python turns into an int
        raise UsageError(f"{path}: the configuration is not TOML: {error}") from None
    if os.path.basename(path) != SHARED:
        return content
    tool = content.get("tool")
    table = tool.get("curvcli") if isinstance(tool, dict) else None
    if table is not None and not isinstance(table, dict):
        raise UsageError(f"{path}: tool.curvcli: expected one table per command, such as [tool.curvcli.check]")
    return table


def heading(path: str, command: str) -> str:
    """How a command's table is headed in a file."""
    return f"[tool.curvcli.{command}]" if os.path.basename(path) == SHARED else f"[{command}]"


def defaults(path: str, name: str, table: Any, find: Find) -> dict[str, Any]:
    """The defaults of one command by the names of its parameters, every value checked against its option.

    Errors: UsageError that names file and key.
    """
    from .main import COMMANDS

    command = find(name)
    if command is None:
        if not isinstance(table, dict):
            hint = f"keys belong to the table of a command, such as {heading(path, 'analyze')}"
            raise UsageError(f"{path}: {name}: stands in no table; {hint}")
        raise UsageError(f"{path}: {heading(path, name)}: there is no such command; {_near(name, COMMANDS)}")
    if not isinstance(table, dict):
        raise UsageError(f"{path}: {name}: expected a table, headed {heading(path, name)}")
    options = {key: option for option in _options(command) for key in _keys(option)}
    found: dict[str, Any] = {}
    for key, value in table.items():
        place = f"{path}: {heading(path, name)} {key}"
        option = options.get(key.replace("_", "-"))
        if option is None or option.name is None:
            raise UsageError(f"{place}: there is no such option; {_near(key.replace('_', '-'), options)}")
        if option.name in found:
            raise UsageError(f"{place}: is given twice in two spellings")
        found[option.name] = _checked(option, value, place)
    return found


def _near(name: str, known: Iterable[str]) -> str:
    from difflib import get_close_matches

    known = list(known)
    return f"nearest: {', '.join(get_close_matches(name, known, 3, 0.4) or known)}"


def _options(command: click.Command) -> list[click.Option]:
    return [one for one in command.params if isinstance(one, click.Option) and one.name not in _NOT_DEFAULTS]


def _keys(option: click.Option) -> list[str]:
    return [name.removeprefix("--") for name in option.opts if name.startswith("--")]


def _checked(option: click.Option, value: Any, place: str) -> Any:
    """A value as click's default_map takes it."""
    if not option.multiple:
        return _one(option, value, place)
    values = value if isinstance(value, list) else [value]
    return tuple(_one(option, entry, place) for entry in values)


def _one(option: click.Option, value: Any, place: str) -> Any:
    if option.is_flag:
        kind, fits = "true or false", isinstance(value, bool)
    elif option.count or isinstance(option.type, click.types.IntParamType):
        kind, fits = "a whole number", isinstance(value, int) and not isinstance(value, bool)
    elif isinstance(option.type, click.types.FloatParamType):
        kind, fits = "a number", isinstance(value, int | float) and not isinstance(value, bool)
    else:
        kind, fits = "a string", isinstance(value, str)
    if not fits:
        kind += " or a list of them" if option.multiple else ""
        raise UsageError(f"{place}: is {value!r}, expected {kind}")
    try:
        option.type.convert(value, option, None)
    except click.BadParameter as error:
        raise UsageError(f"{place}: {error.message.rstrip('.')}") from None
    return value


def tell(context: click.Context) -> None:
    """Say on stderr which file applies to a command."""
    path, tables = context.meta.get(META, (None, {}))
    if path is not None:
        name = context.command.name or ""
        keys = ", ".join(tables.get(name, {}))
        say(f"configuration: {path}: " + (f"{heading(path, name)} sets {keys}" if keys else f"nothing for {name}"))


def blamed(context: click.Context, error: click.UsageError | UsageError) -> click.UsageError | UsageError:
    """The refusal of a command's options, with a word on which of them the file sets."""
    path, tables = context.meta[META]
    name = context.invoked_subcommand or ""
    keys = ", ".join(tables.get(name, {}))
    if not keys:
        return error
    note = f"; {heading(path, name)} of {path} sets {keys}"
    if isinstance(error, click.UsageError):
        return click.UsageError(error.format_message().rstrip(".") + note, error.ctx)
    return UsageError(f"{error}{note}")
