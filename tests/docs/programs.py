"""The programs that pages call, as scripts in a folder; `curvcli` is answered by a server that forks."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tests.helpers.cli.program import SERVER, environment


def provide(folder: Path, **programs: str) -> None:
    """Scripts that start Python with the given arguments."""
    folder.mkdir(exist_ok=True)
    for name, arguments in programs.items():
        (folder / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {arguments} "$@"\n')
        (folder / name).chmod(0o755)


@contextmanager
def served(folder: Path, **more: str) -> Iterator[None]:
    """`curvcli` in a folder of programs, as fast as a call. more: environment of the server."""
    if not hasattr(os, "fork"):
        pytest.skip("pages are tried where processes fork")
    with TemporaryDirectory() as place:  # the name of a socket has to be short
        address = Path(place, "socket")
        provide(folder, curvcli=f'-S -I "{SERVER}" "{address}" --ask')
        command = [sys.executable, SERVER, address]
        with subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment(**more)
        ) as server:
            assert server.stdout is not None
            assert server.stdout.readline() == b"ready\n"
            try:
                yield
            finally:
                server.communicate()


def shell(code: str, folder: Path, programs: Path, **more: str) -> str:
    """Run commands in a folder, in one shell, and return their output; a command that fails fails the test."""
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", code],
        cwd=folder,
        env=environment(PATH=f"{programs}{os.pathsep}{environment()['PATH']}", **more),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,  # in the order in which a reader sees both
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, f"{code}\n{done.stdout}"
    return done.stdout
