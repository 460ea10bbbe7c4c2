"""Runner of command lines at one commit: `PYTHONPATH=TREE python -P run.py PLAN FOLDER`.

Each command line runs in a fork of this process, which has imported the package and its libraries, in a folder of its
own with the files `.stdout`, `.stderr` and `.exit`. This file imports nothing of the project but the package itself.
"""

from __future__ import annotations

import contextlib
import json
import os
import pkgutil
import signal
import sys
from importlib import import_module
from pathlib import Path

LIMIT_SECONDS = 300
LIBRARIES = (
    "numpy",
    "scipy.sparse.csgraph",
    "polars",
    "trimesh.exchange.load",
    "rich.console",
    "jinja2",
    "junitparser",
)


def prepare(samples: list[str], meshes: dict[str, str], folder: Path) -> None:
    """Write samples, and for each readable mesh a moved copy (.obj) and labels of its faces (.txt).

    meshes: paths by the name of the subject, which is a valid name of a file.
    """
    import numpy as np

    import curvcli

    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    for name in samples:
        with contextlib.suppress(Exception):
            execute(["sample", name, "-o", str(folder / f"{name}.ply")], folder / "log" / name)
    for subject, mesh in {**{name: str(folder / f"{name}.ply") for name in samples}, **meshes}.items():
        try:
            surface = curvcli.load(mesh)
        except Exception:
            continue
        points = np.array(surface.points) @ turn.T
        points[surface.faces[0, 0]] += 0.01 * (points[surface.faces[0, 1]] - points[surface.faces[0, 0]])
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (surface.faces + 1).tolist()]
        moved = folder / "moved" / f"{subject}.obj"
        moved.parent.mkdir(exist_ok=True)
        moved.write_text("\n".join(lines) + "\n")
        labels = np.arange(surface.n_faces) * 3 // max(surface.n_faces, 1)
        moved.with_suffix(".txt").write_text("\n".join(map(str, labels.tolist())) + "\n")


def preload() -> None:
    """Import what commands import; nothing here may start a thread, since forks lose it."""
    for name in LIBRARIES:
        import_module(name)
    package = import_module("curvcli")
    list(package.passes)  # passes need those that come before them
    for module in pkgutil.walk_packages(package.__path__, "curvcli.", onerror=lambda name: None):
        if not module.name.endswith(("__main__", "dask")):
            with contextlib.suppress(ImportError):
                import_module(module.name)


def execute(words: list[str], folder: Path) -> None:
    """Run one command line in a fork, in a new folder."""
    folder.mkdir(parents=True)
    process = os.fork()
    if process:
        _, status = os.waitpid(process, 0)
        (folder / ".exit").write_text(f"{os.waitstatus_to_exitcode(status)}\n")
        return
    code = 99
    try:
        signal.alarm(LIMIT_SECONDS)
        os.chdir(folder)
        for descriptor, name in ((0, os.devnull), (1, ".stdout"), (2, ".stderr")):
            file = os.open(name, os.O_RDONLY if descriptor == 0 else os.O_WRONLY | os.O_CREAT, 0o644)
            os.dup2(file, descriptor)
        sys.argv = ["curvcli", *words]
        try:
            import_module("curvcli.__main__").main()
            code = 0
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 0 if end.code is None else 1
        sys.stdout.flush()
        sys.stderr.flush()
    finally:
        os._exit(code)


def main(plan: str, folder: str) -> None:
    """Prepare inputs, or run the command lines of the plan."""
    work = json.loads(Path(plan).read_text())
    preload()
    if "samples" in work:
        prepare(work["samples"], work["meshes"], Path(folder))
        return
    for subject, name, words in work["cases"]:
        execute(words, Path(folder) / (subject or "-") / name)


if __name__ == "__main__":
    main(*sys.argv[1:])
