"""The input's properties beside ours, and meshes by suffix."""

from __future__ import annotations

import io

import numpy as np
import pytest
import trimesh

from curvcli.output.meshes.write import beside_input, write_mesh
from curvcli.output.registry import suffixes

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.5]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


@pytest.mark.parametrize("suffix", sorted({*suffixes(["mesh", "triangles"])} - {".vtp", ".vtu", ".fe"}))
def test_every_promised_mesh_is_written(suffix: str) -> None:
    stream = io.BytesIO()
    assert write_mesh(stream, suffix, POINTS, FACES, vertex_colors=np.zeros((4, 3), np.uint8)) == ()
    stream.seek(0)
    mesh = trimesh.load_mesh(stream, file_type=suffix[1:], process=False)
    np.testing.assert_array_equal(mesh.triangles, POINTS[FACES])


def test_names_that_do_not_meet_stay() -> None:
    merged, notices = beside_input({"K": np.zeros(4)}, {"quality": np.ones(4), "red": np.ones(4, np.uint8)})
    assert list(merged) == ["quality", "red", "K"]
    assert notices == ()


def test_ours_win_the_name() -> None:
    ours, inputs = (
        {"K": np.zeros(4)},
        {"K": np.ones(4), "red": np.ones(4), "alpha": np.ones(4), "input_K": np.full(4, 2)},
    )
    merged, (notice,) = beside_input(ours, inputs, colored=True)
    assert {name: np.asarray(column)[0] for name, column in merged.items()} == {
        "input_input_K": 1,
        "input_red": 1,
        "input_alpha": 1,
        "input_K": 2,
        "K": 0,
    }
    assert (notice.code, notice.count) == ("renamed_properties", 3)
    assert "red -> input_red" in notice.message
