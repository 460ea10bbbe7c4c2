"""Files of labels: text, tables, FreeSurfer and GIFTI, compared with nibabel, and refused where damaged."""

from __future__ import annotations

import contextlib
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import curvcli
from curvcli.errors import InputError
from curvcli.loading.face_labels import from_vertices
from curvcli.loading.label_files.read import read_labels
from curvcli.mesh.file import Labels
from tests.helpers.cortex import ENCODINGS, data_array, gifti, three
from tests.helpers.meshes import of_sample

BALL = of_sample("icosphere", size=42)
V, F = len(BALL.points), len(BALL.faces)
NAMES = ["unknown", "insula", "cuneus"]
CODES = np.digitize(BALL.points[:, 2], [-0.4, 0.4]).astype(np.int32)
TABLE = np.array([[25, 5, 25, 0], [255, 192, 32, 0], [220, 20, 100, 0]])


def faces_of(path: Path) -> dict[str, int]:
    report = curvcli.analyze(tuple(BALL), "topology", regions=str(path)).report()
    return {region["name"]: region["topology"]["faces"] for region in report["regions"]}


def expected(codes: Any = CODES, names: list[str] = NAMES) -> dict[str, int]:
    faces = from_vertices(codes, BALL.faces)[0]
    return {name: int(count) for name in names if (count := np.count_nonzero(faces == names.index(name)))}


def names_and_codes(path: Path) -> tuple[list[str], Any]:
    labels = read_labels(str(path)).values
    assert isinstance(labels, Labels)
    return list(labels.names), labels.codes


# ---------------------------------------------------------------------------- text


def by_vertex(order: Any, words: bool = True, separator: str = ",") -> str:
    rows = [f"{k}{separator}{NAMES[CODES[k]] if words else CODES[k]}" for k in order]
    return "\n".join([separator.join(("vertex", "label")), *rows]) + "\n"


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".txt", ".CSV"])
@pytest.mark.parametrize("separator", [",", "\t", ";", " "])
def test_tables_by_vertex(suffix: str, separator: str, tmp_path: Path) -> None:
    path = tmp_path / f"labels{suffix}"
    for order in (range(V), np.random.default_rng(3).permutation(V).tolist()):
        path.write_text(by_vertex(order, separator=separator))
        assert faces_of(path) == expected()
        path.write_text(by_vertex(order, words=False, separator=separator))
        assert faces_of(path) == expected(names=["0", "1", "2"])


def test_words_by_line(tmp_path: Path) -> None:
    path, words = tmp_path / "names.txt", [NAMES[code] for code in CODES]
    for lines in (words, ["parcel", *words], [f'"{word}"' for word in words], ["vertex label", *words]):
        path.write_text("\r\n".join(lines))
        assert faces_of(path) == expected()
    faces = from_vertices(CODES, BALL.faces)[0]
    path.write_text("\n".join(NAMES[code] for code in faces))
    assert faces_of(path) == expected()


