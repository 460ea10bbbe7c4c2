"""Names and places of input files: whatever they are, one line and the right code, in real processes."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import curvcli
from curvcli.loading.pieces import Pieces
from tests.fuzz.contract import in_process
from tests.helpers.cli.program import environment, served
from tests.helpers.spelling import binary_stl
from tests.loading.test_ply import binary_ply
from tests.loading.test_stl import TETRAHEDRON

OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
SOUND = {"obj": OBJ, "ply": binary_ply([(0, 1, 2), (0, 2, 3)]), "stl": binary_stl(TETRAHEDRON)}
BROKEN = OBJ + b"f 1 2 9\n"


def run(*words: str | bytes, cwd: Path, **options: Any) -> tuple[int, bytes, bytes]:
    """Code, stdout and stderr of a real process."""
    command: list[Any] = [*served("analyze"), *words]
    ran = subprocess.run(command, capture_output=True, cwd=cwd, env=environment(), timeout=60, check=False, **options)
    return ran.returncode, ran.stdout, ran.stderr


def here(path: str, *words: str) -> tuple[int, bytes, str]:
    ran = in_process(["analyze", *words, "--", path])
    return ran.code, ran.out, ran.err


def one_line(message: str) -> bool:
    return message.startswith("curvcli: ") and message.endswith("\n") and message[:-1].isprintable()


NAMES = [
    "with blank.obj",
    "a\nb.obj",
    "quote'\"`$(touch x).obj",
    "-v.obj",
    "--help.obj",
    "--.obj",
    "\x1b[31mred.obj",
    "tab\tand\rreturn.obj",
    "[bold]rich[red].obj",
    "{stem}.obj",
    "ümlaut 網 \u202e.obj",
    "%s%n.obj",
    "*.obj",
    "~.obj",
    "a" * 240 + ".obj",
]


@pytest.mark.parametrize("name", NAMES)
def test_a_file_of_an_odd_name_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.chdir(tmp_path)
    Path(name).write_bytes(OBJ)
    code, out, err = here(name, "--json")
    assert (code, err) == (0, "")
    assert json.loads(out)["topology"]["faces"] == 4
    code, out, err = here(name)
    assert (code, err) == (0, "")
    Path(name).write_bytes(BROKEN)
    code, out, err = here(name, "-o", "out.csv")
    assert (code, out) == (3, b"")
    assert one_line(err)
    assert "line 9: vertex index `9`" in err
    assert sorted(path.name for path in tmp_path.iterdir()) == [name], "nothing written, nothing run"


def test_names_that_are_not_utf_8(tmp_path: Path) -> None:
    name = b"\xff\xfe \xe4.obj"
    try:
        (Path(os.fsdecode(os.fsencode(tmp_path) + b"/" + name))).write_bytes(OBJ)
    except OSError as error:
        pytest.skip(f"this file system takes only UTF-8 names ({error})")
    code, out, err = run(name, "--json", cwd=tmp_path)
    assert (code, err) == (0, b"")
    assert json.loads(out)["input"]["path"].isprintable()
    code, out, err = run(name, "-o", "{stem}.csv", cwd=tmp_path)
    assert (code, err) == (0, b"")
    assert os.path.exists(os.fsencode(tmp_path) + b"/\xff\xfe \xe4.csv")
    for locale in ("C", "POSIX", "C.UTF-8"):
        (Path(os.fsdecode(os.fsencode(tmp_path) + b"/" + name))).write_bytes(BROKEN)
        program = ["env", f"LC_ALL={locale}", "PYTHONCOERCECLOCALE=0", "PYTHONUTF8=0", sys.executable, "-m", "curvcli"]
        ran = subprocess.run(
            [*program, "analyze", name],
            capture_output=True,
            cwd=tmp_path,
            env=os.environ | {"PYTHONPATH": str(Path(curvcli.__file__).parents[1])},
            timeout=60,
            check=False,
        )
        assert (ran.returncode, ran.stdout) == (3, b"")
        assert ran.stderr.count(b"\n") == 1
        assert b"vertex index" in ran.stderr


def test_a_text_terminal_of_few_letters_gets_its_summary(tmp_path: Path) -> None:
    (tmp_path / "ü.obj").write_bytes(OBJ)
    ran = subprocess.run(
        [sys.executable, "-m", "curvcli", "analyze", "ü.obj"],
        capture_output=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(Path(curvcli.__file__).parents[1]), "PYTHONIOENCODING": "ascii"},
        timeout=60,
        check=False,
    )
    assert (ran.returncode, ran.stderr) == (0, b"")
    assert b"gauss_bonnet" in ran.stdout
    assert ran.stdout.isascii()


def test_a_name_that_looks_like_an_option(tmp_path: Path) -> None:
    (tmp_path / "-q.obj").write_bytes(OBJ)
    code, out, err = run("--get", "topology.faces", "--", "-q.obj", cwd=tmp_path)
    assert (code, out, err) == (0, b"4\n", b"")
    code, out, err = run("--get", "topology.faces", "./-q.obj", cwd=tmp_path)
    assert (code, out, err) == (0, b"4\n", b"")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_what_is_no_file_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.obj")
    (tmp_path / "folder.obj").mkdir()
    (tmp_path / "loop.obj").symlink_to("loop.obj")
    (tmp_path / "one.obj").symlink_to("two.obj")
    (tmp_path / "two.obj").symlink_to("one.obj")
    (tmp_path / "nowhere.obj").symlink_to("none")
    (tmp_path / "zero.obj").symlink_to("/dev/zero")
    (tmp_path / "null.obj").symlink_to("/dev/null")
    expected = {
        "pipe.obj": "a named pipe found",
        "folder.obj": "a directory found",
        "folder.obj/": "a directory found",
        "loop.obj": "leads in a circle",
        "one.obj": "leads in a circle",
        "nowhere.obj": "no such file",
        "none.obj": "no such file",
        "folder.obj/none.obj": "no such file",
        "pipe.obj/none.obj": "no such file",
        "zero.obj": "a device found",
        "null.obj": "a device found",
        "": "no such file",
        "a" * 300 + ".obj": "File name too long",
        "b" * 5000 + ".obj": "File name too long",
    }
    for name, reason in expected.items():
        code, out, err = here(str(tmp_path / name) if name else "", "-o", str(tmp_path / "out.csv"))
        assert (code, out) == (3, b""), name
        assert one_line(err), err
        assert reason in err, (name, err)
        assert not (tmp_path / "out.csv").exists()


def test_sockets_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as end:
        end.bind("s.obj")
        code, _, err = here("s.obj")
    assert code == 3
    assert "a socket found" in err


def test_links_to_files_are_followed(tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_bytes(OBJ)
    (tmp_path / "link.obj").symlink_to("mesh.obj")
    assert here(str(tmp_path / "link.obj"), "--get", "topology.faces")[:2] == (0, b"4\n")


def test_files_that_may_not_be_read(tmp_path: Path) -> None:
    path = tmp_path / "mesh.obj"
    path.write_bytes(OBJ)
    assert here(str(path), "--get", "topology.faces")[0] == 0  # all modules are there from now on
    path.chmod(0)
    user = os.geteuid()
    if user == 0:  # who may read everything is somebody else for a while
        os.seteuid(65534)
    try:
        code, out, err = here(str(path), "--get", "topology.faces")
    finally:
        os.seteuid(user)
    assert (code, out) == (3, b"")
    assert err == f"curvcli: {path}: the file may not be read (permission denied)\n"


def after_it_was_opened(monkeypatch: pytest.MonkeyPatch, change: Callable[[], None]) -> None:
    """Let the file change as soon as its size is known."""
    begin = Pieces.__init__

    def changing(self: Pieces, *arguments: Any, **options: Any) -> None:
        begin(self, *arguments, **options)
        change()

    monkeypatch.setattr(Pieces, "__init__", changing)


@pytest.mark.parametrize("kind", ["obj", "ply", "stl"])
@pytest.mark.parametrize("left", [0, 1, 30, -3])
def test_files_that_shrink_while_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str, left: int
) -> None:
    path = tmp_path / f"mesh.{kind}"
    path.write_bytes(SOUND[kind])
    after_it_was_opened(monkeypatch, lambda: os.truncate(path, left % len(SOUND[kind])))
    code, out, err = here(str(path), "--json")
    assert (code, out) == (3, b"")
    assert one_line(err)
    assert err.startswith(f"curvcli: {path}: {len(SOUND[kind])} bytes expected, {left % len(SOUND[kind])} read: the fi")
    assert "the file changed while it was read" in err


@pytest.mark.parametrize("kind", ["obj", "ply", "stl"])
def test_files_that_grow_while_they_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    path = tmp_path / f"mesh.{kind}"
    path.write_bytes(SOUND[kind])

    def grow() -> None:
        with path.open("ab") as file:
            file.write(b"# more\n")

    after_it_was_opened(monkeypatch, grow)
    code, out, err = here(str(path), "--json")
    assert (code, out) == (3, b"")
    assert "the file changed while it was read" in err


def test_a_file_as_stdin_is_read_from_where_it_stands(tmp_path: Path) -> None:
    path = tmp_path / "two.txt"
    path.write_bytes(b"f 9 9 9 is no part of it\n" + OBJ)
    with path.open("rb") as file:
        os.lseek(file.fileno(), 25, os.SEEK_SET)
        code, out, err = run("-", "--input-format", "obj", "--get", "topology.faces", cwd=tmp_path, stdin=file)
    assert (code, out, err) == (0, b"4\n", b"")


def test_limits_are_kept_before_anything_is_read(tmp_path: Path) -> None:
    path = tmp_path / "mesh.ply"
    head = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    )
    path.write_bytes((head + "element face 5\nproperty list uchar int vertex_indices\nend_header\n").encode())
    code, out, err = here(str(path), "--max-faces", "4")
    assert (code, out) == (3, b"")
    assert "5 faces found, at most 4 allowed; --max-faces sets the limit" in err
    with path.open("wb") as file:
        file.truncate(1 << 40)  # a hole of a terabyte
    code, out, err = here(str(path), "--max-bytes", "1000")
    assert (code, out) == (3, b"")
    assert "1099511627776 bytes found, at most 1000 allowed; --max-bytes sets the limit" in err


def test_a_bad_mesh_among_others_is_told_and_the_rest_is_done(tmp_path: Path) -> None:
    names = ["a.obj", "b.obj", "c\nc.obj"]
    for name in names:
        (tmp_path / name).write_bytes(BROKEN if name == "b.obj" else OBJ)
    code, out, err = run(*names, "-q", "-o", "{stem}.csv", cwd=tmp_path)
    assert (code, out) == (3, b"")
    assert err.count(b"\n") == 1
    assert err.startswith(b"curvcli: b.obj: line 9: ")
    assert sorted(path.name for path in tmp_path.glob("*.csv")) == ["a.csv", "c\nc.csv"]
