"""glTF, binary and text: nodes in order with their transforms, labels, properties, and refusals of other files."""

from __future__ import annotations

import base64
import copy
import io
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from curvcli.loading.read import read_mesh_file
from curvcli.mesh.file import MeshFile
from tests.helpers.every_format import Shape, assert_reads, assert_refused, is_refused, moebius, read_cuts, sphere

TYPES = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
Json = dict[str, Any]
BODY = (
    np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


class Scene:
    """A file of glTF: arrays are appended to its only buffer."""

    def __init__(self) -> None:
        self.data = b""
        self.tree: Json = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "meshes": [], "nodes": []}

    def array(self, values: NDArray[Any], **more: Any) -> int:
        """Append an array; returns its accessor."""
        self.data += b"\0" * (-len(self.data) % 4)
        self.tree["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes})
        kind = KINDS[values.shape[1] if values.ndim > 1 else 1]
        component = TYPES[values.dtype.str[1:]]
        accessor = {"bufferView": len(self.tree["bufferViews"]) - 1, "componentType": component, "type": kind}
        self.tree["accessors"].append(accessor | {"count": len(values)} | more)
        self.data += values.tobytes()
        return len(self.tree["accessors"]) - 1

    def mesh(self, points: NDArray[Any], faces: NDArray[Any] | None, **more: Any) -> int:
        """Append a mesh of one primitive."""
        primitive: Json = {"attributes": {"POSITION": self.array(points.astype("<f4"))}} | more
        if faces is not None:
            primitive["indices"] = self.array(faces.reshape(-1).astype("<u4"))
        self.tree["meshes"].append({"primitives": [primitive]})
        return len(self.tree["meshes"]) - 1

    def node(self, mesh: int | None = None, **more: Any) -> int:
        self.tree["nodes"].append(({} if mesh is None else {"mesh": mesh}) | more)
        return len(self.tree["nodes"]) - 1

    def gltf(self) -> bytes:
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        return json.dumps(self.tree | {"buffers": [{"byteLength": len(self.data), "uri": uri}]}).encode()

    def glb(self) -> bytes:
        text = json.dumps(self.tree | {"buffers": [{"byteLength": len(self.data)}]}).encode()
        return as_glb(text + b" " * (-len(text) % 4), self.data + b"\0" * (-len(self.data) % 4))


def as_glb(text: bytes, data: bytes) -> bytes:
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data))
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return head + chunks


def one(shape: Shape) -> Scene:
    scene = Scene()
    scene.node(scene.mesh(shape.points, shape.triangles))
    return scene


def body() -> Scene:
    scene = Scene()
    scene.node(scene.mesh(*BODY))
    return scene


def read(data: bytes, **options: Any) -> MeshFile:
    return read_mesh_file(io.BytesIO(data), **options)


@pytest.mark.parametrize("write", [Scene.glb, Scene.gltf])
@pytest.mark.parametrize("shape", [sphere, moebius])
def test_both_encodings_give_the_same_table(shape: Callable[[], Shape], write: Callable[[Scene], bytes]) -> None:
    meant = shape().single().halved()
    file = assert_reads(write(one(meant)), meant, weld="none")
    assert file.weld == "none"
    file = assert_reads(write(one(meant)), meant, merged="exact")
    assert file.weld == "exact"
    assert [notice.code for notice in file.notices] == (["welded_vertices"] if shape is sphere else [])


@pytest.mark.parametrize("kind", ["glb", "gltf"])
def test_files_of_trimesh(kind: str, tmp_path: Path) -> None:
    shape = sphere().single()
    scene = trimesh.Scene()
    mesh = trimesh.Trimesh(shape.points, shape.triangles, process=False)
    mesh.visual.vertex_colors = colours = np.arange(4 * len(shape.points)).reshape(-1, 4).astype(np.uint8)
    scene.add_geometry(mesh, node_name="one")
    path = tmp_path / f"a.{kind}"
    if kind == "glb":
        path.write_bytes(scene.export(file_type="glb"))
    else:
        files = scene.export(file_type="gltf", merge_buffers=True, embed_buffers=True)
        path.write_bytes(files["model.gltf"])
    file = assert_reads(path, shape, weld="none")
    kept = [file.vertex_properties[name] for name in ("red", "green", "blue", "alpha")]
    np.testing.assert_array_equal(np.array(kept).T, colours)
    assert file.polygon_labels["objects"].names == ("one",)


