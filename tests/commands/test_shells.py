"""Completion in real shells on a terminal: what is typed, a tab, and what the shell then runs."""

from __future__ import annotations

import os
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.commands.test_completion import install
from tests.helpers.cli.program import ROOT

pty = pytest.importorskip("pty", reason="this system has no pseudo-terminals")

START_UP = {
    "bash": (".bashrc", "PS1='READY> '\n"),
    "zsh": (".zshrc", "PROMPT='READY> '\n"),
    "fish": (".config/fish/config.fish", "function fish_prompt; echo -n 'READY> '; end\nset fish_greeting\n"),
}

# What is typed, with a tab where the mark is, and the words that the shell makes of it.
LINES = {
    "curvcli ana^": ["analyze"],
    "curvcli analyze --are^": ["analyze", "--area"],
    "curvcli analyze --area v^": ["analyze", "--area", "voronoi"],
    "curvcli analyze --area=v^": ["analyze", "--area=voronoi"],
    "curvcli analyze unique^": ["analyze", "unique mesh.obj"],
    "curvcli analyze --output=unique^": ["analyze", "--output=unique mesh.obj"],
    "curvcli analyze --table ed^unique^": ["analyze", "--table", "edges=unique mesh.obj"],
    "curvcli batch -o fold^mesh": ["batch", "-o", "folder/mesh"],
    "curvcli check --require closed,gen^1": ["check", "--require", "closed,genus=1"],
    "curvcli completion install z^": ["completion", "install", "zsh"],
}


# Makes the pseudo-terminal that it was given the one that it is controlled by, as a shell expects.
SIT_DOWN = "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execvp(sys.argv[1], sys.argv[1:])"


class Terminal:
    """A shell that somebody sits at."""

    def __init__(self, shell: str, home: Path) -> None:
        self.seen = b""
        environment = {"HOME": str(home), "PATH": f"{home}:{os.environ['PATH']}", "TERM": "dumb", "LC_ALL": "C.UTF-8"}
        self.screen, inside = pty.openpty()
        self.process = subprocess.Popen(
            [sys.executable, "-c", SIT_DOWN, shell, "-i"],
            **dict.fromkeys(("stdin", "stdout", "stderr"), inside),
            cwd=home,
            env=environment,
            start_new_session=True,
        )
        os.close(inside)
        self.until(b"READY> ")

    def type(self, keys: str) -> None:
        os.write(self.screen, keys.encode())

    def until(self, words: bytes) -> bytes:
        """Text shown until these words come."""
        end = time.monotonic() + 120
        while words not in self.seen:
            assert select.select([self.screen], [], [], max(0, end - time.monotonic()))[0], self.seen
            self.seen += os.read(self.screen, 65536)
        shown, _, self.seen = self.seen.partition(words)
        return shown

    def leave(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self.screen)


@pytest.fixture(params=START_UP)
def terminal(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Terminal]:
    shell: str = request.param
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    name, content = START_UP[shell]
    (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / name).write_text(content)
    assert install(tmp_path, "install", shell)[0] == 0
    program = tmp_path / "curvcli"
    program.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m curvcli "$@"\n')
    program.chmod(0o755)
    (tmp_path / "unique mesh.obj").touch()
    (tmp_path / "folder").mkdir()
    found = Terminal(shell, tmp_path)
    yield found
    found.leave()


def test_what_is_typed_is_completed(terminal: Terminal) -> None:
    for typed, expected in LINES.items():
        # The line becomes the arguments of a command that shows them one by one.
        terminal.type(typed.replace("^", "\t") + "\x01printf '[%s]' \x05; echo DO''NE\n")
        words = terminal.until(b"DONE").decode().rpartition("[curvcli][")[2]
        assert words.rstrip("]").split("][") == expected, typed
        terminal.until(b"READY> ")
