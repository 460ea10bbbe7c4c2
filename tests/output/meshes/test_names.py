"""Any name that a property may have: every mesh output is written, reads back, and keeps the name or says how."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import curvcli
from curvcli.loading.formats.ply.header import parse_header
from curvcli.output.meshes.names import fitting, one_word, xml_name
from curvcli.output.meshes.ply import write_ply
from curvcli.output.meshes.vtk import write_vtk
from curvcli.output.write import write_outputs

# Kept by every format: words that can be printed.
KEPT = [
    *("a:b", "Größe", "温度", "a/b", "a,b", '"q"', "<b>", "a&b", "&#65;", "]]>", "--", "=1+1", "@x", "a\\b", "[red]"),
    *("[link=x]", "é", "e\u0301", "É", "\U0001f600", "%s", "{0}", "f0", "0", "corner", "names", "-", "'", "a;b"),
    *("__class__", "Ω" * 300, "titles", "input_x", "s_x", "x_y", "end_header2"),
]
# Spelt in another way by some format.
RESPELT = ["\x1b[31m", "\u202e", "\x85x", "\x07", "n\x00z", "\u2028x", "vertex_indices", "\ufffe", "RGB"]
OURS = ["K", "input_K", "x_x", "status", "quality"]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


def ply_with(names: list[str]) -> bytes:
    header = ["ply", "format ascii 1.0", "element vertex 4", *(f"property double {axis}" for axis in "xyz")]
    header += [f"property double {name}" for name in names]
    header += ["element face 4", "property list uchar int vertex_index", *(f"property int {name}" for name in names)]
    rows = [[*point, *(10 * k + j for j in range(len(names)))] for k, point in enumerate(POINTS)]
    rows += [[3, *face, *(10 * k + j for j in range(len(names)))] for k, face in enumerate(FACES)]
    lines = [*header, "end_header", *(" ".join(map(str, row)) for row in rows)]
    return ("\n".join(lines) + "\n").encode()


def arrays_of(path: Path) -> dict[str, dict[str, list[float]]]:
    """Values of vertices and faces by name; of VTK's files by VTK, with the names that an XML parser finds."""
    if path.suffix == ".ply":
        file = curvcli.load(path).file
        assert file is not None
        return {
            "vertices": {name: list(map(float, values)) for name, values in file.vertex_properties.items()},
            "faces": {name: list(map(float, values)) for name, values in file.polygon_properties.items()},
        }
    pyvista = pytest.importorskip("pyvista", reason="pyvista is not installed")
    text = re.sub(rb"<AppendedData.*</AppendedData>", b"", path.read_bytes(), flags=re.DOTALL)
    parsed = ET.fromstring(text)
    read = pyvista.read(path)
    found = {}
    for key, tag, data in (("vertices", "PointData", read.point_data), ("faces", "CellData", read.cell_data)):
        names = [one.get("Name") for one in next(parsed.iter(tag))]
        assert names == list(data.keys())
        found[key] = {name: np.asarray(data[name], float).reshape(4, -1)[:, 0].tolist() for name in names}
    return found


@pytest.mark.parametrize("suffix", [".ply", ".vtp", ".vtu"])
@pytest.mark.parametrize("names", [*([name] for name in RESPELT), KEPT, [*KEPT, *RESPELT], OURS])
def test_every_name_is_kept_or_said(tmp_path: Path, names: list[str], suffix: str) -> None:
    (tmp_path / "m.ply").write_bytes(ply_with(names))
    analysis = curvcli.analyze(tmp_path / "m.ply")
    notices = write_outputs(analysis, [str(tmp_path / f"o{suffix}")])
    said = " ".join(notice.message for notice in notices if notice.code == "renamed_properties")
    found = arrays_of(tmp_path / f"o{suffix}")
    for key in ("vertices", "faces"):
        for place, name in enumerate(names):
            values = [10.0 * k + place for k in range(4)]
            if found[key].get(name) != values:
                assert name not in KEPT, (name, key)
                assert "->" in said, (name, key)
                assert values in found[key].values(), (name, key)
    if names == KEPT:
        assert notices == []


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".parquet", ".npz", ".obj", ".glb", ".json", ".md", ".html"])
def test_the_other_outputs_are_written(tmp_path: Path, suffix: str) -> None:
    (tmp_path / "m.ply").write_bytes(ply_with([*KEPT, *RESPELT]))
    for label in ("a:b", "温度", "\x1b[31m"):
        analysis = curvcli.analyze(tmp_path / "m.ply", regions=label)
        write_outputs(analysis, [str(tmp_path / f"o{suffix}")], force=True)
        assert (tmp_path / f"o{suffix}").stat().st_size


def test_words_that_meet_once_they_are_words() -> None:
    """Names of other formats have blanks, too."""
    names = ("a b", "a_b", "a  b", " a b ", "", "_", "\x07", "\\x07")
    values = {name: np.full(4, float(k)) for k, name in enumerate(names)}
    stream = io.BytesIO()
    points, faces = np.array(POINTS, float), np.array(FACES)
    (notice,) = write_ply(stream, points, faces, vertex_properties=values, face_properties=values)
    for element in parse_header(stream.getvalue()).elements:
        words = [one.name for one in element.properties]
        assert len(set(words)) == len(words)
        assert {"a_b", "_", "\\x07"} <= set(words)
    assert "a b -> input_a_b" in notice.message
    assert notice.count == 5


def test_arrays_of_vtk_do_not_replace_each_other() -> None:
    pytest.importorskip("vtkmodules", reason="vtk is not installed")
    stream = io.BytesIO()
    names = ("RGB", "RGB_x", "RGB_y", "RGB_z", "a b", "")
    values = {name: np.full(4, float(k)) for k, name in enumerate(names)}
    colors = np.zeros((4, 3), np.uint8)
    points, faces = np.array(POINTS, float), np.array(FACES)
    (notice,) = write_vtk(stream, ".vtp", points, faces, vertex_properties=values, vertex_colors=colors)
    assert "RGB -> input_RGB" in notice.message
    found = re.findall(rb'Name="([^"]*)"', stream.getvalue())
    assert found[:7] == [b"input_RGB", b"RGB_x", b"RGB_y", b"RGB_z", b"a b", b"_", b"RGB"]


def test_fitting_changes_no_name_for_one_that_needs_it() -> None:
    assert fitting(["a b", "a_b"], one_word) == {"a b": "input_a_b", "a_b": "a_b"}
    assert fitting(["x"], one_word, "xyz") == {"x": "input_x"}
    assert fitting(["x", "input_x"], one_word, "xyz") == {"x": "input_input_x", "input_x": "input_x"}
    assert xml_name("\x00\t\ud800\uffff\U0001f600") == "\\x00\t\\ud800\\uffff\U0001f600"
