"""Meshes of shared/cases with cavities, and with bodies that cross or touch, by the command line."""

from __future__ import annotations

import json

import pytest

from tests.cases.test_gate import case
from tests.helpers.cli.program import curvcli
from tests.helpers.shared import needs_shared

pytestmark = needs_shared


@pytest.mark.parametrize(
    ("name", "as_wound", "outward", "message"),
    [
        ("hollow_right.stl", 936, 936, ""),
        ("hollow_wrong.stl", 1064, 936, "1 closed patch is inside out (face 12 at "),
        ("two_second_inverted.stl", 936, 1064, "1 closed patch is inside out (face 12 at "),
        ("overlapping_cubes.stl", 2, 2, "2 closed patches cross or coincide (face 0 and face 12)"),
        ("bed_100_cubes.stl", 51200, 51200, ""),
    ],
)
def test_outward_turns_every_body_to_the_right_side(name: str, as_wound: float, outward: float, message: str) -> None:
    ended = curvcli("check", case(name), "--require", "closed,outward")
    assert ended.code == bool(message)
    assert (f"outward fails: {message}" in ended.out) == bool(message)
    for orient, volume in (("file", as_wound), ("outward", outward)):
        assert float(curvcli("analyze", case(name), "--orient", orient, "--get", "totals.volume").out) == volume


def test_the_warning_says_what_is_inside_out() -> None:
    for name, word in (("hollow_wrong.stl", "cavity"), ("two_second_inverted.stl", "body")):
        assert word in curvcli("check", case(name)).out
    assert "cross" in curvcli("check", case("overlapping_cubes.stl")).out


@pytest.mark.parametrize(
    ("folder", "name", "weld", "words"),
    [
        ("cases", "seam_gap_1e-4mm.stl", "2.1e-6", "closes all 4 boundary edges"),
        ("cases", "seam_exact.obj", "exact", "would close all 48 boundary edges"),
        ("meshes", "angle_block.STL", "1e-12", "closes all 166 boundary edges"),
        ("meshes", "octagonal_pocket.ply", "1e-12", "closes all 54 boundary edges"),
    ],
)
def test_the_tolerance_that_closes(folder: str, name: str, weld: str, words: str) -> None:
    path = case(f"../{folder}/{name}")
    checked = curvcli("check", path, "--require", "closed")
    assert checked.code == 1
    failure = next(line for line in checked.out.splitlines() if "closed fails" in line)
    assert failure.endswith(f"; --weld {weld} {words}")
    analysed = json.loads(curvcli("analyze", path, "-p", "topology", "--json").out)
    assert f"--weld {weld} {words}" in [warning["hint"] for warning in analysed["warnings"]]
    after = curvcli("check", path, "--require", "closed", "--weld", weld)
    assert "closed fails" not in after.out


def test_a_common_wall_is_explained() -> None:
    name, words = "multibody_touching.stl", "2 pairs of coincident faces face each other: bodies with a common wall"
    checked = curvcli("check", case(name), "--require", "outward")
    assert checked.code == 1
    failed = [line for line in checked.out.splitlines() if " fails: " in line]
    assert len(failed) == 2
    assert all(line.endswith(words) for line in failed)
    assert f"facing_faces: {words}" in checked.out
    assert float(curvcli("analyze", case(name), "--get", "totals.volume").out) == 2000
