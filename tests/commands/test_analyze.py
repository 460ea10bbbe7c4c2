"""`curvcli analyze`: what each option does, seen from outside."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import numpy as np
import polars
import pytest
import trimesh

import curvcli as package
from tests.helpers import meshes
from tests.helpers.cli.program import CUBE, DISK, MOBIUS, UNREFERENCED, curvcli, wrote


def rows(text: str, separator: str = ",") -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text), delimiter=separator))


def report(*arguments: str | Path) -> dict[str, Any]:
    ended = curvcli("analyze", *arguments, "--json")
    wrote(ended)
    found: dict[str, Any] = json.loads(ended.out)
    return found


def test_the_summary_has_checks_and_totals() -> None:
    ended = curvcli("analyze", DISK)
    wrote(ended)
    for word in (DISK, "gauss_bonnet", "force_balance", "pass", "area", "willmore", "kappa_g", "orient file"):
        assert word in ended.out
    assert "\x1b" not in ended.out
    # Tables are narrow; sentences are lines of their own, which nothing breaks.
    assert all(len(line) <= 100 for line in ended.out.splitlines() if line.startswith(" "))


def test_quiet_and_verbose(tmp_path: Path) -> None:
    """With -v the checks of every component are told."""
    two = tmp_path / "two.obj"
    two.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n")
    assert curvcli("analyze", two, "-q") == (0, "", "")
    plain, more = curvcli("analyze", two), curvcli("analyze", two, "-v")
    assert plain.code == more.code == 0
    assert "component 1" not in plain.out
    assert "component 1" in more.out


def test_json_is_the_report_and_fits_its_schema() -> None:
    schema = curvcli("analyze", "--schema")
    wrote(schema)
    described = json.loads(schema.out)
    jsonschema.Draft202012Validator.check_schema(described)
    for mesh in (CUBE, MOBIUS, UNREFERENCED):
        found = report(mesh, "-p", "all")
        jsonschema.validate(found, described)
        assert found["schema_version"] == 1
        assert found["curvcli"] == package.__version__
        assert found["input"]["path"] == mesh
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(found | {"topology": {}}, described)


def test_json_of_several_meshes_is_a_list() -> None:
    ended = curvcli("analyze", CUBE, DISK, "--json")
    wrote(ended)
    assert [one["input"]["path"] for one in json.loads(ended.out)] == [CUBE, DISK]


def test_get_prints_the_value_of_the_report() -> None:
    found = report(CUBE)
    for path, value in (
        ("totals.area", found["totals"]["area"]),
        ("topology.crosscaps", None),
        ("checks.gauss_bonnet.status", "pass"),
        ("components.0.topology.faces", 12),
    ):
        ended = curvcli("analyze", CUBE, "--get", path)
        wrote(ended)
        text = ended.out.rstrip("\n")
        assert ended.out == text + "\n"
        assert (text if isinstance(value, str) else json.loads(text)) == value


@pytest.mark.parametrize(
    ("path", "near"), [("totals.arae", "area"), ("total", "totals"), ("topology.genus.x", "single value")]
)
def test_get_what_is_not_there(path: str, near: str) -> None:
    ended = curvcli("analyze", CUBE, "--get", path)
    assert ended.code == 2
    assert near in ended.complaint


def test_topology_computes_only_degrees() -> None:
    found = report(MOBIUS, "-p", "topology")
    assert set(found["columns"]) == {"degree"}
    assert (found["topology"]["crosscaps"], found["topology"]["orientable"]) == (1, False)
    ended = curvcli("analyze", CUBE, "-p", "topology", "-o", "-", "--format", "csv")
    wrote(ended)
    assert list(rows(ended.out)[0]) == ["vertex", "x", "y", "z", "status", "degree"]


@pytest.mark.parametrize("listed", [["-p", "K,h"], ["-p", "K", "-p", "h"], ["--pass", "h", "--pass", "K"]])
def test_columns_are_chosen(listed: list[str]) -> None:
    ended = curvcli("analyze", CUBE, *listed, "-o", "-", "--format", "csv")
    wrote(ended)
    assert list(rows(ended.out)[0]) == ["vertex", "x", "y", "z", "K", "h"]


def test_table_of_the_core_columns() -> None:
    ended = curvcli("analyze", UNREFERENCED, "-o", "-", "--format", "csv")
    wrote(ended)
    table = rows(ended.out)
    head = ["vertex", "x", "y", "z", "status", "degree", "K", "kappa_g", "A", "A_vec_x", "A_vec_y", "A_vec_z"]
    head += ["H_vec_x", "H_vec_y", "H_vec_z", "h", "h_signed", "K_density", "kappa_1", "kappa_2"]
    assert list(table[0]) == [*head, "willmore", "willmore_hks"]
    loose = [row for row in table if row["status"] == "unreferenced"]
    assert [row["vertex"] for row in loose] == ["2", "5"]
    for row in loose:
        assert all(row[column] == "" for column in head if column not in ("vertex", "x", "y", "z", "status"))
    assert all(row["kappa_g"] == "" for row in table)


def test_outputs_by_suffix(tmp_path: Path) -> None:
    names = ("t.csv", "t.tsv", "t.parquet", "t.npz", "m.ply", "m.obj", "r.json")
    paths = {name: tmp_path / name for name in names}
    wrote(curvcli("analyze", DISK, "-q", *(part for path in paths.values() for part in ("-o", path))))
    surface = package.load(DISK)
    K = package.analyze(surface, "K").vertices["K"]
    tables = [polars.read_csv(paths["t.csv"]), polars.read_csv(paths["t.tsv"], separator="\t")]
    tables.append(polars.read_parquet(paths["t.parquet"]))
    for table in tables:
        np.testing.assert_array_equal(table["K"].fill_null(np.nan).to_numpy(), K)
        np.testing.assert_array_equal(table["x"].to_numpy(), surface.points[:, 0])
    with np.load(paths["t.npz"]) as arrays:
        np.testing.assert_array_equal(arrays["K"], K)
    again = package.load(paths["m.ply"])
    np.testing.assert_array_equal(again.points, surface.points)
    np.testing.assert_array_equal(again.faces, surface.faces)
    assert again.file is not None
    np.testing.assert_array_equal(again.file.vertex_properties["K"], K)
    assert {"red", "green", "blue"} <= again.file.vertex_properties.keys()
    coloured = package.load(paths["m.obj"])
    np.testing.assert_array_equal(coloured.points, surface.points)
    np.testing.assert_array_equal(coloured.faces, surface.faces)
    assert json.loads(paths["r.json"].read_text())["topology"]["boundary_loops"] == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
    # Another program reads it too.
    assert len(trimesh.load_mesh(paths["m.ply"], process=False).faces) == surface.n_faces


def test_edges_and_faces_have_tables_of_their_own(tmp_path: Path) -> None:
    edges, faces = tmp_path / "e.csv", tmp_path / "f.csv"
    wrote(curvcli("analyze", CUBE, "-q", "--table", f"edges={edges}", "--table", f"faces={faces}"))
    table = rows(edges.read_text())
    assert list(table[0])[:6] == ["edge", "a", "b", "faces", "length", "theta"]
    assert len(table) == 18
    pairs = [(int(row["a"]), int(row["b"])) for row in table]
    assert pairs == sorted(pairs)
    assert all(a < b for a, b in pairs)
    head = list(rows(faces.read_text())[0])
    assert head[:6] == ["face", "polygon", "a", "b", "c", "area"]
    assert {"normal_x", "normal_y", "normal_z"} <= set(head)
    for wrong in ("edgse=x.csv", "edges", "edges="):
        assert curvcli("analyze", CUBE, "--table", wrong, folder=tmp_path).code == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["e.csv", "f.csv"]


def test_the_same_command_gives_the_same_bytes(tmp_path: Path) -> None:
    for run in ("one", "two"):
        folder = tmp_path / run
        folder.mkdir()
        wrote(curvcli("analyze", DISK, "-q", *(p for s in ("csv", "ply", "json") for p in ("-o", folder / f"o.{s}"))))
    for suffix in ("csv", "ply"):
        assert (tmp_path / "one" / f"o.{suffix}").read_bytes() == (tmp_path / "two" / f"o.{suffix}").read_bytes()
    one, two = (json.loads((tmp_path / run / "o.json").read_text()) for run in ("one", "two"))
    assert one.pop("timings").keys() == two.pop("timings").keys()
    assert one == two


def test_mean_and_area_change_what_they_should() -> None:
    summed, averaged = report(DISK), report(DISK, "--mean", "average")
    assert averaged["conventions"]["mean"] == "average"
    assert averaged["columns"]["h"]["max"] == summed["columns"]["h"]["max"] / 2
    assert averaged["totals"]["willmore"] == summed["totals"]["willmore"] / 4
    assert averaged["columns"]["kappa_1"] == summed["columns"]["kappa_1"]
    mixed = report(CUBE, "--area", "mixed")
    assert mixed["conventions"]["area"] == "mixed"
    assert mixed["columns"]["K_density"]["max"] == pytest.approx(np.pi / 2 / 0.75, rel=1e-14)
    named = report(DISK, "--unit", "mm")
    assert named["conventions"]["unit"] == "mm"
    assert (named["columns"]["A"]["unit"], named["columns"]["h"]["unit"]) == ("mm^2", "mm^-1")
    assert "mm^2" in curvcli("analyze", DISK, "--unit", "mm").out


def test_orient_turns_the_volume_positive(tmp_path: Path) -> None:
    file = meshes.reversed_faces(meshes.tetrahedron()).write(tmp_path / "in.obj")
    kept, turned = report(file), report(file, "--orient", "outward")
    assert kept["totals"]["volume"] == -5.0
    assert turned["totals"]["volume"] == 5.0
    hints = {warning["code"]: warning["hint"] for warning in kept["warnings"]}
    assert "--orient outward" in hints["inside_out"]


def test_weld_joins_a_seam(tmp_path: Path) -> None:
    file = tmp_path / "seam.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 5 4 6\n")
    apart, welded = report(file), report(file, "--weld", "exact")
    assert (apart["topology"]["components"], welded["topology"]["components"]) == (2, 1)
    assert apart["topology"]["duplicate_vertices"] == 2
    ended = curvcli("analyze", file, "--weld", "exact", "-p", "kappa_g", "-o", "-", "--format", "csv")
    wrote(ended)
    table = rows(ended.out)
    assert [row["welded_to"] for row in table] == ["", "", "", "1", "2", ""]
    assert [row["kappa_g"] == "" for row in table] == [False, False, False, True, True, False]
    assert curvcli("analyze", file, "--weld", "much").code == 2


def test_precision_shortens_the_numbers_of_tables(tmp_path: Path) -> None:
    ended = curvcli("analyze", CUBE, "-p", "K", "-o", "-", "--format", "csv", "--precision", "3")
    wrote(ended)
    assert {row["K"] for row in rows(ended.out)} == {"1.57"}
    full = curvcli("analyze", CUBE, "-p", "K", "-o", "-", "--format", "csv")
    assert {float(row["K"]) for row in rows(full.out)} <= {np.pi / 2, np.nextafter(np.pi / 2, 0)}
    for wrong in ("0", "18", "many"):
        assert "--precision" in curvcli("analyze", CUBE, "--precision", wrong, "-o", tmp_path / "t.csv").complaint


def colours(path: Path) -> np.ndarray[Any, np.dtype[Any]]:
    file = package.load(path).file
    assert file is not None
    return np.stack([file.vertex_properties[channel] for channel in ("red", "green", "blue")], axis=1)


def test_options_of_colours_change_the_colours(tmp_path: Path) -> None:
    def coloured(*options: str) -> np.ndarray[Any, np.dtype[Any]]:
        path = tmp_path / "m.ply"
        wrote(curvcli("analyze", DISK, "-q", "--force", "-o", path, *options))
        return colours(path)

    by_area = coloured("--color-by", "A")
    assert len(np.unique(by_area, axis=0)) > 20
    assert (by_area != coloured("--color-by", "h")).any()
    assert (by_area != coloured("--color-by", "A", "--cmap", "viridis")).any()
    assert len(np.unique(coloured("--color-by", "A", "--range", "100:200"), axis=0)) == 1
    assert (by_area != coloured("--color-by", "A", "--range", "p50")).any()
    coloured("--color-by", "A_vec_x")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--color-by", "kapa_1"], "kappa_1"),
        (["--cmap", "viridiss"], "viridis"),
        (["--range", "2:1"], "--range"),
        (["--range", "p0"], "--range"),
        (["--range", "nan:1"], "--range"),
    ],
)
def test_colours_that_are_not_known(options: list[str], words: str, tmp_path: Path) -> None:
    ended = curvcli("analyze", DISK, "-o", tmp_path / "m.ply", *options)
    assert ended.code == 2
    assert words in ended.complaint
    assert list(tmp_path.iterdir()) == []


def test_strict_passes_where_checks_pass() -> None:
    wrote(curvcli("analyze", CUBE, "--strict", "-q"))


@pytest.mark.parametrize("limit", [["--max-faces", "11"], ["--max-bytes", "20"]])
def test_a_limit_that_is_exceeded_ends_with_3(limit: list[str]) -> None:
    ended = curvcli("analyze", CUBE, *limit)
    assert ended.code == 3
    assert limit[0] in ended.complaint