def test_nodes_keep_their_order_and_their_transforms() -> None:
    scene = Scene()
    mesh = scene.mesh(*BODY, material=1)
    other = scene.mesh(2 * BODY[0], BODY[1], material=0)
    scene.tree["materials"] = [{"name": "steel"}, {}]
    turned = scene.node(
        mesh, name="turned", rotation=[0, 0, 0.5**0.5, 0.5**0.5], scale=[2, 3, 4], translation=[1, 2, 3]
    )
    outer = scene.node(other, name="outer", translation=[10, 0, 0], children=[turned])
    matrix = [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]
    mirrored = scene.node(mesh, name="turned", matrix=matrix)
    scene.node(mesh, name="in no scene")
    scene.tree["scenes"] = [{"nodes": []}, {"nodes": [mirrored, outer]}]
    scene.tree["scene"] = 1
    file = read(scene.glb(), weld="none")
    points, faces = BODY[0].astype(float), BODY[1]
    expected = [points * [-1, 1, 1] + [0, 0, 5], 2 * points + [10, 0, 0]]
    expected.append(np.stack([11 - 3 * points[:, 1], 2 + 2 * points[:, 0], 3 + 4 * points[:, 2]], axis=1))
    np.testing.assert_allclose(file.xyz.T, np.concatenate(expected), atol=1e-14)
    np.testing.assert_array_equal(file.xyz.T[:8], np.concatenate(expected)[:8])
    np.testing.assert_array_equal(file.corners.reshape(-1, 3)[:4], faces[:, [0, 2, 1]])
    np.testing.assert_array_equal(file.corners.reshape(-1, 3)[4:], np.concatenate([faces + 4, faces + 8]))
    assert file.polygon_labels["objects"].names == ("turned", "outer", "turned #2")
    assert file.polygon_labels["groups"].codes.tolist() == [0] * 4 + [1] * 4 + [2] * 4
    assert file.polygon_labels["materials"].names == ("steel", "material 1")
    assert file.polygon_labels["materials"].codes.tolist() == [1] * 4 + [0] * 4 + [1] * 4
    assert scene.tree["nodes"]


def test_primitives_share_their_positions() -> None:
    scene = body()
    (primitive,) = scene.tree["meshes"][0]["primitives"]
    two = primitive | {"indices": scene.array(np.array([0, 3, 2, 1, 2, 3], "<u2")), "material": 0}
    primitive["indices"] = scene.array(np.array([0, 2, 1, 0, 1, 3], "<u1"))
    scene.tree["meshes"][0]["primitives"].append(two)
    scene.tree["materials"] = [{"name": "a"}]
    file = read(scene.glb(), weld="none")
    assert file.xyz.shape == (3, 4)
    assert file.corners.reshape(-1, 3).tolist() == BODY[1].tolist()
    assert file.polygon_labels["materials"].codes.tolist() == [-1, -1, 0, 0]


def test_strips_and_bare_corners() -> None:
    scene = Scene()
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0]], np.float32)
    scene.node(scene.mesh(points, np.arange(5), mode=5))
    assert read(scene.glb()).corners.tolist() == [0, 1, 2, 3, 2, 1, 2, 3, 4]
    scene = Scene()
    scene.node(scene.mesh(BODY[0][BODY[1].reshape(-1)], None))
    file = read(scene.glb())
    assert file.xyz.shape == (3, 12)
    assert len(set(file.corners.tolist())) == 4


