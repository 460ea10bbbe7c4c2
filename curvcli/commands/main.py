"""The entry point: finds the command without importing the others, and turns causes into exit codes."""

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
from .configured import blamed
from .deferred import defer_imports
from .names import COMMANDS, COMPLETE, UNCONFIGURED
from .signals import Ending, Handler
from .streams import complete, settle
from .talk import internal, say


@contextmanager
def _aborting() -> Iterator[None]:
    """An interrupt is told once, without the blank line that click puts before it."""
    try:
        yield
    except KeyboardInterrupt:
        if sys.stderr.isatty():
            click.echo(err=True)  # after the terminal's ^C
        raise click.Abort from None


class LazyGroup(click.Group):
    """A group whose commands are imported when they are named."""

    def make_context(self, *arguments: Any, **settings: Any) -> click.Context:
        """Read the options; interrupted as in `invoke`."""
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
                # The parser of click, which misses the value of an option, does not say whose option it is.
                error.ctx = click.Context(own, parent=ctx, info_name=name)
            if META in ctx.meta:
                raise blamed(ctx, error) from error
            raise

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The commands in the order of the help."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import one command."""
        if cmd_name not in COMMANDS:
            return None
        found: click.Command = import_module(f"curvcli.commands.{cmd_name}").command
        return (
            import_module("curvcli.commands.completion.candidates").completing(found)
            if ctx.resilient_parsing
            else found
        )

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Name the nearest commands when there is no such command."""
        name = args[0] if args else ""
        if name and not name.startswith("-") and name not in COMMANDS:
            from ..support.words import suggestion

            way_out = suggestion(name, COMMANDS, "`curvcli --help` lists them")
            raise click.UsageError(f"no such command {name!r}{way_out}", ctx)
        told = name in UNCONFIGURED or set(args).intersection(ctx.help_option_names)
        if not ctx.resilient_parsing and not told:
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
    help="Defaults of options, one table per command; else [tool.curvcli] of the nearest pyproject.toml, or "
    "curvcli.toml, in this folder or above, up to the repository's root or the home folder.",
)
@click.option("--no-config", is_flag=True, help="Take no defaults from any file.")
def cli(config: str | None, no_config: bool) -> None:
    """Curvatures of triangle meshes (OBJ, PLY, STL) that keep their integral relations exactly.

    Gauss and mean curvature, areas and Willmore energies at every vertex, after J. M. Sullivan,
    Curvatures of Smooth and Discrete Surfaces; each with the identity that proves it, checked.

    \b
      curvcli analyze bunny.obj                      a summary with its checks
      curvcli analyze bunny.obj -o k.csv -o k.ply    a table and a coloured mesh
      curvcli check bunny.obj --require closed       what holds and what fails
      curvcli passes                                 every quantity there is
      curvcli sample torus -o torus.ply              a surface to try it on
      curvcli help                                   topics, such as conventions
    """


def main(early: Handler | None = None, heard: Sequence[int] = ()) -> NoReturn:
    """Run curvcli and exit with the code of the interface.

    early: what has listened for Ctrl-C so far, and `heard` holds what it heard.
    """
    # All our matrices are small: threads would only reserve memory, with many processors more than a limit allows.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    complete()
    ending = Ending()
    ending.expect(early)
    try:
        if heard:
            raise KeyboardInterrupt
        if COMPLETE in os.environ:
            import_module("curvcli.commands.completion.scripts")
        result = cli.main(complete_var=COMPLETE, standalone_mode=False)
        code = result if isinstance(result, int) else OK
        sys.stdout.flush()
    except BaseException as error:
        ending.too_late()
        code = explain(error) if ending.number is None else interrupted(ending)
    ending.too_late()
    refusal = settle(ending.number is not None)
    if refusal is not None and code in (OK, FAILED_CHECK, INPUT):  # nobody has told it
        code = explain(refusal)
    sys.exit(code)


def interrupted(ending: Ending) -> int:
    """Say so; the exit code."""
    if not ending.adopted:
        say("interrupted")
    return ending.code


def explain(error: BaseException) -> int:
    """Say in one line why the program ends; the exit code."""
    if is_bounded() and is_out_of_memory(error):
        error = InputError("needs more memory than --max-memory allows", hint="a larger limit takes it")
    match error:
        case click.exceptions.Exit():
            return error.exit_code
        case SystemExit(code=None | int() as code):  # click ends so when it has completed a line of the shell
            return code or OK
        case click.exceptions.NoArgsIsHelpError():
            click.echo(error.format_message(), err=True)
            return USAGE
        case click.UsageError():
            path = error.ctx.command_path if error.ctx else "curvcli"
            say(f"{error.format_message().rstrip('.')}; `{path} --help` tells more")
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
        say("out of memory; a machine with more memory, or a smaller mesh, is needed")
    else:
        say(internal(error))
    return INTERNAL
