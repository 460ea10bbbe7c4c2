"""Labels of vertices pass to faces: that of two corners, else of the lowest corner."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import curvcli
from curvcli.loading.face_labels import from_vertices
from curvcli.loading.label_files.text import read_text
from tests.helpers import meshes


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1), st.integers(-1, 4))
def test_against_the_rule_in_words(seed: int, most: int) -> None:
    rng = np.random.default_rng(seed)
    labels = rng.integers(-1, most + 1, 9).astype(np.int32)
    faces = np.array([rng.permutation(9)[:3] for _ in range(20)])
    result, unlike, undecided = from_vertices(labels, faces)
    counted = [0, 0]
    for face, label in zip(faces.tolist(), result.tolist(), strict=True):
        own = [int(labels[corner]) for corner in face]
        pairs = [one for one in own if own.count(one) >= 2]
        assert label == (pairs[0] if pairs else labels[min(face)])
        counted[0] += len(set(own)) > 1
        counted[1] += len(set(own)) == 3
    assert counted == [unlike, undecided]


def test_vertices_by_number_by_header_and_ambiguous() -> None:
    body = meshes.tetrahedron()  # four faces, four vertices
    labels = np.array([0, 0, 1, 1])
    (notice,) = [n for n in curvcli.analyze(tuple(body), regions=labels).notices if n.code == "ambiguous_labels"]
    assert notice.count == 4
    assert read_text(b"vertex\n0\n0\n1\n1\n").element == "vertex"
    assert read_text(b"face_label\nlow\nlow\nhigh\nhigh\n").element == "face"
    ball = meshes.of_sample("icosphere", size=42)
    labels = (ball.points[:, 2] > 0).astype(int)
    result = curvcli.analyze(tuple(ball), regions=labels)
    faces = labels[ball.faces].sum(axis=1) >= 2
    assert [region["topology"]["faces"] for region in result.report()["regions"]] == [(~faces).sum(), faces.sum()]
    (notice,) = [n for n in result.notices if n.code == "labels_of_vertices"]
    assert notice.count == np.count_nonzero(np.ptp(labels[ball.faces], axis=1))
