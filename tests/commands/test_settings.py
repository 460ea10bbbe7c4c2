"""`--set`, `--spontaneous-curvature` and `--bending-rigidity` in every command, and what is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from tests.helpers import meshes
from tests.helpers.cli.program import Ended

Run = Callable[..., Ended]


@pytest.fixture
def run(within: Run) -> Run:
    """The program in this process, in the folder of the ball."""
    return within


@pytest.fixture(autouse=True)
def ball(tmp_path: Path) -> None:
    """A sphere of 162 vertices whose upper and lower half are groups."""
    sphere = meshes.of_sample("icosphere", size=162)
    upper = sphere.points[sphere.faces].mean(axis=1)[:, 2] > 0
    lines = ["v " + " ".join(map(repr, point)) for point in sphere.points.tolist()]
    for name, mask in (("up", upper), ("down", ~upper)):
        lines += [f"g {name}", *("f " + " ".join(map(str, face)) for face in (sphere.faces[mask] + 1).tolist())]
    (tmp_path / "ball.obj").write_text("\n".join(lines) + "\n")


def got(run: Run, *arguments: Any) -> list[float]:
    ended = run("analyze", "ball.obj", *arguments)
    assert ended.code == 0, ended.err
    return [float(line) for line in ended.out.splitlines()]


def test_three_spellings_are_one(run: Run) -> None:
    get = ("--get", "totals.helfrich")
    (plain,) = got(run, "--set", "helfrich.c0=0.5", *get)
    assert got(run, "--spontaneous-curvature", "0.5", *get) == [plain]
    analysis = curvcli.analyze("ball.obj", spontaneous_curvature=0.5)
    assert analysis.totals["helfrich"] == plain
    h, area = (np.asarray(analysis.vertices[name]) for name in ("h_signed", "A"))
    assert plain == pytest.approx(float((0.5 * (h - 0.5) ** 2 * area).sum()), rel=1e-14)


def test_the_energy_does_not_follow_the_convention_for_mean_curvature(run: Run) -> None:
    """An energy in k_BT is a fact about the membrane; c₀ stays that of κ₁ + κ₂."""
    given = ("--spontaneous-curvature", "0.5", "--get", "totals.helfrich", "--get", "totals.willmore")
    summed, average = got(run, *given), got(run, *given, "--mean", "average")
    assert summed[0] == average[0]
    assert summed[1] == 4 * average[1]


def test_a_rigidity_turns_the_energies_and_nothing_else(run: Run) -> None:
    get = [part for key in ("totals.helfrich", "columns.helfrich.max", "totals.willmore") for part in ("--get", key)]
    plain = got(run, "-p", "core,helfrich", *get)
    for rigidity, factor in (("20kBT", 20), ("20 k_BT", 20), ("8e-20J", 8e-20), ("80 pN nm", 80)):
        energies = got(run, "--bending-rigidity", rigidity, *get)
        np.testing.assert_allclose(energies, np.array(plain) * [factor, factor, 1], rtol=1e-15)
    report = json.loads(run("analyze", "ball.obj", "--bending-rigidity", "20kT", "--json").out)
    assert report["conventions"]["bending_rigidity"] == "20 k_BT"
    assert report["columns"]["helfrich"]["unit"] == "k_BT"
    assert "helfrich" not in json.loads(run("analyze", "ball.obj", "--json").out)["columns"]


def test_each_region_has_its_own(run: Run) -> None:
    """Faces of a region that is not named have the plain value; the whole adds what its faces have."""
    given = ("--regions", "groups", "--spontaneous-curvature", "up=2", "--spontaneous-curvature", "0.25")
    report = json.loads(run("analyze", "ball.obj", *given, "--json").out)
    assert report["conventions"]["settings"] == "helfrich.c0=0.25 helfrich.c0=up=2"
    energies = {region["name"]: region["totals"]["helfrich"] for region in report["regions"]}
    assert energies["up"] < 0.01 * energies["down"]
    python = curvcli.analyze("ball.obj", regions="groups", spontaneous_curvature={"up": 2, "": 0.25})
    assert python.totals["helfrich"] == report["totals"]["helfrich"]
    surface, h = python.surface, python.vertices["h_signed"]
    up = surface.points[surface.faces].mean(axis=1)[:, 2] > 0
    each = 0.5 * (h[surface.faces] - np.where(up, 2, 0.25)[:, None]) ** 2 * python.faces["area"][:, None] / 3
    assert python.totals["helfrich"] == pytest.approx(each.sum(), rel=1e-13)


def test_an_assertion_sees_the_setting(run: Run) -> None:
    (energy,) = got(run, "--spontaneous-curvature", "2", "--get", "totals.helfrich")
    bound = f"sum(helfrich) <= {2 * energy}"
    assert run("check", "ball.obj", "--assert", bound, "--spontaneous-curvature", "2").code == 0
    assert run("check", "ball.obj", "--assert", bound).code == 1


def test_batch_resumes_under_the_same_setting_only(run: Run, tmp_path: Path) -> None:
    def seconds(*more: str) -> tuple[int, list[dict[str, Any]]]:
        ended = run("batch", "ball.obj", "-o", "out", "-j", "1", "-q", *more)
        lines = (tmp_path / "out" / "manifest.jsonl").read_text().splitlines()
        return ended.code, [json.loads(line) for line in lines]

    code, first = seconds("--spontaneous-curvature", "0.5", "--bending-rigidity", "20kBT")
    (wanted,) = got(run, "--spontaneous-curvature", "0.5", "--bending-rigidity", "20kBT", "--get", "totals.helfrich")
    assert (code, first[0]["totals"]["helfrich"]) == (0, wanted)
    again = seconds("--resume", "--set", "helfrich.c0=0.5", "--bending-rigidity", "20 k_BT")[1]
    assert len(again) == 1
    assert len(seconds("--resume", "--set", "helfrich.c0=0.25", "--bending-rigidity", "20kBT")[1]) == 2
    assert len(seconds("--resume", "--set", "helfrich.c0=0.25", "--bending-rigidity", "21kBT")[1]) == 3


def test_compare_takes_the_setting_of_a_stored_report(run: Run) -> None:
    given = ("--regions", "groups", "--spontaneous-curvature", "up=2", "--bending-rigidity", "20kBT")
    assert run("analyze", "ball.obj", *given, "-o", "base.json", "-q").code == 0
    same = run("compare", "ball.obj", "base.json")
    assert same.code == 0, same.out
    other = json.loads(run("compare", "ball.obj", "base.json", "--spontaneous-curvature", "up=1", "--json").out)
    keys = {one["key"] for one in other["differences"]}
    assert {"conventions.settings", "totals.helfrich", "regions.up.totals.helfrich"} <= keys
    assert "totals.willmore" not in keys


def test_a_configuration_may_set_it_and_is_named(run: Run, tmp_path: Path) -> None:
    (tmp_path / "curvcli.toml").write_text(
        '[analyze]\nset = ["helfrich.c0=0.5"]\n[check]\nspontaneous-curvature = "2"\n'
    )
    plain = got(run, "--get", "totals.helfrich")
    (tmp_path / "elsewhere.toml").write_text("[analyze]\n")
    ended = run("--no-config", "analyze", "ball.obj", "--set", "helfrich.c0=0.5", "--get", "totals.helfrich")
    assert float(ended.out) == plain[0]
    verdict = run("check", "ball.obj", "--assert", "sum(helfrich) <= 1")
    assert verdict.code == 0
    assert 'sets spontaneous-curvature = "2"' in verdict.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--set", "helfrch.c0=1"), "unknown pass 'helfrch'; nearest: helfrich"),
        (("--set", "helfrich.c1=1"), "the pass helfrich has no parameter 'c1'; known: c0"),
        (("--spontaneous-curvature", "x"), "helfrich.c0 is 'x', expected a finite number"),
        (("--spontaneous-curvature", "1", "--set", "helfrich.c0=1"), "helfrich.c0 is set twice"),
        (("--spontaneous-curvature", "up=1"), "there are no regions without --regions"),
        (("--spontaneous-curvature", "pu=1", "--regions", "groups"), "which the mesh has not; known: up, down"),
        (("--bending-rigidity", "20"), "bending rigidity '20': expected a positive number with k_BT, J"),
        (("--bending-rigidity", "-1kBT"), "bending rigidity '-1kBT': expected a positive number"),
        (("--bending-rigidity", "1e308kBT"), "bending rigidity '1e308kBT': expected a positive number"),
        (("--bending-rigidity", "infJ"), "bending rigidity 'infJ': expected a positive number"),
    ],
)
def test_a_wrong_setting_is_one_line(run: Run, arguments: tuple[str, ...], message: str) -> None:
    for command in (("analyze", "ball.obj"), ("check", "ball.obj"), ("compare", "ball.obj", "ball.obj")):
        ended = run(*command, *arguments)
        assert ended.code == 2
        assert message in ended.err
        assert len(ended.err.splitlines()) == 1