def test_tables_by_face_and_with_empty_cells(tmp_path: Path) -> None:
    path = tmp_path / "labels.csv"
    path.write_text("Face,Area,Region\n" + "".join(f"{k},{k / 2},{'' if k % 2 else 'even'}\n" for k in range(F)))
    assert faces_of(path) == {"even": F // 2}
    path.write_text("face,parcel\n3,one\n7,two\n8,two\n")
    assert faces_of(path) == {"one": 1, "two": 2}


def test_our_own_table_of_faces(tmp_path: Path) -> None:
    from tests.helpers.cli.program import curvcli as program

    path, table = tmp_path / "labels.npy", tmp_path / "faces.csv"
    np.save(path, CODES)
    BALL.write(tmp_path / "ball.obj")
    ended = program("analyze", tmp_path / "ball.obj", "--regions", path, "-q", "--table", f"faces={table}")
    assert ended.code == 0, ended.err
    assert faces_of(table) == faces_of(path) == expected(names=["0", "1", "2"])


REFUSED = {
    "range.csv": ("vertex,label\n0,1\n42,1\n", "vertex 42 found, 0 to 41 expected"),
    "minus.csv": ("vertex,label\n-1,1\n", "vertex -1 found"),
    "twice.csv": ("vertex,label\n3,1\n3,1\n", "vertex 3 has more than one label"),
    "word.csv": ("vertex,label\n0,1\nx,1\n", "row 3: `x` found, a whole number of `vertex` expected"),
    "large.csv": ("vertex,label\n99999999999999999999,1\n", "a whole number of `vertex` expected"),
    "ragged.csv": ("vertex,label\n0,1\n1\n", "row 3: 1 cells found, 2 expected"),
    "columns.csv": ("vertex,a,b\n0,1,2\n", "columns vertex, a, b found; name the column of labels `label`"),
    "header.csv": ("0,1\n1,1\n", "a table without a header"),
    "mixed.csv": ("vertex,label\n0,1\n1,insula\n", "row 3: 'insula', expected one whole number as elsewhere"),
    "mixed.txt": ("1\ninsula\n2\n", "line 2: 'insula', expected one whole number"),
    "half.csv": ("vertex,label\n0,1.5\n", "label 1.5 of vertex 0"),
    "pairs.txt": ("0 1\n1 1\n", "2 numbers in a line found, one label expected"),
    "few.txt": ("a\nb\nc\n", "3 labels, expected 80 (faces) or 42 (vertices)"),
    "header.txt": ("vertex\n" + "1\n" * 80, "80 labels, expected 42 (vertices)"),
    "quote.csv": ('vertex,label\n0,"' + "x" * 200_000, "field larger than field limit"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_text_that_is_refused(name: str, tmp_path: Path) -> None:
    text, message = REFUSED[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError) as raised:
        curvcli.analyze(tuple(BALL), regions=str(tmp_path / name))
    assert message in str(raised.value)
    assert str(raised.value).isprintable()


# ---------------------------------------------------------------------------- FreeSurfer


def integers(*numbers: int) -> bytes:
    return np.array(numbers, ">i4").tobytes()


def annotation(codes: Any = CODES, *, old: bool = False, table: bool = True) -> bytes:
    """An .annot file; codes of -1 are 0."""
    packed = TABLE[:, :3] @ [1, 256, 65536]
    values = np.where(codes < 0, 0, packed[codes])
    data = integers(len(codes)) + np.stack([np.arange(len(codes)), values], axis=1).astype(">i4").tobytes()
    if not table:
        return data + integers(0)
    data += integers(1, 3) if old else integers(1, -2, 3)
    data += integers(7) + b"NOFILE\0" + (b"" if old else integers(3))
    for k, (name, row) in enumerate(zip(NAMES, TABLE.tolist(), strict=True)):
        data += (b"" if old else integers(k)) + integers(len(name) + 1) + name.encode() + b"\0" + integers(*row)
    return data


@pytest.mark.parametrize("old", [False, True])
def test_annotations_of_both_forms(old: bool, tmp_path: Path) -> None:
    path = tmp_path / "lh.aparc.annot"
    path.write_bytes(annotation(old=old))
    assert faces_of(path) == expected()
    result = curvcli.analyze(tuple(BALL), "topology", regions=str(path))
    assert result.regions is not None
    assert result.regions.colors is not None
    assert result.regions.colors.tolist() == TABLE[:, :3].tolist()
    codes = np.where(CODES == 1, -1, CODES)
    path.write_bytes(annotation(codes, old=old))
    assert faces_of(path) == expected(codes)
    path.write_bytes(annotation(table=False))
    assert faces_of(path) == expected(names=["#190519", "#ffc020", "#dc1464"])


def test_annotations_by_nibabel(tmp_path: Path) -> None:
    nibabel = pytest.importorskip("nibabel", reason="nibabel writes the file")
    path = tmp_path / "rh.aparc.annot"
    nibabel.freesurfer.write_annot(path, CODES, TABLE, NAMES)
    assert faces_of(path) == expected()
    names, codes = names_and_codes(path)
    found, _, known = nibabel.freesurfer.read_annot(path)
    assert [name.decode() for name in known] == names
    np.testing.assert_array_equal(codes, found)


def test_labels_of_one_region(tmp_path: Path) -> None:
    path = tmp_path / "lh.Cortex.label"
    inside = np.flatnonzero(CODES == 2)
    rows = "".join(
        f"{k}  {x:.3f}  {y:.3f}  {z:.3f} 0.0000000\n" for k, (x, y, z) in zip(inside, BALL.points[inside], strict=True)
    )
    path.write_text(f"#!ascii label  , from subject bert vox2ras=TkReg\n{len(inside)}\n{rows}")
    faces = from_vertices(np.where(CODES == 2, 0, -1).astype(np.int32), BALL.faces)[0]
    assert faces_of(path) == {"lh.Cortex": np.count_nonzero(faces == 0)}
    path.write_text(path.read_text().replace(f"\n{len(inside)}\n", f"\n{len(inside) + 1}\n"))
    with pytest.raises(InputError, match="a number of rows not above"):
        read_labels(str(path))


def values_of(values: Any, *, old: bool = False) -> bytes:
    if old:
        return three(len(values)) + three(80) + np.round(np.asarray(values) * 100).astype(">i2").tobytes()
    return b"\xff\xff\xff" + integers(len(values), 80, 1) + np.asarray(values, ">f4").tobytes()


@pytest.mark.parametrize("name", ["lh.parcels", "parcels.curv", "x.new"])
def test_values_of_vertices_that_are_whole(name: str, tmp_path: Path) -> None:
    nibabel = pytest.importorskip("nibabel", reason="nibabel writes the file")
    nibabel.freesurfer.write_morph_data(str(tmp_path / name), CODES)
    assert (tmp_path / name).read_bytes()[15:] == values_of(CODES)[15:]
    assert faces_of(tmp_path / name) == expected(names=["0", "1", "2"])
    if name != "x.new":
        (tmp_path / name).write_bytes(values_of(CODES, old=True))
        assert faces_of(tmp_path / name) == expected(names=["0", "1", "2"])
        (tmp_path / name).write_bytes(values_of(CODES + 0.25))
        with pytest.raises(InputError, match=r"label \d\.25 of vertex 0, expected a whole number"):
            faces_of(tmp_path / name)


# ---------------------------------------------------------------------------- GIFTI

LABEL_TABLE = "".join(
    f'<Label Key="{10 * k}" Red="{r / 255}" Green="{g / 255}" Blue="{b / 255}" Alpha="1"><![CDATA[{name}]]></Label>'
    for k, (name, (r, g, b, _)) in enumerate(zip(NAMES, TABLE.tolist(), strict=True))
)


def test_label_tables_of_gifti(tmp_path: Path) -> None:
    pytest.importorskip("nibabel", reason="nibabel reads GIFTI")
    path = tmp_path / "lh.aparc.label.gii"
    for encoding, big in itertools.product(ENCODINGS, (False, True)):
        path.write_bytes(gifti(data_array(10 * CODES, "LABEL", encoding=encoding, big=big), table=LABEL_TABLE))
        assert faces_of(path) == expected()
    regions = curvcli.analyze(tuple(BALL), "topology", regions=str(path)).regions
    assert regions is not None
    assert regions.colors is not None
    assert regions.colors.tolist() == TABLE[:, :3].tolist()


@pytest.mark.parametrize("suffix", [".shape.gii", ".func.gii", ".gii"])
def test_values_of_gifti_that_are_whole(suffix: str, tmp_path: Path) -> None:
    pytest.importorskip("nibabel", reason="nibabel reads GIFTI")
    path = tmp_path / f"lh.parcels{suffix}"
    path.write_bytes(gifti(data_array(CODES.astype("f4"), "SHAPE")))
    assert faces_of(path) == expected(names=["0", "1", "2"])
    path.write_bytes(gifti(*[data_array(CODES, "SHAPE")] * 2))
    with pytest.raises(InputError, match="2 arrays of labels found, one expected: shape, shape"):
        faces_of(path)


@pytest.mark.parametrize("kind", ["annot", "old annot", "label", "curv", "old curv", "gii"])
def test_every_truncation_is_refused(kind: str, tmp_path: Path) -> None:
    few = CODES[:3]
    whole = {
        "annot": annotation(few),
        "old annot": annotation(few, old=True),
        "label": b"#!ascii label\n2\n0 0.5 0.5 0.5 0.1\n1 0.5 0.5 0.5 0.1\n",
        "curv": values_of(few),
        "old curv": values_of(few, old=True),
        "gii": gifti(data_array(few, "LABEL"), table=LABEL_TABLE),
    }[kind]
    path = tmp_path / f"lh.x.{kind.rpartition(' ')[2]}"
    if kind == "gii":
        pytest.importorskip("nibabel", reason="nibabel reads GIFTI")
    read = []
    for cut in range(len(whole)):
        path.write_bytes(whole[:cut])
        with contextlib.suppress(InputError):
            read_labels(str(path))
            read.append(cut)
    # The colours of an annotation come first, and its table may be missing; the last value of a label is not used.
    allowed = {"label": range(len(whole) - 4, len(whole)), "gii": [len(whole) - 1]}
    assert set(read) <= set(allowed.get(kind, [4 + 8 * len(few)] if "annot" in kind else []))


def test_an_annotation_of_another_surface_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "rh.aparc.annot"
    for codes in (CODES[:-1], np.append(CODES, 0)):
        path.write_bytes(annotation(codes))
        with pytest.raises(InputError, match=rf"{len(codes)} labels, expected 42 \(vertices\)"):
            faces_of(path)
    data = annotation()
    path.write_bytes(data[:4] + integers(7) + data[8:])
    with pytest.raises(InputError, match="no label of vertex 0, or two, found"):
        faces_of(path)


def test_equal_names_of_two_colours_are_two_regions(tmp_path: Path) -> None:
    path = tmp_path / "lh.aparc.annot"
    path.write_bytes(annotation().replace(b"\0\0\0\x07cuneus\0", b"\0\0\0\x07insula\0"))
    assert list(faces_of(path)) == ["unknown", "insula", "insula #2"]
