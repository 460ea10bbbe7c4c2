"""3MF: items of the build in order, placed, with unit and materials, and refusals of damaged or hostile packages."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from curvcli import analyze
from curvcli.loading.read import read_mesh_file
from curvcli.mesh.file import MeshFile
from curvcli.mesh.polygons import from_file
from tests.helpers.every_format import SHAPES, Shape, assert_reads, assert_refused, is_refused, read_cuts, sphere

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
MATERIAL = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
BODY = '<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>\n'
BODY += (
    '<vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>'
)
BODY += '<triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/></triangles></mesh>'
POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


def mesh(shape: Shape, vertex: str = '<vertex x="{0!r}" y="{1!r}" z="{2!r}"/>\n', prefix: str = "") -> str:
    rows = "".join(vertex.format(*row) for row in shape.points.tolist())
    faces = "".join(f'<{prefix}triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in shape.halved().polygons)
    tags = [f"<{prefix}mesh>", f"<{prefix}vertices>", rows, f"</{prefix}vertices>", f"<{prefix}triangles>", faces]
    return "".join([*tags, f"</{prefix}triangles>", f"</{prefix}mesh>"])


def model(objects: str, items: str = '<item objectid="1"/>', attributes: str = 'unit="inch"', p: str = "") -> str:
    spaces = f'xmlns{":" + p[:-1] if p else ""}="{CORE}" xmlns:m="{MATERIAL}" xmlns:p="{PRODUCTION}"'
    text = f'<?xml version="1.0" encoding="UTF-8"?>\n<{p}model {attributes} {spaces}>'
    return f"{text}<{p}resources>{objects}</{p}resources><{p}build>{items}</{p}build></{p}model>"


def package(*parts: str | bytes, names: tuple[str, ...] = ("3D/3dmodel.model",), stored: bool = False) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED) as archive:
        for name, part in zip(names, parts, strict=True):
            archive.writestr(name, part)
    return stream.getvalue()


def single(content: str, **options: str) -> bytes:
    return package(model(f'<object id="1" type="model">{content}</object>', **options))


def read(data: bytes, **options: Any) -> MeshFile:
    return read_mesh_file(io.BytesIO(data), **options)


SPELLINGS: dict[str, Callable[[Shape], bytes]] = {
    "plain": lambda shape: single(mesh(shape)),
    "indented": lambda shape: single(mesh(shape, '\n\t<vertex x="{0!r}" y="{1!r}" z="{2!r}" />\n')),
    "other order": lambda shape: single(mesh(shape, '<vertex z="{2!r}" x="{0!r}" y="{1!r}"/>')),
    "apostrophes": lambda shape: single(mesh(shape, "<vertex x='{0!r}' y='{1!r}' z='{2!r}'></vertex>")),
    "further attributes": lambda shape: single(mesh(shape, '<vertex x="{0!r}" y="{1!r}" z="{2!r}" m:u="9"/>')),
    "comments": lambda shape: single(
        "<!-- <vertices> -->" + mesh(shape, '<vertex x="{0!r}" y="{1!r}" z="{2!r}"/><!--/-->')
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_spelling_gives_the_same_table(spelling: str, shape: str) -> None:
    meant = SHAPES[shape]().halved()
    file = assert_reads(SPELLINGS[spelling](meant), meant)
    assert (file.unit, file.weld, file.notices) == ("inch", "none", ())


def test_a_prefix_for_all_elements() -> None:
    shape = sphere()
    vertex = '<c:vertex x="{0!r}" y="{1!r}" z="{2!r}"/>'
    objects = f'<c:object id="1">{mesh(shape, vertex, "c:")}</c:object>'
    assert_reads(package(model(objects, '<c:item objectid="1"/>', p="c:")), shape)


def test_the_fast_reader_reads_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("curvcli.loading.text.SMALL", 0)
    for write in SPELLINGS.values():
        assert_reads(write(sphere()), sphere())


def test_files_of_trimesh(tmp_path: Path) -> None:
    pytest.importorskip("lxml")
    pytest.importorskip("networkx")
    shape = sphere()
    trimesh.Trimesh(shape.points, shape.triangles, process=False).export(tmp_path / "a.3mf")
    assert assert_reads(tmp_path / "a.3mf", shape).unit == "millimeter"


def test_the_unit_is_that_of_the_report() -> None:
    surface = from_file(read(single(BODY)))
    assert analyze(surface).report()["conventions"]["unit"] == "inch"
    assert analyze(surface, unit="cm").report()["conventions"]["unit"] == "cm"
    assert from_file(read(single(BODY, attributes=""))).file.unit == "millimeter"  # type: ignore[union-attr]


def test_items_and_components_are_placed_in_order() -> None:
    objects = f'<object id="7" name="part">{BODY}</object><object id="2" name="pair"><components>'
    objects += '<component objectid="7" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>'
    objects += '<component objectid="7" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/></components></object>'
    items = '<item objectid="2" transform="0 2 0 -2 0 0 0 0 2 0 0 5"/><item objectid="7"/>'
    items += '<item objectid="7" partnumber="P"/>'
    file = read(package(model(objects, items)))

    def outer(p: np.ndarray) -> np.ndarray:
        return np.stack([-2 * p[:, 1], 2 * p[:, 0], 2 * p[:, 2] + 5], axis=1)

    expected = [outer(POINTS + np.array([10, 0, 0])), outer(POINTS * [-1, 1, 1]), POINTS, POINTS]
    np.testing.assert_array_equal(file.xyz.T, np.concatenate(expected))
    faces = file.corners.reshape(-1, 4, 3) % 4
    np.testing.assert_array_equal(faces[1], faces[0][:, [0, 2, 1]])
    assert file.polygon_labels["objects"].names == ("pair", "part", "P")
    assert file.polygon_labels["groups"].codes.tolist() == [0] * 8 + [1] * 4 + [2] * 4


def test_components_of_other_models_stand_once() -> None:
    """Slicers keep several objects in one model beside the root; each component is one of them."""
    other = BODY.replace('x="1"', 'x="3"')
    inner = model(f'<object id="1">{BODY}</object><object id="2">{other}</object>', "")
    component = '<component p:path="/3D/Objects/a.model" objectid="{}"/>'
    objects = f'<object id="9"><components>{component.format(1)}{component.format(2)}</components></object>'
    names = ("3D/3dmodel.model", "3D/Objects/A.model")
    file = read(package(model(objects, '<item objectid="9"/>'), inner, names=names))
    assert file.xyz[0].tolist() == [0, 1, 0, 0, 0, 3, 0, 0]
    assert file.polygons == 8


def test_the_root_is_that_of_the_relationships() -> None:
    relation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    rels = f'<Relationships><Relationship Target="/3D/other.model" Id="r" Type="{relation}"/></Relationships>'
    two = model(f'<object id="1">{BODY}</object>', attributes='unit="foot"')
    names = ("_rels/.rels", "3D/3dmodel.model", "3D/other.model")
    assert read(package(rels, "<wrong/>", two, names=names)).unit == "foot"


def test_materials() -> None:
    objects = '<basematerials id="5"><base name="steel" displaycolor="#112233"/>'
    objects += '<base displaycolor="#445566"/></basematerials>'
    objects += '<m:colorgroup id="6"><m:color color="#FF0000"/></m:colorgroup>'
    body = BODY.replace('v3="3"/>', 'v3="3" pid="6" p1="0"/>', 1).replace(
        'v1="1" v2="2" v3="3"', 'v1="1" v2="2" v3="3" p1="1"'
    )
    file = read(package(model(f'{objects}<object id="1" pid="5" pindex="0">{body}</object>')))
    assert file.polygon_labels["materials"].names == ("steel", "#FF0000", "#445566")
    assert file.polygon_labels["materials"].codes.tolist() == [0, 1, 0, 2]
    assert "materials" not in read(single(BODY)).polygon_labels


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (single(BODY.replace('v3="1"', 'v3="4"', 1)), "triangle 0: vertex index 4 found, 0 to 3 expected"),
        (single(BODY.replace('v3="1"', 'v3="-1"', 1)), "vertex index -1 found"),
        (single(BODY.replace('v3="1"', 'v3="1.5"', 1)), "triangle 0: `v3` is '1.5', a whole number expected"),
        (single(BODY.replace('v3="1"', "", 1)), "triangle 0: `v3` is ''"),
        (single(BODY.replace('x="1"', 'x="1,5"', 1)), "vertex 1: `x` is '1,5', a number expected"),
        (single(BODY.replace('x="1"', 'x="1_5"', 1)), "vertex 1: `x` is '1_5'"),
        (single(BODY.replace('x="1"', 'x="1 5"', 1)), "vertex 1: `x` is '1 5'"),
        (single(BODY.replace('x="1"', 'x="nan"', 1)), "not finite|finite"),
        (single(BODY.replace("</triangles>", "")), "damaged XML"),
        (single(BODY.replace('"/><vertex', '"><vertex', 1)), "damaged XML"),
        (single("", items=""), "no faces"),
        (single(BODY, items=""), "no faces"),
        (single(BODY, items='<item objectid="8"/>'), "object 8 not found"),
        (single(BODY, items="<item/>"), "`item` without `objectid`"),
        (single(BODY, items='<item objectid="1" transform="1 2"/>'), "12 numbers expected"),
        (single('<components><component objectid="1"/></components>'), "contains itself"),
        (single(f'{BODY}<components><component objectid="1" p:path="/3D/x.model"/></components>'), "no part"),
        (package("<html/>"), "XML of `html` found, `model` expected"),
        (package("<model"), "damaged XML"),
        (package(model("").encode("utf-16")), "UTF-8 expected"),
        (package(model("").replace("UTF-8", "UTF-7")), "UTF-8 expected"),
        (package("anything", names=("a.txt",)), "a ZIP archive without a model"),
        (b"PK\3\4" + b"\0" * 100, "damaged ZIP archive"),
    ],
)
def test_refusals(data: bytes, message: str) -> None:
    assert_refused(data, message, input_format="3mf")


def test_no_entity_is_expanded_and_no_file_read(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("1")
    text = model(f'<object id="1">{BODY}</object>').partition("\n")[2]
    bomb = "".join(f'<!ENTITY e{k + 1} "{f"&e{k};" * 50}">' for k in range(9))
    for inside in (f'<!ENTITY e SYSTEM "file://{secret}">', f'<!ENTITY e0 "a">{bomb}', ""):
        for reference in ("&e;", "&e9;", "1"):
            assert_refused(
                package(f"<!DOCTYPE model [{inside}]>{text.replace('x=' + chr(34) + '1', 'x=' + chr(34) + reference)}"),
                "a document type found",
            )
    assert_refused(package(text.replace('x="1"', 'x="&e;"')), "undefined entity|damaged XML|a number expected")


def test_bombs_are_refused() -> None:
    zeros = package(b" " * (80 << 20) + model(f'<object id="1">{BODY}</object>').encode())
    assert len(zeros) < 1 << 20
    assert_refused(zeros, "inflates to more than")
    ten = '<component objectid="{}"/>' * 10
    levels = "".join(
        f'<object id="{k}"><components>{ten.replace("{}", str(k + 1))}</components></object>' for k in range(1, 30)
    )
    assert_refused(package(model(f'{levels}<object id="30">{BODY}</object>')), "copies of meshes")
    chain = "".join(
        f'<object id="{k}"><components><component objectid="{k + 1}"/></components></object>' for k in range(1, 300)
    )
    assert_refused(package(model(f'{chain}<object id="300">{BODY}</object>')), "100 deep")


def test_truncated_and_damaged_packages() -> None:
    for stored in (False, True):
        data = package(model(f'<object id="1">{BODY}</object>'), stored=stored)
        assert read_cuts(data, input_format="3mf") == []
        for at in range(stored, len(data), 5):
            for byte in b"\0\xff9":
                is_refused(data[:at] + bytes([byte]) + data[at + 1 :], input_format="3mf")


def test_content_decides(tmp_path: Path) -> None:
    (tmp_path / "a.stl").write_bytes(single(BODY))
    file = read_mesh_file(tmp_path / "a.stl")
    assert file.format == "3mf"
    assert [notice.code for notice in file.notices] == ["wrong_suffix"]
    (tmp_path / "b.ply").write_bytes(package("anything", names=("a.txt",)))
    with pytest.raises(Exception, match="a ZIP archive found, a mesh expected"):
        read_mesh_file(tmp_path / "b.ply")


def test_nested_objects_and_open_tags_take_linear_time() -> None:
    nested = "<object id='1'>" * 20_000 + "</object>" * 20_000
    assert_refused(package(model(nested)), "no faces|object 1")
    rels = "<Relationship " * 200_000
    assert_refused(package(rels, "<x/>", names=("_rels/.rels", "3D/3dmodel.model")), "`model` expected")
