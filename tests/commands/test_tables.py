"""`--table` in every format reads back to what the library says, cell by cell."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars
import pytest
from numpy.typing import NDArray

import curvcli
from curvcli.api import Analysis
from curvcli.curvatures.quantity import Element
from curvcli.curvatures.registry import passes
from tests.helpers.cli.program import Ended, wrote
from tests.helpers.meshes import of_sample

Run = Callable[..., Ended]
SUFFIXES = (".csv", ".tsv", ".parquet", ".npz")
NAMES = ["mobius", "annulus", "two_components", "book", "pinched"]


def saved(name: str, folder: Path) -> tuple[Path, Path]:
    """A sample as OBJ, and labels for its faces: thirds of the list, one of them without a label."""
    made = of_sample(name, size=120)
    mesh, labels = made.write(folder / f"{name}.obj"), folder / "labels.txt"
    count = len(made.faces)
    labels.write_text("\n".join(str(3 * k // count - (k == 5) * 9) for k in range(count)))
    return mesh, labels


def read(path: Path) -> dict[str, list[Any]]:
    """Columns as lists, null where nothing is defined."""
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            table: dict[str, list[Any]] = {}
            for key in arrays.files:
                if key.endswith("_names"):
                    stem = key.removesuffix("_names")
                    words = [*arrays[key].tolist(), None]
                    table[stem] = [words[code] for code in arrays[stem]]
                elif f"{key}_names" not in arrays.files:
                    values = arrays[key].tolist()
                    table[key] = [None if value != value else value for value in values]
        return table
    if path.suffix == ".parquet":
        return polars.read_parquet(path).to_dict(as_series=False)
    separator = "\t" if path.suffix == ".tsv" else ","
    return polars.read_csv(path, separator=separator, infer_schema_length=None).to_dict(as_series=False)


def nullable(values: NDArray[Any]) -> list[Any]:
    return [None if value != value else value for value in values.tolist()]


def of_elements(result: Analysis, element: Element) -> dict[str, list[Any]]:
    """Every quantity of edges or faces as the library gives it, vectors by component."""
    columns = result.edges if element == "edge" else result.faces
    found: dict[str, list[Any]] = {}
    for quantity in passes.quantities(element):
        values = columns[quantity.stem]
        each = values.T if quantity.vector else [values]
        found |= {name: nullable(column) for name, column in zip(quantity.columns, each, strict=True)}
    return found


def of_pieces(pieces: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """The report's entries as columns, under their last keys."""
    rows = []
    for piece in pieces:
        flat = dict(piece["topology"]) | ({"name": piece["name"]} if "name" in piece else {})
        flat |= piece["totals"]
        for section in ("steiner", "cmc", "minimal", "normals"):
            flat |= {f"{section}_{key}": value for key, value in piece[section].items()}
        rows.append(flat)
    return spread(rows)


def spread(rows: list[dict[str, Any]]) -> dict[str, list[Any]]:
    """Rows as columns; a list becomes one column per entry."""
    columns: dict[str, list[Any]] = {}
    for key in rows[0]:
        values = [row[key] for row in rows]
        long = next((len(value) for value in values if isinstance(value, list)), 0)
        for k in range(long):
            suffix = "xyz"[k] if long == 3 else str(k)
            columns[f"{key}_{suffix}"] = [None if value is None else value[k] for value in values]
        if not long:
            columns[key] = values
    return columns


def agree(found: dict[str, list[Any]], wanted: dict[str, list[Any]]) -> None:
    for name, values in wanted.items():
        # A column of nulls alone may be spelled out or left out; a vector unknown in every row is one null.
        if all(value is None for value in values):
            known = [column for key, column in found.items() if key == name or key.startswith(f"{name}_")]
            assert not [cell for column in known for cell in column if cell is not None], name
            continue
        assert len(found[name]) == len(values), name
        wrong = [pair for pair in zip(found[name], values, strict=True) if not same(*pair)]
        assert not wrong, (name, wrong[:5])


def same(cell: object, value: object) -> bool:
    """The very double; a label that looks like a number may have become one."""
    return (cell is None) == (value is None) and (cell == value or (isinstance(value, str) and str(cell) == value))


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("name", NAMES)
def test_every_table_reads_back_in_full(name: str, suffix: str, within: Run, tmp_path: Path) -> None:
    mesh, labels = saved(name, tmp_path)
    kinds = ("edges", "faces", "loops", "regions", "components")
    tables = [part for kind in kinds for part in ("--table", f"{kind}={kind}{suffix}")]
    wrote(within("analyze", mesh, "-q", "-p", "all", "--regions", labels, *tables))
    result = curvcli.analyze(mesh, "all", regions=str(labels))
    report, surface = result.report(), result.surface
    got = {kind: read(tmp_path / f"{kind}{suffix}") for kind in kinds}

    edges = {"edge": list(range(len(surface.edges)))} | {key: getattr(surface.edges, key).tolist() for key in "ab"}
    edges |= {"faces": surface.edges.valence.tolist()} | of_elements(result, "edge")
    agree(got["edges"], edges)
    assert list(got["edges"]) == list(edges)

    faces = {key: list(range(surface.n_faces)) for key in ("face", "polygon")}
    faces |= {key: surface.faces[:, k].tolist() for k, key in enumerate("abc")} | of_elements(result, "face")
    assert result.regions is not None
    words = [*result.regions.names, None]
    faces |= {"region": [words[code] for code in result.regions.face]}
    agree(got["faces"], faces)
    assert list(got["faces"]) == list(faces)

    assert got["loops"]["loop"] == list(range(len(report["loops"])))
    if report["loops"]:
        agree(got["loops"], spread(report["loops"]))
    for kind in ("regions", "components"):
        agree(got[kind], of_pieces(report[kind]))
    assert got["components"]["component"] == list(range(len(report["components"])))
    assert got["regions"]["name"] == got["regions"]["region"]
    assert got["regions"]["name"] in ([0, 1, 2], ["0", "1", "2"])


