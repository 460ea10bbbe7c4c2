"""The surfaces for tests of readers, through the formats with the longest history."""

from __future__ import annotations

import numpy as np
import pytest

from curvcli import analyze
from tests.helpers.every_format import SHAPES, assert_reads, assert_refused, moebius, read_cuts, sphere
from tests.helpers.variants import obj, ply


@pytest.mark.parametrize("name", SHAPES)
def test_text_is_read_to_the_last_digit(name: str) -> None:
    shape = SHAPES[name]()
    for write in (obj(), ply("ascii"), ply("binary_big_endian")):
        data = write(shape.points.tolist(), shape.polygons)
        assert_reads(data, shape)
        assert_reads(data, shape, weld="exact", merged="exact")
    single = shape.single()
    assert_reads(ply("binary_little_endian", "float")(single.points.tolist(), single.polygons), single)


def test_the_surfaces_are_what_their_names_say() -> None:
    ball, strip = (analyze(make().surface(), "topology").report()["topology"] for make in (sphere, moebius))
    assert (ball["unreferenced_vertices"], ball["duplicate_vertices"]) == (1, 1)
    assert np.array_equal(sphere().points[17], sphere().points[40])
    assert not strip["orientable"]
    assert sorted(moebius().sizes)[-2:] == [3, 4]


def test_every_cut_is_refused() -> None:
    shape = moebius()
    data = ply("binary_little_endian")(shape.points.tolist(), shape.polygons)
    assert read_cuts(data) == []
    assert_refused(data[:-1], "face")
