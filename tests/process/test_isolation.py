"""Forbidden acts of the program: run what it reads, reach the network, open or write what nobody named."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.helpers.cli.program import ROOT, command, environment

SOURCES = sorted((ROOT / "curvcli").rglob("*.py"))

# Modules by which data become code, or a program talks to others.
DANGEROUS = {
    *("pickle", "cPickle", "dill", "cloudpickle", "joblib", "marshal", "shelve", "code", "codeop", "runpy", "pty"),
    *("socket", "ssl", "http", "requests", "httpx", "aiohttp", "urllib3", "ftplib", "smtplib", "xmlrpc", "webbrowser"),
    *("urllib.request", "subprocess", "multiprocessing", "ctypes", "cffi"),
}
# `batch` works in processes of its own and talks with them, and only with them, through pipes that nobody else has;
# the C library keeps memory as the commands set it, and gives it back between meshes; pictures ask whether the system
# has OpenGL, which VTK needs.
ALLOWED = {
    ("curvcli/commands/allocation.py", "ctypes"),
    ("curvcli/support/memory.py", "ctypes"),
    ("curvcli/output/pictures/render.py", "ctypes"),
    ("curvcli/batch/processes.py", "subprocess"),
}
# A command with a bound on its time or memory goes on in a child of itself, which its parent can end.
FORKS = {("curvcli/commands/limits.py", "os.fork")}
HARMLESS = {("urllib.request", "url2pathname")}  # rewrites a string


def imported(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield from (node.module for alias in node.names if (node.module, alias.name) not in HARMLESS)


def calls(tree: ast.AST) -> Iterator[tuple[str, ast.Call]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            yield ast.unparse(node.func), node


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_the_source_imports_nothing_dangerous(path: Path) -> None:
    name, tree = path.relative_to(ROOT).as_posix(), ast.parse(path.read_text("utf-8"))
    for module in imported(tree):
        packages = {".".join(module.split(".")[:depth]) for depth in (1, 2)}
        assert not packages & DANGEROUS or (name, module) in ALLOWED, f"imports {module}"
    for function, call in calls(tree):
        given = {word.arg: word.value for word in call.keywords}
        assert function not in ("eval", "exec", "compile", "__import__", "input", "breakpoint"), ast.unparse(call)
        assert (name, function) in FORKS or not re.fullmatch(
            r"os\.(system|popen|exec\w+|spawn\w+|posix_spawn\w*|fork\w*|startfile)", function
        )
        assert "shell" not in given, ast.unparse(call)
        if function in ("np.load", "numpy.load", "np.savez", "np.save", "np.savez_compressed"):
            allow = given.get("allow_pickle")
            assert isinstance(allow, ast.Constant), ast.unparse(call)
            assert allow.value is False, ast.unparse(call)
        if function in ("np.fromfile", "np.memmap", "np.lib.format.read_array"):
            raise AssertionError(ast.unparse(call))
        if function == "Popen" or function.startswith("subprocess."):
            assert isinstance(call.args[0], ast.List), f"{ast.unparse(call)}: not a list of words"


# ---------------------------------------------------------------------------- as the kernel sees it

OPENS = re.compile(r'(?:openat|open|creat)\((?:AT_FDCWD, |\d+, )?"((?:[^"\\]|\\.)*)", ?([A-Z_|0-9]*).*= (-?\d+)')
CHANGES = re.compile(r"\b(rename\w*|link\w*|symlink\w*|unlink\w*|mkdir\w*|rmdir|truncate|mknod\w*|chown\w*)\(.*= 0")
REMAINS = ("/dev/null", "/dev/tty", "/proc/self/", "/dev/shm/")


@pytest.fixture(scope="module")
def strace() -> str:
    found = shutil.which("strace")
    if found is None:
        pytest.skip("strace is not installed")
    probe = subprocess.run([found, "-o", os.devnull, "true"], capture_output=True, text=True)
    if probe.returncode:
        pytest.skip(f"strace cannot trace here: {probe.stderr.strip()}")
    return found


OBJ = """mtllib hidden.mtl
mtllib /etc/hostname
usemtl hidden
map_Kd hidden.png
call hidden.obj
csh echo hidden
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
"""
PLY = """ply
format ascii 1.0
comment TextureFile hidden.png
comment hidden.mtl
obj_info hidden.obj
element vertex 4
property double x
property double y
property double z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 2 0 3
"""


@pytest.mark.parametrize(("name", "content"), [("mesh.obj", OBJ), ("mesh.ply", PLY)])
def test_what_a_run_opens(name: str, content: str, strace: str, tmp_path: Path) -> None:
    folders = {key: tmp_path / key for key in ("home", "here", "out", "in")}
    for folder in folders.values():
        folder.mkdir()
    (folders["in"] / name).write_text(content)
    for hidden in ("hidden.mtl", "hidden.png", "hidden.obj"):
        (folders["in"] / hidden).write_text("newmtl hidden\nmap_Kd hidden.png\n")
    folders["here"].chmod(0o555)
    names = ("k.csv", "k.parquet", "k.ply", "k.obj", "k.json", "k.npz")
    wanted = [word for output in names for word in ("-o", str(folders["out"] / output))]
    log = tmp_path / "log"
    traced = [strace, "-f", "-s", "4096", "-e", "trace=%file,%network", "-o", str(log)]
    done = subprocess.run(
        [*traced, *command("analyze", folders["in"] / name, *wanted)],
        cwd=folders["here"],
        env=environment(HOME=str(folders["home"]), XDG_CACHE_HOME=str(folders["home"] / "cache"), TMPDIR=str(tmp_path)),
        capture_output=True,
        timeout=120,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    trace = log.read_text("utf-8", "replace").splitlines()
    opened = [match.groups() for line in trace if (match := OPENS.search(line))]
    assert any(path.endswith(name) for path, _, _ in opened), "the trace shows nothing"

    # Nothing is opened for writing but temporaries beside the outputs.
    writing = [path for path, flags, _ in opened if re.search("O_WRONLY|O_RDWR|O_CREAT|O_TRUNC|O_APPEND", flags)]
    beside = re.compile(re.escape(f"{folders['out']}/") + r"\.curvcli-[0-9a-f]{16}\.part")
    assert len({path for path in writing if beside.fullmatch(path)}) >= len(names)
    assert [path for path in writing if not beside.fullmatch(path) and not path.startswith(REMAINS)] == []
    # Nothing is renamed, linked, removed or made elsewhere.
    changed = [line for line in trace if CHANGES.search(line)]
    assert changed
    assert [line for line in changed if f'"{folders["out"]}/.curvcli-' not in line] == []
    # Nothing that the mesh names is opened, or even looked for.
    assert [line for line in trace if "hidden" in line] == []
    assert [line for line in trace if "/etc/hostname" in line] == []
    # No network, no other program.
    assert [line for line in trace if re.search(r"connect\(.*AF_INET|(?:sendto|bind)\(.*AF_INET", line)] == []
    assert sum(" execve(" in line and line.endswith("= 0") for line in trace) == 1

    assert sorted(os.listdir(folders["out"])) == sorted(names)
    assert os.listdir(folders["home"]) == []
    assert os.listdir(folders["here"]) == []
    assert sorted(os.listdir(folders["in"])) == sorted([name, "hidden.mtl", "hidden.obj", "hidden.png"])
