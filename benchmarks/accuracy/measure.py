"""The errors of one case: ours at the stated scale, and those of the peers at the same rings and radius."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numpy as np

import curvcli
from benchmarks.validation.surfaces import Floats, Mesh
from curvcli.mesh.neighbourhoods import mean_edge_length
from curvcli.report.compare.exact import ErrorNorms, error_norms

from .cases import Case
from .peers import PEERS

COLUMNS = (
    *("K_density", "K_ring", "K_corrected", "K_fit"),
    *("h_signed", "h_ring", "h_corrected", "h_fit"),
)
# A disk of so many mean edge lengths has about as many vertices as a neighbourhood of one ring more.
_REACH = 0.9
_LIMIT = 600.0
# Beyond so many vertices the peers would take most of the time.
_MOST = 20_000


def errors(case: Case, rings: int, peers: Iterable[str], python: str) -> dict[str, ErrorNorms]:
    """Errors by `K_fit`, `libigl K` and so on; boundary vertices are left out for all alike."""
    mesh = case.mesh()
    surface = curvcli.Surface(mesh.points, mesh.faces)
    found = curvcli.analyze(surface, ["A", *COLUMNS], rings=rings, checks=[]).vertices
    area = np.where(surface.interior, found["A"], 0.0)
    measured = {}
    for name in COLUMNS:
        exact = "K_density" if name.startswith("K") else "h_signed"
        measured[name] = error_norms(name, exact, found[name], mesh.exact[exact], area)
    radius = _REACH * rings * mean_edge_length(surface)
    for peer in peers if case.size <= _MOST else ():
        for key, values in _asked(peer, mesh, rings, radius, python).items():
            exact = "K_density" if key == "K" else "h_signed"
            wanted = mesh.exact[exact]
            # Whichever way its normals point.
            side = -1.0 if key == "h" and np.nansum(values * wanted) < 0 else 1.0
            measured[f"{peer} {key}"] = error_norms(f"{peer} {key}", exact, side * values, wanted, area)
    return measured


def _asked(peer: str, mesh: Mesh, rings: int, radius: float, python: str) -> dict[str, Floats]:
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "mesh.npz"), Path(folder, "found.npz")
        np.savez(source, points=mesh.points, faces=mesh.faces)
        script = str(Path(__file__).with_name("peers.py"))
        command = [python, script, peer, str(source), str(rings), repr(radius), str(target)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=_LIMIT)
        except subprocess.TimeoutExpired:
            return {}
        if done.returncode or not target.exists():
            return {}
        with np.load(target) as stored:
            return {key: np.asarray(stored[key], np.float64) for key in stored}


def present(python: str) -> tuple[list[str], list[str]]:
    """The peers that the interpreter has, and those it lacks."""
    modules = {"libigl": "igl", "PyMeshLab": "pymeshlab", "trimesh": "trimesh, rtree"}
    there = {
        peer: not subprocess.run([python, "-c", f"import {modules[peer]}"], capture_output=True).returncode
        for peer in PEERS
    }
    return [peer for peer in PEERS if there[peer]], [peer for peer in PEERS if not there[peer]]


def this_python() -> str:
    """The interpreter that runs this."""
    return sys.executable
