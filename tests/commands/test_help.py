"""Help and version: there for every command, and without waiting for numpy."""

from __future__ import annotations

import subprocess
import sys

import pytest

import curvcli as package
from curvcli.commands.main import cli
from curvcli.commands.names import COMMANDS
from tests.helpers.cli.program import curvcli, environment

HEAVY = ("numpy", "scipy", "trimesh", "polars", "rich", "msgspec")


@pytest.mark.parametrize("option", ["--version", "-V"])
def test_the_version_is_printed(option: str) -> None:
    assert curvcli(option) == (0, f"curvcli {package.__version__}\n", "")


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_lists_the_commands(option: str) -> None:
    ended = curvcli(option)
    assert (ended.code, ended.err) == (0, "")
    for name in COMMANDS:
        assert f"\n  {name}" in ended.out


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_for_every_option(name: str) -> None:
    import click

    command = cli.get_command(click.Context(cli), name)
    assert command is not None
    assert command.help
    assert command.short_help
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            assert parameter.help, parameter.name
    ended = curvcli(name, "--help", COLUMNS="80")
    assert (ended.code, ended.err) == (0, "")
    assert ended.out.startswith("Usage: ")
    assert max(map(len, ended.out.splitlines())) <= 80


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["analyze", "--help"], ["passes", "--help"]])
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    program = (
        "import sys\n"
        f"sys.argv = ['curvcli', *{arguments!r}]\n"
        "from curvcli.commands.main import main\n"
        "try:\n    main()\n"
        "except SystemExit as end:\n    code = end.code\n"
        f"print('heavy:', *(name for name in {HEAVY!r} if name in sys.modules))\n"
        "sys.exit(code)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment())
    assert done.returncode == 0
    assert done.stdout.splitlines()[-1].split() == ["heavy:"]


def test_importing_the_package_imports_nothing_heavy() -> None:
    program = f"import sys, curvcli; print(*(name for name in {HEAVY!r} if name in sys.modules))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment())
    assert (done.returncode, done.stdout) == (0, "\n")


def test_no_command_at_all() -> None:
    ended = curvcli()
    assert (ended.code, ended.out) == (2, "")
    assert ended.err.startswith("Usage: ")