def test_tables_of_pieces_have_the_same_columns_whatever_the_mesh(within: Run, tmp_path: Path) -> None:
    """Vectors and numbers that no piece has, one piece has, or all have: the names and the types stay."""
    found = []
    for name in ("mobius", "two_components", "annulus", "pinched"):
        mesh, labels = saved(name, tmp_path)
        tables = [part for kind in ("components", "regions") for part in ("--table", f"{kind}={kind}.parquet")]
        wrote(within("analyze", mesh, "-q", "-p", "paper", "--regions", labels, *tables, "--force"))
        found.append([polars.read_parquet_schema(f"{kind}.parquet") for kind in ("components", "regions")])
    # The words of a column of labels are part of its type.
    shown = [[(key, type(kind)) for table in tables for key, kind in table.items()] for tables in found]
    assert shown[1:] == shown[:1] * 3
    assert dict(found[0][0])["genus"] == polars.Int64
    names = [key for key, _ in shown[0]]
    assert {"A_vec_x", "steiner_coefficients_3"} < set(names)
    assert not {"A_vec", "steiner_coefficients"} & set(names)


def test_faces_and_regions_join_on_the_label(within: Run, tmp_path: Path) -> None:
    mesh, labels = saved("annulus", tmp_path)
    count = len(labels.read_text().split())
    labels.write_text("\n".join(["7"] * 10 + ["5"] * (count - 10)))
    tables = [part for kind in ("faces", "regions") for part in ("--table", f"{kind}={kind}.csv")]
    wrote(within("analyze", mesh, "-q", "--regions", labels, *tables))
    faces, regions = read(Path("faces.csv")), read(Path("regions.csv"))
    counted = {label: faces["region"].count(label) for label in (5, 7)}
    assert dict(zip(regions["region"], regions["faces"], strict=True)) == counted == {5: count - 10, 7: 10}


def test_only_labels_that_some_face_has(within: Run, tmp_path: Path) -> None:
    mesh, labels = saved("annulus", tmp_path)
    labels.write_text("\n".join(["-1"] * 10 + ["4"] * (len(labels.read_text().split()) - 10)))
    wrote(within("analyze", mesh, "-q", "--regions", labels, "--table", "regions=r.csv", "--table", "faces=f.csv"))
    assert read(Path("r.csv"))["name"] == [4]
    assert read(Path("f.csv"))["region"][:12] == [None] * 10 + [4] * 2


@pytest.mark.parametrize("precision", ["6", "15"])
def test_precision_rounds_the_cells_of_tables(precision: str, within: Run, tmp_path: Path) -> None:
    mesh, _ = saved("mobius", tmp_path)
    wrote(within("analyze", mesh, "-q", "--precision", precision, "--table", "edges=e.csv", "--table", "loops=l.csv"))
    result = curvcli.analyze(mesh, "all")
    length = result.edges["length"]
    assert read(Path("e.csv"))["length"] == [float(f"{x:.{int(precision) - 1}e}") for x in length.tolist()]
    (loop,) = result.report()["loops"]
    assert read(Path("l.csv"))["length"] == [float(f"{loop['length']:.{int(precision) - 1}e}")]


def test_one_mesh_after_the_other(within: Run, tmp_path: Path) -> None:
    """{stem} keeps the tables apart; without it nothing is begun."""
    meshes = [saved(name, tmp_path)[0] for name in ("annulus", "mobius")]
    refused = within("analyze", *meshes, "--table", "loops=l.csv")
    assert (refused.code, "{stem}" in refused.complaint, Path("l.csv").exists()) == (2, True, False)
    wrote(within("analyze", *meshes, "-q", "--table", "loops={stem}-l.csv"))
    assert [len(read(Path(f"{mesh.stem}-l.csv"))["loop"]) for mesh in meshes] == [2, 1]
    again = within("analyze", *meshes, "-q", "--table", "loops={stem}-l.csv")
    assert (again.code, "exist" in again.complaint) == (4, True)


def test_the_cells_of_a_merged_row_are_empty(within: Run) -> None:
    """All but its index, its position and the row that holds its values; a vertex without a face is another thing."""
    points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 5 5 5\n"
    Path("seam.obj").write_text(f"{points}f 1 2 3\nf 3 4 5\n")
    wrote(
        within(
            "analyze", "seam.obj", "-q", "--weld", "exact", *(f"--output=t{suffix}" for suffix in (*SUFFIXES, ".ply"))
        )
    )
    for suffix in SUFFIXES:
        table = read(Path(f"t{suffix}"))
        assert {key for key, column in table.items() if column[3] is not None} == {"vertex", *"xyz", "welded_to"}
        assert table["status"] == ["boundary"] * 3 + [None, "boundary", "unreferenced"]
    assert b"255 none" in Path("t.ply").read_bytes()
