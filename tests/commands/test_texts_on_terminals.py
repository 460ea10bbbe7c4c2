"""No text from outside is obeyed by a terminal."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.commands.test_texts import ENDS, plain
from tests.commands.text_sources import SOURCES, Source, stored
from tests.helpers.cli.program import command, environment


def on_terminal(folder: Path, *arguments: str, columns: int = 100) -> tuple[int, str]:
    """The exit code, and what a terminal gets of both streams."""
    import fcntl
    import struct
    import termios

    ours, theirs = os.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    running = subprocess.Popen(
        command(*arguments),
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        cwd=folder,
        env=environment(TERM="xterm-256color"),
    )
    os.close(theirs)
    parts = []
    while True:
        try:
            part = os.read(ours, 1 << 16)
        except OSError:
            break
        if not part:
            break
        parts.append(part)
    os.close(ours)
    return running.wait(timeout=120), b"".join(parts).decode()


# What rich says: colours and weights, moves of the cursor within its own lines, and the cursor itself.
OWN = re.compile(r"\x1b\[(?:[0-9;]*m|[0-9]*[ABCDGJK]|\?25[lh])|\r")


def harmless(text: str, what: object) -> None:
    assert "\x1b]" not in text, what
    assert "\x1b[5;7m" not in text, what
    assert "a\rb" not in text, what
    plain(OWN.sub("", text), what)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are POSIX's")
@pytest.mark.parametrize("source", [s for s in SOURCES if s.name not in ("objects", "materials")], ids=lambda s: s.name)
def test_terminals_get_no_control_sequences(source: Source, tmp_path: Path) -> None:
    arguments = source.make(tmp_path)
    for line in (["analyze", *arguments], ["check", *arguments, "-v", "--require", "genus=7"]):
        code, said = on_terminal(tmp_path, *line)
        assert code in (0, 1), said[-500:]
        harmless(said, line)
    if source.name in ("folder", "unit"):
        assert "[/x]" in said.replace("\r\n", "") or source.name == "unit"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are POSIX's")
def test_terminals_that_compare(tmp_path: Path) -> None:
    for pair in stored(tmp_path):
        code, said = on_terminal(tmp_path, "compare", *pair, "-v")
        assert code in ENDS, said[-500:]
        harmless(said, pair)
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "[").mkdir()
    (tmp_path / "in" / "[" / "x].ply").write_bytes(b"junk")
    code, said = on_terminal(tmp_path, "batch", "in/**/*", "-o", "out[/x]", "-j", "1")
    assert code == 3
    harmless(said, "batch")
