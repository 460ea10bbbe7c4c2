"""`curvcli completion`: complete commands, options, files and names in the shell.

The scripts of `data/completion` run the program to get the words that can stand at the cursor. It prints words, or
`file` or `dir` where the shell completes these itself. Behind the last `=` of a word, as in `--area=mixed` or
`edges=out.csv`, the words are values; the script keeps the text before.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pkgutil import get_data
from shlex import quote

import click
from click.shell_completion import BashComplete, FishComplete, ShellComplete, ZshComplete, add_completion_class

from ..errors import OutputError, UsageError
from ..support.words import escape_text
from .names import COMPLETE
from .talk import put

SHELLS = ("bash", "zsh", "fish")

# Text between these lines is ours; nothing else of a start-up file is changed.
_BEGIN, _END = "# >>> curvcli completion >>>", "# <<< curvcli completion <<<"

_SHELL = click.argument("name", metavar="[SHELL]", required=False, type=click.Choice(SHELLS))


@click.group("completion", short_help="Install shell completion for commands, options and names.")
def command() -> None:
    """Complete commands, options, files and names of quantities in bash, zsh or fish.

    SHELL defaults to $SHELL. Every file written is printed; a start-up file of the shell gets one marked block
    at its end and is otherwise unchanged.

    \b
      curvcli completion install     write the script and start-up lines
      curvcli completion show zsh    print the script
      curvcli completion remove      remove everything that install wrote
    """


@command.command("install", short_help="Write the script and the lines that load it.")
@_SHELL
def install(name: str | None) -> int:
    """Write the script to the completion folder of the shell and, for bash and zsh, the lines that load it."""
    target = shell_of(name)
    for path, changed in write_files(target):
        put(f"{'written' if changed else 'unchanged'}: {escape_text(str(path))}\n")
    put(f"new {target.name} shells complete `curvcli`; to undo: `curvcli completion remove {target.name}`\n")
    return 0


@command.command("remove", short_help="Remove the files and lines of `install`.")
@_SHELL
def remove(name: str | None) -> int:
    """Remove the script and the lines that load it."""
    target = shell_of(name)
    for path, changed in remove_files(target):
        did = "nothing to remove" if not changed else "removed" if path == target.script else "block removed"
        put(f"{did}: {escape_text(str(path))}\n")
    return 0


@command.command("show", short_help="Print the script of a shell.")
@_SHELL
def show(name: str | None) -> int:
    """Print the script, for a start-up file that you manage yourself."""
    put(source(shell_of(name).name))
    return 0


@dataclass(frozen=True)
class Shell:
    """script: the completion script. start_up: the file that loads it. lines: the lines for that."""

    name: str
    script: str
    start_up: str | None = None
    lines: tuple[str, ...] = ()

    @property
    def block(self) -> str:
        """Text of the block in the start-up file; the blank line before it ends a continued line."""
        return "\n".join(["", _BEGIN, *self.lines, _END, ""])


def shell_of(name: str | None) -> Shell:
    """The shell of that name, or of $SHELL.

    Errors: UsageError for one that is not known.
    """
    shell_name = name or os.path.basename(os.environ.get("SHELL", ""))
    if shell_name not in SHELLS:
        setting = f"$SHELL is {os.environ.get('SHELL', '')!r}"
        raise UsageError(
            f"{setting}: expected one of {', '.join(SHELLS)}; name the shell, as in `completion install bash`"
        )
    home = os.path.abspath(os.path.expanduser("~"))
    data = os.environ.get("XDG_DATA_HOME") or os.path.join(home, ".local", "share")
    if shell_name == "fish":
        config = os.environ.get("XDG_CONFIG_HOME") or os.path.join(home, ".config")
        return Shell(shell_name, os.path.join(config, "fish", "completions", "curvcli.fish"))
    script = os.path.join(data, "curvcli", f"completion.{shell_name}")
    load = f"if [ -r {quote(script)} ]; then . {quote(script)}; fi"
    if shell_name == "bash":
        return Shell(shell_name, script, os.path.join(home, ".bashrc"), (load,))
    folder = os.environ.get("ZDOTDIR") or home
    ready = "(( $+functions[compdef] )) || { autoload -Uz compinit && compinit; }"
    return Shell(shell_name, script, os.path.join(folder, ".zshrc"), (ready, load))


def source(name: str) -> str:
    """The script of a shell."""
    from .main import cli

    made = ASKING[name](cli, {}, "curvcli", COMPLETE)
    return made.source_template % made.source_vars()


def write_files(target: Shell) -> list[tuple[str, bool]]:
    """Write the script and the block that loads it; return each file with whether it changed.

    Errors: OutputError for a file that cannot be read or written; it is then unchanged.
    """
    files = [(target.script, source(target.name).encode())]
    if target.start_up is not None:
        files.append((target.start_up, _with_block(_read(target.start_up) or b"", target)))
    return [(path, _write(path, content)) for path, content in files]


def remove_files(target: Shell) -> list[tuple[str, bool]]:
    """Remove the files and lines of `write_files`; return each file with whether it changed."""
    files = [(target.script, _delete(target.script))]
    if target.start_up is not None:
        before = _read(target.start_up)
        files.append((target.start_up, before is not None and _write(target.start_up, _without_block(before, target))))
    return files


def _with_block(content: bytes, target: Shell) -> bytes:
    rest = _without_block(content, target)
    if rest != content and content == rest + target.block.encode():
        return content
    return rest + (b"" if not rest or rest.endswith(b"\n") else b"\n") + target.block.encode()


def _without_block(content: bytes, target: Shell) -> bytes:
    """The file without our block.

    Errors: OutputError for a block without its last line, which stays.
    """
    begin, end = f"\n{_BEGIN}\n".encode(), f"\n{_END}\n".encode()
    start = content.find(begin)
    if start < 0:
        return content
    stop = content.find(end, start)
    if stop < 0:
        raise OutputError(
            f"{target.start_up}: the line `{_END}` is missing after `{_BEGIN}`; remove that block by hand"
        )
    return content[:start] + content[stop + len(end) :]


def _read(path: str) -> bytes | None:
    try:
        with open(path, "rb") as stream:
            return stream.read()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise OutputError(f"{path}: cannot be read: {error.strerror}") from None


def _write(path: str, content: bytes) -> bool:
    """Replace a file in one step, following links and keeping its mode; return whether it changed."""
    if _read(path) == content:
        return False
    try:
        os.makedirs(os.path.dirname(os.path.realpath(path)), exist_ok=True)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror}") from None
    from ..output.atomic import Outputs

    with Outputs([path], force=True) as outputs, outputs.open(path) as stream:
        stream.write(content)
    return True


def _delete(path: str) -> bool:
    try:
        os.unlink(path)
    except FileNotFoundError:
        return False
    except OSError as error:
        raise OutputError(f"{path}: cannot be removed: {error.strerror}") from None
    return True


def _template(shell: str) -> str:
    """The script of a shell, with the names of the program and of its function left out."""
    return (get_data(__package__, f"data/completion/curvcli.{shell}") or b"").decode()


class Bash(BashComplete):
    """Bash, which splits `--area=mixed` into three words."""

    source_template = _template("bash")

    def get_completion_args(self) -> tuple[list[str], str]:
        """The words before the cursor, and the one at it."""
        arguments, incomplete = super().get_completion_args()
        if len(arguments) > 1 and arguments[-1] == "=" and arguments[-2].startswith("-"):
            arguments.pop()
        return arguments, incomplete


class Zsh(ZshComplete):
    """zsh."""

    source_template = _template("zsh")


class Fish(FishComplete):
    """fish."""

    source_template = _template("fish")


ASKING: dict[str, type[ShellComplete]] = {"bash": Bash, "zsh": Zsh, "fish": Fish}

for _name, _shell in ASKING.items():
    add_completion_class(_shell, _name)
