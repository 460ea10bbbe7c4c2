"""Pictures from the command line: what is said, what is refused, what is not imported."""

from __future__ import annotations

import ctypes.util
import importlib.util
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.helpers.cli.program import CUBE, DISK, Ended, curvcli, environment
from tests.helpers.images import opengl

__all__ = ["opengl"]

Run = Callable[..., Ended]

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.mark.usefixtures("opengl")
def test_the_range_is_told_beside_the_picture(within: Run, tmp_path: Path) -> None:
    ended = within("analyze", DISK, "-o", "x.png", "-o", "x.hist.png", "--size", "300x240", "--color-by", "h")
    assert ended.code == 0
    lines = ended.err.splitlines()
    assert len(lines) == 2
    assert lines[0].startswith("curvcli: x.png: h: ")
    assert lines[1].startswith("curvcli: x.hist.png: h: ")
    assert "cuts " in lines[0]
    assert "undefined" in lines[0]
    for name in ("x.png", "x.hist.png"):
        assert (tmp_path / name).read_bytes().startswith(PNG)
    again = within("analyze", DISK, "-o", "x.png", "--size", "300x240")
    assert again.code == 4
    quiet = within("analyze", DISK, "-q", "--force", "-o", "x.png", "--size", "400x240", "--color-by", "h,status")
    assert quiet == (0, "", "")


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--view", "left"], "--view left: expected iso, front, top, fit, or AZ,EL"),
        (["--size", "big"], "--size big: expected WxH"),
        (["--size", "300x300", "-o", "x.hist.png"], "--size 300x300: too small for 11 panels; 720x540 is enough"),
        (["--background", "mist"], "--background mist: no such colour"),
        (["--color-by", "h,kapa_1"], "--color-by kapa_1: no such column of vertices; nearest: kappa_1"),
        (["--color-by", "K_abs"], "--color-by K_abs: is not computed; -p core,K_abs adds it"),
    ],
)
def test_what_cannot_be_drawn_is_refused_before_any_work(within: Run, options: list[str], complaint: str) -> None:
    ended = within("analyze", "missing.obj", "-o", "x.png", *options)
    assert ended.code == 2
    assert complaint in ended.complaint


@pytest.mark.parametrize(
    ("name", "needs"),
    [("x.png", "pictures need"), ("x.hist.png", "histograms need matplotlib")],
)
def test_without_the_extra_the_way_to_install_it_is_told(
    within: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, name: str, needs: str
) -> None:
    find = importlib.util.find_spec
    hidden = ("pyvista", "matplotlib", "vtkmodules")
    monkeypatch.setattr(importlib.util, "find_spec", lambda module, *rest: None if module in hidden else find(module))
    ended = within("analyze", CUBE, "-o", name)
    assert ended.code == 2
    assert ended.complaint.startswith(needs)
    assert ended.complaint.endswith("`pip install 'curvcli[pictures]'`")
    assert not (tmp_path / name).exists()


def test_histograms_need_matplotlib_alone(tmp_path: Path) -> None:
    code = """
import sys
for name in ("pyvista", "vtkmodules", "vtk"):
    sys.modules[name] = None
from curvcli.commands.main import main
sys.exit(main())
"""

    def run(*outputs: str) -> subprocess.CompletedProcess[str]:
        command = [
            sys.executable,
            "-c",
            code,
            "analyze",
            DISK,
            "-q",
            *(part for name in outputs for part in ("-o", name)),
        ]
        return subprocess.run(command, cwd=tmp_path, env=environment(), capture_output=True, text=True, timeout=120)

    done = run("x.hist.png")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "x.hist.png").read_bytes().startswith(PNG)
    done = run("y.hist.png", "y.png")
    assert done.returncode == 2
    assert "pictures need pyvista" in done.stderr
    assert "matplotlib" not in done.stderr
    assert not (tmp_path / "y.hist.png").exists()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere OpenGL is part of the system")
def test_without_opengl_the_reason_is_told_and_nothing_crashes(tmp_path: Path) -> None:
    """VTK is told to draw with OSMesa, which few systems have; where it is missing VTK itself would crash."""
    has_mesa = ctypes.util.find_library("OSMesa") is not None
    ended = curvcli(
        "analyze", CUBE, "-q", "-o", "x.png", folder=tmp_path, VTK_DEFAULT_OPENGL_WINDOW="vtkOSOpenGLRenderWindow"
    )
    assert ended.code == (0 if has_mesa else 2), ended
    assert has_mesa or ended.complaint.startswith("pictures need OpenGL that draws without a display")
    assert [*tmp_path.iterdir()] == ([tmp_path / "x.png"] if has_mesa else [])


def test_nothing_that_draws_is_imported_for_a_table(tmp_path: Path) -> None:
    program = (
        "import sys; sys.argv = ['curvcli', 'analyze', sys.argv[1], '-q', '-o', 'x.ply', '-o', 'x.csv']\n"
        "import curvcli.commands.main as m\n"
        "try: m.main()\n"
        "except SystemExit: print(*{'pyvista', 'matplotlib', 'vtkmodules'} & {*sys.modules})"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, CUBE], capture_output=True, text=True, cwd=tmp_path, env=environment()
    )
    assert done.stdout == "\n"


@pytest.mark.slow
@pytest.mark.usefixtures("opengl")
def test_a_batch_draws_too(within: Run, tmp_path: Path) -> None:
    ended = within(
        "batch", CUBE, "-o", "out", "--save", "png,hist.png", "--size", "240x200", "--color-by", "h", "-q", "-j", "1"
    )
    assert ended.code == 0
    assert [path.name for path in sorted((tmp_path / "out").glob("*.png"))] == ["cube.obj.hist.png", "cube.obj.png"]
