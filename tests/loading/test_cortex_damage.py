"""Damaged surfaces and labels of FreeSurfer and GIFTI: read or refused in one line, whatever the damage."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from curvcli.errors import InputError
from curvcli.loading.label_files.read import read_labels
from tests.fuzz.damage import damaged
from tests.helpers.cortex import ENCODINGS, data_array, gifti, quadrangles, surface_gii, text, triangles
from tests.helpers.every_format import Shape, is_refused
from tests.loading.test_label_files import CODES, LABEL_TABLE, annotation, by_vertex, values_of

pytest.importorskip("nibabel", reason="nibabel reads GIFTI")

SQUARE = Shape(np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0.25]]), ((0, 1, 2), (0, 2, 3)))
QUADS = [quadrangles(SQUARE.points, np.array([[0, 1, 2, 3]]), old=old) for old in (False, True)]
LABELLED = gifti(
    data_array(SQUARE.points.astype("f4"), "POINTSET"),
    data_array(SQUARE.triangles, "TRIANGLE"),
    data_array(np.arange(4, dtype="i4"), "LABEL"),
    table=LABEL_TABLE,
)
SURFACES = {
    "freesurfer": [triangles(SQUARE), text(SQUARE), *QUADS],
    "gii": [LABELLED, *(surface_gii(SQUARE, encoding=encoding) for encoding in ENCODINGS)],
}
LABELS = {
    "a.annot": [annotation(CODES[:4]), annotation(CODES[:4], old=True)],
    "a.label": [b"#!ascii label\n2\n0 0.5 0.5 0.5 0.1\n1 0.5 0.5 0.5 0.1\n"],
    "lh.curv": [values_of(CODES[:4]), values_of(CODES[:4], old=True)],
    "a.gii": [gifti(data_array(CODES[:4], "LABEL"), table=LABEL_TABLE)],
    "a.csv": [by_vertex(range(5)).encode(), b"1\n2\n3\n", b"a\nb\n"],
    "a.txt": [b"vertex label\n0 1\n1 1\n"],
}


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=100, suppress_health_check=[HealthCheck.too_slow])
@given(st.data())
def test_damaged_surfaces(name: str, data: st.DataObject) -> None:
    content = data.draw(st.sampled_from(SURFACES[name]))
    is_refused(data.draw(damaged(content, data.draw(st.sampled_from(SURFACES[name])))), input_format=name)


@settings(max_examples=200, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_labels(tmp_path: Path, data: st.DataObject) -> None:
    name = data.draw(st.sampled_from(sorted(LABELS)))
    (tmp_path / name).write_bytes(data.draw(damaged(data.draw(st.sampled_from(LABELS[name])), LABELLED)))
    with contextlib.suppress(InputError):
        read_labels(str(tmp_path / name))
