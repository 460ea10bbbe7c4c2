"""Entry point: import the command that is run, without the others, and turn errors into exit codes."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from typing import Any, NoReturn

import click

from .._version import __version__
from ..errors import (
    FAILED_CHECK,
    INPUT,
    INTERNAL,
    INTERRUPTED,
    OK,
    USAGE,
    CurvcliError,
    InputError,
    UsageError,
    exit_code,
)
from ..support.memory import NUMPY, is_bounded, is_out_of_memory, require
from .allocation import keep_memory
from .config import META, configure
from .config_notes import with_configuration
from .deferred import defer_imports
from .names import COMMANDS, COMPLETE, UNCONFIGURED
from .signals import Ending, Handler
from .streams import complete, settle
from .talk import internal, say


@contextmanager
def _aborting() -> Iterator[None]:
    """Print one line for an interrupt, without the blank line that click prints before it."""
    try:
        yield
    except KeyboardInterrupt:
        if sys.stderr.isatty():
            click.echo(err=True)  # after the terminal's ^C
        raise click.Abort from None


class LazyGroup(click.Group):
    """Group that imports a command when it is named."""

    def make_context(self, *arguments: Any, **settings: Any) -> click.Context:
        """Read the options; handle interrupts as `invoke` does."""
        with _aborting():
            return super().make_context(*arguments, **settings)

    def invoke(self, ctx: click.Context) -> object:
        """Run the command."""
        try:
            with _aborting():
                return super().invoke(ctx)
        except (click.UsageError, UsageError) as error:
            name = ctx.invoked_subcommand
            if (
                isinstance(error, click.UsageError)
                and error.ctx is None
                and name
                and (own := self.get_command(ctx, name))
            ):
                # click's parser finds that a value is missing, but its error does not name the command.
                error.ctx = click.Context(own, parent=ctx, info_name=name)
            if META in ctx.meta:
                raise with_configuration(ctx, error) from error
            raise

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Commands in the order of the help."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import one command."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = import_module(f"curvcli.commands.{cmd_name}").command
        return import_module("curvcli.commands.candidates").completing(command) if ctx.resilient_parsing else command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Suggest the nearest commands when there is no such command."""
        name = args[0] if args else ""
        if name and not name.startswith("-") and name not in COMMANDS:
            from ..support.words import suggestion

            way_out = suggestion(name, COMMANDS, "`curvcli --help` lists them")
            raise click.UsageError(f"no such command {name!r}{way_out}", ctx)
        skipped = name in UNCONFIGURED or set(args).intersection(ctx.help_option_names)
        if not ctx.resilient_parsing and not skipped:
            find: Callable[[str], click.Command | None] = lambda command: self.get_command(ctx, command)  # noqa: E731
            configure(ctx, ctx.params.get("config"), find, ctx.params.get("no_config", False))
        require(NUMPY)
        keep_memory()
        defer_imports()
        return super().resolve_command(ctx, args)


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, "-V", "--version", message="curvcli %(version)s")
@click.option(
    "--config",
    metavar="FILE",
    help="Defaults of options, one table per command; default: [tool.curvcli] of the nearest pyproject.toml, or "
    "curvcli.toml, in this folder or above, up to the repository's root or the home folder.",
)
@click.option("--no-config", is_flag=True, help="Ignore configuration files.")
def cli(config: str | None, no_config: bool) -> None:
    """Curvatures of triangle meshes with exact integral identities.

    Gauss and mean curvature, areas and Willmore energies at every vertex, after J. M. Sullivan, Curvatures of
    Smooth and Discrete Surfaces. Every run checks the identities that prove them.

    \b
      curvcli analyze bunny.obj                      a summary with its checks
      curvcli analyze bunny.obj -o k.csv -o k.ply    a table and a coloured mesh
      curvcli check bunny.obj --require closed       pass or fail, for CI
      curvcli passes                                 list every quantity
      curvcli sample torus -o torus.ply              a test surface
      curvcli help                                   topics, such as conventions
    """


def main(early: Handler | None = None, heard: Sequence[int] = ()) -> NoReturn:
    """Run curvcli and exit with the code of the interface.

    early: the handler that has listened for Ctrl-C so far; `heard` holds the signals it got.
    """
    # All our matrices are small: BLAS threads would only reserve memory, with many processors more than a limit allows,
    # and take 7 % more CPU time on a small mesh.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    complete()
    ending = Ending()
    ending.expect(early)
    try:
        if heard:
            raise KeyboardInterrupt
        if COMPLETE in os.environ:
            import_module("curvcli.commands.completion")
        result = cli.main(complete_var=COMPLETE, standalone_mode=False)
        code = result if isinstance(result, int) else OK
        sys.stdout.flush()
    except BaseException as error:
        ending.too_late()
        code = explain(error) if ending.number is None else interrupted(ending)
    ending.too_late()
    refusal = settle(ending.number is not None)
    if refusal is not None and code in (OK, FAILED_CHECK, INPUT):  # not reported yet
        code = explain(refusal)
    sys.exit(code)


def interrupted(ending: Ending) -> int:
    """Print that the program was interrupted; return the exit code."""
    if not ending.adopted:
        say("interrupted")
    return ending.code


def explain(error: BaseException) -> int:
    """Print in one line why the program ends; return the exit code."""
    if is_bounded() and is_out_of_memory(error):
        error = InputError("needs more memory than --max-memory allows", hint="raise the limit")
    match error:
        case click.exceptions.Exit():
            return error.exit_code
        case SystemExit(code=None | int() as code):  # the exit of click's shell completion
            return code or OK
        case click.exceptions.NoArgsIsHelpError():
            click.echo(error.format_message(), err=True)
            return USAGE
        case click.UsageError():
            path = error.ctx.command_path if error.ctx else "curvcli"
            say(f"{error.format_message().rstrip('.')}; `{path} --help` explains the options")
            return USAGE
        case click.ClickException():
            say(error.format_message())
            return USAGE
        case CurvcliError():
            say(str(error))
            return exit_code(error)
        case KeyboardInterrupt() | click.Abort():
            say("interrupted")
            return INTERRUPTED
    if is_out_of_memory(error):
        say("out of memory; use a machine with more memory or a smaller mesh")
    else:
        say(internal(error))
    return INTERNAL
