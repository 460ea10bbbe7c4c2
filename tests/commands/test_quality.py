"""Assertions on the quality of triangles."""

from __future__ import annotations

from collections.abc import Callable

from tests.helpers.cli.program import Ended


def test_an_assertion_reads_the_quality_of_triangles(within: Callable[..., Ended]) -> None:
    within("sample", "icosphere", "-o", "ball.ply")
    good = ("--assert", "min(angle_min) >= 0.17", "--assert", "max(delaunay_defect) <= 0")
    assert within("check", "ball.ply", *good).code == 0
    ended = within("check", "ball.ply", "--assert", "max(aspect_ratio) <= 1.01")
    assert ended.code == 1
    assert "max(aspect_ratio) = 1.13198 at face" in ended.out
