"""The package as a library: what it takes, what it gives, and that it is what the command line gives."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from click.testing import CliRunner

import curvcli
from curvcli.commands.main import cli
from curvcli.errors import InputError, OutputError, UsageError
from tests.helpers import exact_values, meshes
from tests.helpers.columns import PUBLIC


def test_the_names_promised() -> None:
    assert {"load", "analyze", "Surface", "Analysis", "passes", "errors", "__version__"} == set(dir(curvcli))
    for name in dir(curvcli):
        assert getattr(curvcli, name) is not None
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = curvcli.no_such_name


def test_load_gives_a_read_only_surface() -> None:
    surface = curvcli.load(exact_values.MESHES["cube"])
    assert isinstance(surface, curvcli.Surface)
    assert surface.points.shape == (8, 3)
    assert surface.faces.shape == (12, 3)
    assert not surface.points.flags.writeable
    assert not surface.faces.flags.writeable
    again = curvcli.load(str(exact_values.MESHES["cube"]))
    np.testing.assert_array_equal(again.points, surface.points)


def test_everything_that_is_a_surface_gives_the_same() -> None:
    path = exact_values.MESHES["torus_irregular"]
    surface = curvcli.load(path)
    points, faces = np.array(surface.points), np.array(surface.faces)
    sources: list[Any] = [
        path,
        str(path),
        surface,
        (points, faces),
        (points.tolist(), faces.tolist()),
        (np.asfortranarray(points), faces.astype(np.uint64)),
        trimesh.Trimesh(points, faces, process=False),
    ]
    with path.open("rb") as stream:
        sources.append(curvcli.load(stream, input_format=path.suffix[1:]))
    wanted = curvcli.analyze(surface, "all")
    for source in sources:
        found = curvcli.analyze(source, "all")
        for name in PUBLIC:
            np.testing.assert_array_equal(found.column(name), wanted.column(name), err_msg=name)
        assert found.totals == wanted.totals


@pytest.mark.parametrize("given", [3, None, [1, 2, 3], ("one",), np.eye(3)])
def test_what_is_no_surface(given: Any) -> None:
    with pytest.raises(TypeError, match="expected a Surface, a path"):
        curvcli.analyze(given)


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.obj"):
        curvcli.analyze(tmp_path / "none.obj")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"passes": "kapa_1"}, "kappa_1"),
        ({"passes": ["K", "hh"]}, "unknown pass 'hh'"),
        ({"area": "voronoy"}, "expected one of"),
        ({"mean": "sums"}, "expected one of"),
        ({"orient": "outwards"}, "expected one of"),
    ],
)
def test_an_unknown_option_is_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        curvcli.analyze(meshes.tetrahedron().surface(), **options)


def test_inputs_are_neither_changed_nor_held() -> None:
    body = meshes.ellipsoid()
    points, faces = body.points.copy(), body.faces.copy()
    surface = curvcli.Surface(points, faces)
    result = curvcli.analyze(surface, "all")
    np.testing.assert_array_equal(points, body.points)
    np.testing.assert_array_equal(faces, body.faces)
    assert points.flags.writeable
    assert faces.flags.writeable
    before = {name: result.column(name).copy() for name in PUBLIC}
    points *= 3
    faces[:] = faces[:, ::-1]
    after = curvcli.analyze(surface, "all")
    for name in PUBLIC:
        np.testing.assert_array_equal(after.column(name), before[name], err_msg=name)


@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_may_be_changed_afterwards(order: Any) -> None:
    """A surface holds copies of arrays of any layout and type."""
    body = meshes.tetrahedron()
    for points in (np.array(body.points, order=order), np.array(body.points.T, order=order).T):
        faces = np.array(body.faces, np.int32, order=order)
        surface = curvcli.Surface(points, faces)
        assert not np.shares_memory(surface.points, points)
        assert not np.shares_memory(surface.faces, faces)
        assert points.flags.writeable
        assert faces.flags.writeable


def test_columns_are_mappings() -> None:
    result = curvcli.analyze(meshes.zoo("cap").surface(), "all")
    vertices = result.vertices
    assert len(vertices) == len(list(vertices))
    for name, quantity in PUBLIC.items():
        table = {"vertex": result.vertices, "edge": result.edges, "face": result.faces}[quantity.on]
        column = table[quantity.stem]
        assert not column.flags.writeable, name
        if quantity.vector:
            assert column.shape[1:] == (3,)
            for k, part in enumerate(quantity.columns):
                np.testing.assert_array_equal(table[part], column[:, k])
        else:
            assert column.ndim == 1
    assert "no_such_column" not in vertices
    with pytest.raises(KeyError):
        vertices["no_such_column"]
    assert vertices.keys() >= {"K", "A_vec", "A_vec_x"}


def test_only_what_was_asked_for_is_shown() -> None:
    result = curvcli.analyze(meshes.tetrahedron().surface(), ["K", "A_vec"])
    assert list(result.vertices) == ["K", "A_vec", "A_vec_x", "A_vec_y", "A_vec_z"]
    assert "K" not in result.edges
    assert result.edges["length"].shape == (6,)
    assert result.faces["normal"].shape == (4, 3)


def test_the_defaults_are_the_core_columns() -> None:
    result = curvcli.analyze(meshes.tetrahedron().surface())
    assert {"K", "h_signed", "kappa_1", "willmore"} <= result.vertices.keys()
    usual = {"mean": "sum", "area": "barycentric", "orient": "file", "weld": "none", "unit": None}
    assert result.report()["conventions"].items() >= usual.items()


def test_conventions_are_recorded() -> None:
    body = meshes.reversed_faces(meshes.ellipsoid())
    result = curvcli.analyze(body.surface(), "all", mean="average", orient="outward", unit="mm")
    said = result.report()["conventions"]
    assert (said["mean"], said["orient"], said["unit"]) == ("average", "outward", "mm")
    assert result.report()["columns"]["A"]["unit"] == "mm^2"
    kept = curvcli.analyze(body.surface("outward"))
    assert kept.report()["conventions"]["orient"] == "outward"
    assert kept.vertices["h_signed"].min() > 0


def test_a_reoriented_surface_keeps_what_was_said_of_its_file(tmp_path: Path) -> None:
    file = tmp_path / "quad.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\n")
    codes = [notice.code for notice in curvcli.analyze(curvcli.load(file), orient="outward").notices]
    assert codes == [notice.code for notice in curvcli.analyze(file).notices]
    assert "repeated_corner_faces" in codes


def test_totals_are_plain_numbers() -> None:
    totals = curvcli.analyze(meshes.zoo("cap").surface(), "all").totals
    assert json.loads(json.dumps(totals)) == totals
    assert totals["volume"] is None


def test_the_report_is_plain_data() -> None:
    for name in meshes.ZOO:
        report = curvcli.analyze(meshes.zoo(name).surface(), "all").report()
        assert json.loads(json.dumps(report, allow_nan=False)) == report


def test_write_refuses_a_file_that_exists(tmp_path: Path) -> None:
    result = curvcli.analyze(meshes.zoo("cap").surface(), "all")
    result.write(tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text())["topology"] == result.report()["topology"]
    with pytest.raises(OutputError, match="exists"):
        result.write(tmp_path / "a.json")
    (tmp_path / "a.json").write_text("")
    result.write(tmp_path / "a.json", force=True)
    assert json.loads((tmp_path / "a.json").read_text())["totals"] == result.report()["totals"]


@pytest.mark.parametrize("name", ["disk", "mobius", "two_components", "unreferenced"])
def test_the_command_line_gives_the_same_numbers(name: str, tmp_path: Path) -> None:
    """Every cell of the table reads back to the very double of the library, and so does the report."""
    import polars

    path = exact_values.MESHES[name]
    table, report = tmp_path / "t.csv", tmp_path / "r.json"
    arguments = ["analyze", str(path), "-p", "all", "-o", str(table), "-o", str(report), "--mean", "average"]
    assert CliRunner().invoke(cli, arguments, standalone_mode=False).return_value == 0
    result = curvcli.analyze(path, "all", mean="average")
    frame = polars.read_csv(table, infer_schema_length=None)
    assert frame["vertex"].to_list() == list(range(result.surface.n_vertices))
    for k, axis in enumerate("xyz"):
        np.testing.assert_array_equal(frame[axis].to_numpy(), result.surface.points[:, k])
    for quantity in PUBLIC.values():
        if quantity.on != "vertex":
            continue
        column = result.vertices[quantity.stem]
        if quantity.labels:
            assert frame[quantity.stem].to_list() == column.tolist()
            continue
        for k, part in enumerate(quantity.columns):
            found = frame[part].cast(polars.Float64).fill_null(np.nan).to_numpy()
            wanted = column[:, k] if quantity.vector else column.astype(np.float64)
            if quantity.kind == "count":
                wanted = np.where(result.surface.referenced, wanted, np.nan)
            np.testing.assert_array_equal(found, wanted, err_msg=part)
    said, own = json.loads(report.read_text()), result.report()
    for key in ("topology", "totals", "components", "columns", "conventions"):
        assert said[key] == own[key], key
    assert [check["residual"] for check in said["checks"]] == [check["residual"] for check in own["checks"]]
