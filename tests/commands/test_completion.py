"""Completion: what is offered, what `completion install` writes, and that a start-up file survives it."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from curvcli.commands.completion import ASKING
from curvcli.commands.main import cli
from curvcli.commands.names import COMPLETE
from tests.helpers.cli.program import curvcli, environment

RC = "alias ll='ls -l'\nexport EDITOR=vi"  # without a last newline, as many have it


def offered(line: str) -> list[str]:
    """Completions for bash of a line whose last word is incomplete."""
    *words, incomplete = line.split(" ")[1:]
    shell = ASKING["bash"](cli, {}, "curvcli", COMPLETE)
    return [shell.format_completion(item) for item in shell.get_completions(words, incomplete)]


@pytest.mark.parametrize(
    ("line", "answers"),
    [
        ("curvcli ana", ["plain,analyze"]),
        ("curvcli analyze bunny", ["file,bunny"]),
        ("curvcli analyze -o k", ["file,k"]),
        ("curvcli analyze --area v", ["plain,voronoi"]),
        ("curvcli analyze -p K,kappa_g,kappa_1_f", ["plain,K,kappa_g,kappa_1_fit"]),
        ("curvcli analyze -p e", ["plain,estimates"]),
        ("curvcli analyze --table e", ["plain,edges="]),
        ("curvcli analyze --table edges=k", ["file,k"]),
        ("curvcli analyze --weld e", ["plain,exact"]),
        ("curvcli analyze --regions g", ["plain,groups"]),
        ("curvcli analyze --regions labels", ["file,labels"]),
        ("curvcli analyze --format parq", ["plain,parquet"]),
        ("curvcli batch --save csv,pl", ["plain,csv,ply"]),
        ("curvcli compare a b --map --table f", ["plain,faces="]),
        ("curvcli curves --table c", ["plain,curves="]),
        ("curvcli sample torus --set tub", ["plain,tube="]),
        ("curvcli check --require gen", ["plain,genus="]),
        ("curvcli check --allow man", ["plain,manifold"]),
        ("curvcli batch -o ", ["dir,"]),
        ("curvcli sample torus", ["plain,torus"]),
        ("curvcli passes h_sign", ["plain,h_signed"]),
        ("curvcli help ex", ["plain,exit-codes"]),
        ("curvcli completion install z", ["plain,zsh"]),
    ],
)
def test_what_is_offered(line: str, answers: list[str]) -> None:
    assert offered(line) == answers


def test_the_program_answers_the_shell() -> None:
    ended = curvcli(_CURVCLI_COMPLETE="bash_complete", COMP_WORDS="curvcli comp", COMP_CWORD="1")
    assert ended == (0, "plain,compare\nplain,completion\n", "")


def install(home: Path, *arguments: str, **more: str) -> tuple[int, str, str]:
    return curvcli("completion", *arguments, HOME=str(home), XDG_DATA_HOME="", XDG_CONFIG_HOME="", ZDOTDIR="", **more)


@pytest.mark.parametrize(("shell", "rc"), [("bash", ".bashrc"), ("zsh", ".zshrc")])
def test_installed_once_and_removed_again(shell: str, rc: str, tmp_path: Path) -> None:
    start_up = tmp_path / rc
    start_up.write_text(RC)
    start_up.chmod(0o600)
    code, out, err = install(tmp_path, "install", shell)
    assert (code, err) == (0, "")
    script = tmp_path / ".local" / "share" / "curvcli" / f"completion.{shell}"
    assert out.splitlines()[:2] == [f"written: {script}", f"written: {start_up}"]
    first = start_up.read_text()
    assert first.startswith(RC + "\n\n")
    assert first.count("curvcli completion >>>") == 1
    assert stat.S_IMODE(start_up.stat().st_mode) == 0o600
    assert "_curvcli_completion" in script.read_text()

    code, out, _ = install(tmp_path, "install", shell)
    assert out.splitlines()[:2] == [f"unchanged: {script}", f"unchanged: {start_up}"]
    assert start_up.read_text() == first

    # What is added later stays where it is, before and after our block.
    start_up.write_text("# top\n" + first + "# bottom\n")
    assert install(tmp_path, "remove", shell)[0] == 0
    assert start_up.read_text() == "# top\n" + RC + "\n# bottom\n"
    assert not script.exists()
    assert install(tmp_path, "remove", shell)[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([rc, ".local"])


def test_fish_finds_the_script_by_itself(tmp_path: Path) -> None:
    code, out, _ = install(tmp_path, "install", SHELL="/usr/bin/fish")
    script = tmp_path / ".config" / "fish" / "completions" / "curvcli.fish"
    assert (code, out.splitlines()[0]) == (0, f"written: {script}")
    assert "complete --no-files --command curvcli" in script.read_text()


def test_a_home_without_start_up_file(tmp_path: Path) -> None:
    assert install(tmp_path, "install", "bash")[0] == 0
    assert (tmp_path / ".bashrc").read_text().startswith("\n# >>> curvcli")


def test_a_linked_start_up_file_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "dotfiles").mkdir()
    real = tmp_path / "dotfiles" / "bashrc"
    real.write_text(RC)
    (tmp_path / ".bashrc").symlink_to(real)
    assert install(tmp_path, "install", "bash")[0] == 0
    assert (tmp_path / ".bashrc").is_symlink()
    assert "curvcli" in real.read_text()


def test_a_torn_block_is_not_touched(tmp_path: Path) -> None:
    torn = "a=1\n# >>> curvcli completion >>>\necho half\n"
    (tmp_path / ".bashrc").write_text(torn)
    code, _, err = install(tmp_path, "install", "bash")
    assert code == 4
    assert "remove that block by hand" in err
    assert (tmp_path / ".bashrc").read_text() == torn


def test_a_home_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / ".local").write_text("a file where a folder should be")
    code, out, err = install(tmp_path, "install", "bash")
    assert (code, out) == (4, "")
    assert "completion.bash: cannot be read: Not a directory" in err
    assert not (tmp_path / ".bashrc").exists()


def test_a_start_up_file_that_is_a_folder(tmp_path: Path) -> None:
    (tmp_path / ".bashrc").mkdir()
    code, _, err = install(tmp_path, "install", "bash")
    assert code == 4
    assert ".bashrc: cannot be read" in err


@pytest.mark.parametrize("shell", ["", "/bin/tcsh"])
def test_a_shell_that_is_not_known(shell: str, tmp_path: Path) -> None:
    code, _, err = install(tmp_path, "install", SHELL=shell)
    assert code == 2
    assert "name the shell" in err
    assert not list(tmp_path.iterdir())


BASH = shutil.which("bash")


@pytest.mark.skipif(BASH is None, reason="bash is not installed")
@pytest.mark.parametrize("end", ["", "\n", "\\\n", " # comment \\", "\nfalse\n"])
def test_bash_reads_what_was_installed(end: str, tmp_path: Path) -> None:
    """A file with any last line is read to its end, and the shell completes."""
    (tmp_path / ".bashrc").write_text("before=1" + end)
    assert install(tmp_path, "install", "bash")[0] == 0
    (tmp_path / "bin").mkdir()
    program = tmp_path / "bin" / "curvcli"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m curvcli "$@"\n')
    program.chmod(0o755)
    script = (
        'set -e; . "$HOME/.bashrc"; test "$before" = 1; complete -p curvcli; '
        "COMP_WORDS=(curvcli ana) COMP_CWORD=1; _curvcli_completion curvcli; echo ${COMPREPLY[@]}"
    )
    done = subprocess.run(
        [str(BASH), "--norc", "-c", script.replace("set -e; ", "set -e; " if end != "\nfalse\n" else "")],
        capture_output=True,
        text=True,
        env=environment(HOME=str(tmp_path), PATH=f"{program.parent}:{os.environ['PATH']}"),
    )
    assert done.stdout.splitlines()[-1] == "analyze", done.stderr