def test_interleaved_and_normalised_arrays() -> None:
    scene = body()
    rows = np.zeros((4, 5), "<f4")
    rows[:, 1:4] = BODY[0]
    at = scene.array(rows[:, :1].reshape(-1).copy())
    view = scene.tree["bufferViews"][-1]
    scene.data = scene.data[: view["byteOffset"]] + rows.tobytes()
    view |= {"byteLength": rows.nbytes, "byteStride": 20}
    scene.tree["accessors"][at] |= {"type": "VEC3", "byteOffset": 4}
    scene.tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = at
    np.testing.assert_array_equal(read(scene.glb()).xyz.T, BODY[0])
    scene.tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = scene.array(
        np.concatenate([BODY[0] * 32767, [[-32768, 0, 0]]]).astype("<i2"), normalized=True
    )
    np.testing.assert_array_equal(read(scene.glb()).xyz.T, [*BODY[0].tolist(), [-1, 0, 0]])


def test_attributes_are_properties() -> None:
    scene = Scene()
    first, second = scene.mesh(*BODY), scene.mesh(*BODY)
    for mesh in (first, second):
        scene.node(mesh)
    attributes = scene.tree["meshes"][first]["primitives"][0]["attributes"]
    attributes["_HEAT"] = scene.array(np.arange(4, dtype="<f4"))
    attributes["COLOR_0"] = scene.array(np.arange(12, dtype="<f4").reshape(4, 3) / 16)
    properties = read(scene.glb()).vertex_properties
    np.testing.assert_array_equal(properties["_HEAT"], [0, 1, 2, 3] + [np.nan] * 4)
    np.testing.assert_array_equal(properties["green"][:4], [1 / 16, 4 / 16, 7 / 16, 10 / 16])


def test_what_is_no_triangle_is_counted() -> None:
    scene = body()
    (primitive,) = scene.tree["meshes"][0]["primitives"]
    scene.tree["meshes"][0]["primitives"].append(primitive | {"mode": 1})
    primitive["targets"] = [{"POSITION": 0}]
    scene.tree["nodes"][0]["skin"] = 0
    (notice,) = read(scene.glb()).notices
    assert (notice.code, notice.count) == ("ignored_parts", 3)


def changed(change: Callable[[Json], Any]) -> bytes:
    scene = body()
    scene.tree = copy.deepcopy(scene.tree)
    change(scene.tree)
    return scene.glb()


def primitive(tree: Json) -> Json:
    first: Json = tree["meshes"][0]["primitives"][0]
    return first


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t["asset"].update(version="1.0"), "glTF 1.0 found"),
        (lambda t: t.update(extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression found"),
        (lambda t: t.update(extensionsRequired=["EXT_meshopt_compression"]), "without compression"),
        (lambda t: t["accessors"][0].update(sparse={"count": 1}), "sparse data found"),
        (lambda t: t["accessors"][0].pop("bufferView"), "no data found"),
        (lambda t: t["accessors"][0].update(count=5), "5 elements announced"),
        (lambda t: t["accessors"][0].update(count=10**15), "elements announced"),
        (lambda t: t["accessors"][0].update(count=-1), "no glTF 2"),
        (lambda t: t["accessors"][0].update(byteOffset=4), "more than the 48 bytes"),
        (lambda t: t["accessors"][0].update(componentType=5130), "unknown to glTF"),
        (lambda t: t["accessors"][0].update(type="VEC2"), "positions of type VEC2"),
        (lambda t: t["accessors"][1].update(type="VEC3", count=4), "no whole numbers"),
        (lambda t: t["accessors"][1].update(count=11), "a multiple of 3"),
        (lambda t: t["bufferViews"][0].update(byteLength=10**9), "beyond the end of the buffer"),
        (lambda t: t["bufferViews"][0].update(buffer=1), "buffer 1 found"),
        (lambda t: primitive(t).update(indices=7), "accessor 7 found"),
        (lambda t: primitive(t).update(material=10**18), "material 10"),
        (lambda t: primitive(t).update(mode=6), "a triangle fan found"),
        (lambda t: primitive(t)["attributes"].clear(), "no attribute `POSITION`"),
        (lambda t: (t["nodes"][0].update(children=[0]), t.update(scenes=[{"nodes": [0]}])), "two parents"),
        (lambda t: t["nodes"][0].update(children=[3]), "node 3 found"),
        (lambda t: t["nodes"][0].update(mesh=3), "mesh 3 found"),
        (lambda t: t["nodes"][0].update(matrix=[1, 2]), "no glTF 2"),
        (lambda t: t["nodes"][0].pop("mesh"), "no faces"),
        (lambda t: t["meshes"][0]["primitives"].clear(), "no faces"),
        (lambda t: t["meshes"].clear(), "mesh 0 found"),
        (lambda t: t.update(scene=4), "scene 4 found"),
        (lambda t: t.update(scenes=[{"nodes": [0, 0]}]), "two parents"),
    ],
)
def test_wrong_references_are_refused(change: Callable[[Json], Any], message: str) -> None:
    assert_refused(changed(change), message)


