"""Ctrl-C while the program is still being imported: one line and 130, wherever it comes."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.helpers.cli.program import environment

# What the script that pip writes does, but for a finder that interrupts when a certain module is looked for.
SCRIPT = """
import os, signal, sys
from curvcli.__main__ import main

class Interrupting:
    left = {times}
    def find_spec(self, name, path=None, target=None):
        while name == {module!r} and self.left:
            self.left -= 1
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interrupting())
sys.argv = ["curvcli", *{arguments!r}]
sys.exit(main())
"""


def run(arguments: list[str], module: str = "", times: int = 1) -> tuple[int, bytes, bytes]:
    program = SCRIPT.format(module=module, times=times, arguments=arguments)
    done = subprocess.run([sys.executable, "-c", program], env=environment(), capture_output=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


MODULES = ["curvcli.commands.main", "click", "click.parser", "curvcli.commands.config", "curvcli.commands.analyze",
           "numpy", "curvcli.loading.read"]  # fmt: skip


@pytest.mark.parametrize("module", MODULES)
def test_interrupted_at_an_import(module: str, small: Path, tmp_path: Path) -> None:
    words = ["analyze", str(small), "-q", "-o", str(tmp_path / "k.csv")]
    assert run(words, module) == (128 + signal.SIGINT, b"", b"curvcli: interrupted\n")
    assert list(tmp_path.iterdir()) == []


def test_who_insists_need_not_wait(small: Path) -> None:
    assert run(["analyze", str(small)], "click", times=2) == (128 + signal.SIGINT, b"", b"")


def test_it_listens_before_it_imports_more_than_signals() -> None:
    program = "import signal, sys\nbefore = set(sys.modules)\nfrom curvcli.__main__ import main\n"
    program += "print(*set(sys.modules) - before)\n"
    done = subprocess.run([sys.executable, "-c", program], env=environment(), capture_output=True, text=True)
    assert set(done.stdout.split()) <= {"__future__", "curvcli", "curvcli._version", "curvcli.__main__"}


def test_the_script_is_this_one() -> None:
    import tomllib

    root = Path(__file__).resolve().parents[2]
    assert tomllib.loads((root / "pyproject.toml").read_text())["project"]["scripts"] == {
        "curvcli": "curvcli.__main__:main"
    }
