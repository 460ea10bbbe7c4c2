"""Defaults of options from `[tool.curvcli]` of pyproject.toml or from curvcli.toml, one table per command."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from typing import Any

import click

from ..errors import UsageError
from .config_search import SHARED, search

# Keys under which the context keeps the configuration file that applies, and its tables.
META = "curvcli.configuration"

# Largest size of a configuration in bytes, and most parts of a dotted key: far more than any needs.
_LARGEST, _DEEPEST = 1 << 20, 64
_QUOTED, _BETWEEN_KEYS = re.compile(rb"\"[^\"]*\"|'[^']*'"), re.compile(rb"[,=#\[\]{}]")

# Options that set no default.
_NOT_DEFAULTS = ("help", "schema")

# Parameters that only the command line may set: files that are written, files and addresses that are read, and
# --force. A configuration may have come with a download.
_OUTPUTS = ("output", "outputs", "folder", "tables", "plots", "force")
_INPUTS = ("files_from", "scheduler")

Find = Callable[[str], click.Command | None]


def configure(context: click.Context, given: str | None, find: Find, without: bool = False) -> None:
    """Take the defaults of the commands from the file given, or else from the nearest one.

    find: a command by its name. without: no file applies. Errors: UsageError for a file that cannot be read, an unknown
    table or key (with the nearest), a value of the wrong type, a key that only the command line may set.
    """
    if without and given is not None:
        raise UsageError("--config and --no-config exclude each other")
    folder = _here()
    path = given or (None if without or folder is None else nearest(folder))
    if path is None:
        return
    tables = read(path)
    context.default_map = {name: defaults(path, name, table, find) for name, table in tables.items()}
    context.meta[META] = (path, tables)


def _here() -> str | None:
    """The working folder; None if it was removed: it then has no configuration."""
    try:
        return os.getcwd()
    except OSError:
        return None


def nearest(folder: str) -> str | None:
    """The nearest curvcli.toml, or pyproject.toml with [tool.curvcli], in a folder or one above it."""
    return search(folder, _table)


def read(path: str) -> dict[str, Any]:
    """The tables of a configuration file, by command.

    Errors: UsageError.
    """
    tables = _table(path)
    if tables is None:
        raise UsageError(f"{path}: there is no table [tool.curvcli] in it")
    return tables


def _table(path: str) -> dict[str, Any] | None:
    import tomllib

    try:
        with open(path, "rb") as stream:
            text = stream.read(_LARGEST + 1)
        _check_size(path, text)
        content = tomllib.loads(text.decode("utf-8"))
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


def _check_size(path: str, text: bytes) -> None:
    """Errors: UsageError for long dotted keys: parsing n parts takes n² time and memory."""
    if len(text) > _LARGEST:
        raise UsageError(f"{path}: more than {_LARGEST >> 10} kB, which no configuration needs")
    for number, line in enumerate(text.splitlines(), 1):
        if line.count(b".") > _DEEPEST:
            keys = _BETWEEN_KEYS.split(_QUOTED.sub(b"", line).replace(b"..", b""))
            if max(key.count(b".") for key in keys) > _DEEPEST:
                raise UsageError(f"{path}: line {number}: a key of more than {_DEEPEST} parts, of which none is known")


def heading(path: str, command: str) -> str:
    """Heading of a command's table in a configuration file."""
    return f"[tool.curvcli.{command}]" if os.path.basename(path) == SHARED else f"[{command}]"


def defaults(path: str, name: str, table: Any, find: Find) -> dict[str, Any]:
    """The defaults of one command by the names of its parameters, every value checked against its option.

    Errors: UsageError that names file and key.
    """
    from ..support.words import suggestion
    from .names import COMMANDS

    command = find(name)
    if command is None:
        if not isinstance(table, dict):
            hint = f"keys belong to the table of a command, such as {heading(path, 'analyze')}"
            raise UsageError(f"{path}: {name}: stands in no table; {hint}")
        way_out = suggestion(name, COMMANDS, "`curvcli --help` lists them")
        raise UsageError(f"{path}: {heading(path, name)}: there is no such command{way_out}")
    if not isinstance(table, dict):
        raise UsageError(f"{path}: {name}: expected a table, headed {heading(path, name)}")
    options = {key: option for option in _options(command) for key in _keys(option)}
    values: dict[str, Any] = {}
    for key, value in table.items():
        place = f"{path}: {heading(path, name)} {key}"
        option = options.get(key.replace("_", "-"))
        if option is None or option.name is None:
            way_out = suggestion(key.replace("_", "-"), options, f"`curvcli {name} --help` lists them")
            raise UsageError(f"{place}: there is no such option{way_out}")
        _refuse(option.name, value, place)
        if option.name in values:
            raise UsageError(f"{place}: is given twice in two spellings")
        values[option.name] = _checked(option, value, place)
    return values


def _refuse(name: str, value: Any, place: str) -> None:
    """Errors: UsageError for a parameter that only the command line may set."""
    if name in _OUTPUTS:
        raise UsageError(f"{place}: a configuration names no outputs and overwrites none; give it on the command line")
    if name in _INPUTS:
        raise UsageError(f"{place}: a configuration names no inputs; give it on the command line")
    if name == "regions":
        for label in value if isinstance(value, list) else [value]:
            if isinstance(label, str) and (os.path.basename(label) != label or os.path.splitext(label)[1]):
                raise UsageError(f"{place}: a configuration names no files of labels; give it on the command line")


def _options(command: click.Command) -> list[click.Option]:
    return [
        parameter
        for parameter in command.params
        if isinstance(parameter, click.Option) and parameter.name not in _NOT_DEFAULTS
    ]


def _keys(option: click.Option) -> list[str]:
    return [name.removeprefix("--") for name in option.opts if name.startswith("--")]


def _checked(option: click.Option, value: Any, place: str) -> Any:
    """A value as click's default_map takes it."""
    if not option.multiple:
        return _one(option, value, place)
    if isinstance(value, dict) and "=" in (option.metavar or ""):
        # A table of names and values, such as [tool.curvcli.check.sets].
        return tuple(f"{name}={_joined(option, entry, f'{place} {name}')}" for name, entry in value.items())
    values = value if isinstance(value, list) else [value]
    return tuple(_one(option, entry, place) for entry in values)


def _joined(option: click.Option, value: Any, place: str) -> str:
    """A value of a table, or the comma list of several."""
    values = value if isinstance(value, list) else [value]
    return ",".join(str(_one(option, entry, place)) for entry in values)


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
