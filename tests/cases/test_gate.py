"""Meshes of shared/cases through `curvcli check`: the length of what is printed, and the hints in it."""

from __future__ import annotations

import pytest

from tests.helpers.cli.program import curvcli
from tests.helpers.shared import SHARED, needs_shared

pytestmark = needs_shared


def case(name: str) -> str:
    assert SHARED is not None
    path = SHARED / "cases" / name
    if not path.is_file():
        pytest.skip(f"no {name} in shared/cases")
    return str(path)


def test_a_hundred_bodies_print_a_screenful() -> None:
    ended = curvcli("check", case("bed_100_cubes.stl"))
    assert (ended.code, ended.err) == (0, "")
    assert len(ended.out.splitlines()) < 50
    assert "whole, 100 components" in ended.out
    assert ended.out.splitlines()[-1].endswith("certifies the curvatures and χ, not that the mesh is sound.")


@pytest.mark.parametrize("options", [(), ("-o", "-"), ("--format", "github")])
def test_check_shows_the_hint_of_analyze(options: tuple[str, ...]) -> None:
    ended = curvcli("check", case("seam_exact.obj"), "--require", "closed", *options)
    assert ended.code == 1
    assert "--weld exact would close all 48 boundary edges" in ended.out