def test_a_corner_out_of_range_is_refused() -> None:
    scene = Scene()
    scene.node(scene.mesh(BODY[0], BODY[1] + 1))
    assert_refused(scene.glb(), "vertex index 4 found, 0 to 3 expected")


def test_no_other_file_is_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = body()
    (tmp_path / "secret.bin").write_bytes(scene.data)
    for uri in ("secret.bin", f"file://{tmp_path}/secret.bin", str(tmp_path / "secret.bin"), "http://localhost:1/x"):
        tree = scene.tree | {"buffers": [{"byteLength": len(scene.data), "uri": uri}]}
        text = json.dumps(tree).encode()
        for data, name in ((text, "a.gltf"), (as_glb(text, b""), "a.glb")):
            (tmp_path / name).write_bytes(data)
            assert_refused(data, "data inside the file expected")
    for rubbish in ("data:;base64,!!!!", "data:;base64,AAA", "data:,AAAA", "data:;base64,"):
        tree = scene.tree | {"buffers": [{"byteLength": len(scene.data), "uri": rubbish}]}
        assert_refused(json.dumps(tree).encode(), "buffer 0")


def test_images_are_not_read() -> None:
    scene = body()
    scene.tree |= {"images": [{"uri": "missing.png"}], "textures": [{"source": 0}]}
    scene.tree["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    primitive(scene.tree)["material"] = 0
    assert read(scene.glb()).polygons == 4


def test_copies_out_of_proportion_are_refused() -> None:
    scene = Scene()
    shape = sphere()
    mesh = scene.mesh(shape.points, shape.triangles)
    for _ in range(20_000):
        scene.node(mesh)
    assert_refused(scene.glb(), "copies of meshes")


def test_truncated_and_damaged_files() -> None:
    data = body().glb()
    assert read_cuts(data) == []
    text = body().gltf()
    assert read_cuts(text) == []
    for at in range(len(data)):
        for byte in b'\0\xff9"}':
            is_refused(data[:at] + bytes([byte]) + data[at + 1 :], input_format="glb")
    assert_refused(b"glTF" + b"\0" * 8, "the header of glTF has 20")
    assert_refused(b'{"asset":' + b"[" * 100_000, "no glTF 2")
    deep = body()
    for k in range(3000):
        deep.node(children=[k + 2])
    deep.node(0)
    assert read(deep.glb(), weld="none").polygons == 8


def test_a_scene_without_any_data_has_no_faces() -> None:
    text = json.dumps({"asset": {"version": "2.0"}, "nodes": [{"name": "a"}], "scenes": [{"nodes": [0]}]}).encode()
    assert_refused(text, "no faces")
    assert_refused(as_glb(text + b" " * (-len(text) % 4), b""), "no faces")


def test_copies_of_empty_parts_are_bounded() -> None:
    scene = Scene()
    mesh = scene.mesh(BODY[0], np.empty((0, 3), int))
    scene.tree["meshes"][mesh]["primitives"] *= 3000
    for _ in range(3000):
        scene.node(mesh)
    assert_refused(scene.glb(), "9000000 copies of meshes")
