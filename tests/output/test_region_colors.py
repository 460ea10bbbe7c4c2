"""Colours of regions: those of the table of labels, at each vertex those of most of its faces."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.errors import UsageError
from curvcli.output.appearance import Appearance
from curvcli.output.coloring import colored, colors
from tests.helpers.cli.program import curvcli as program
from tests.helpers.meshes import of_sample
from tests.loading.test_label_files import CODES, TABLE, annotation

BALL = of_sample("icosphere", size=42)
APPEARANCE = Appearance(color_by=("region",))


def analysed(regions: Any) -> Any:
    return curvcli.analyze(tuple(BALL), regions=regions)


def test_colours_of_an_annotation(tmp_path: Path) -> None:
    path = tmp_path / "lh.aparc.annot"
    path.write_bytes(annotation())
    painted = colored(analysed(str(path)), "region", APPEARANCE)
    assert painted.quantity.labels == ("unknown", "insula", "cuneus")
    inner = np.array([len(np.unique(CODES[BALL.faces[(BALL.faces == v).any(axis=1)]])) == 1 for v in range(len(CODES))])
    np.testing.assert_array_equal(painted.scale.rgb[inner], TABLE[CODES[inner], :3])
    assert sum(category.count for category in painted.scale.categories) == len(CODES)


def test_a_vertex_has_the_region_of_most_of_its_faces() -> None:
    labels = np.arange(len(BALL.faces)) % 3 - 1
    scale = colored(analysed(labels), "region", APPEARANCE).scale
    named = {category.name: category.color for category in scale.categories}
    for vertex in range(len(BALL.points)):
        own = labels[(BALL.faces == vertex).any(axis=1)]
        counts = {label: np.count_nonzero(own == label) for label in (0, 1)}
        most = [label for label, count in counts.items() if count == max(counts.values()) > 0]
        color = tuple(scale.rgb[vertex].tolist())
        assert color in [named[str(label)] for label in most] if most else color == tuple(scale.undefined)


def test_regions_colour_meshes_and_are_refused_without_labels(tmp_path: Path) -> None:
    named = colors(analysed(CODES), APPEARANCE)
    assert named is not None
    assert named[0] == "region"
    with pytest.raises(UsageError, match="none without --regions"):
        colored(analysed(None), "region", APPEARANCE)
    BALL.write(tmp_path / "ball.obj")
    ended = program("analyze", tmp_path / "ball.obj", "-o", tmp_path / "ball.ply", "--color-by", "region")
    assert (ended.code, ended.complaint) == (2, "--color-by region: there are none without --regions")
    np.save(tmp_path / "labels.npy", CODES)
    outputs = [word for name in ("b.ply", "b.html", "b.glb") for word in ("-o", str(tmp_path / name))]
    options = ("--regions", tmp_path / "labels.npy", "--color-by", "region", "-q")
    assert program("analyze", tmp_path / "ball.obj", *options, *outputs).code == 0
