"""Meshes of other libraries: the table of their points and polygons, their data as properties and labels, and back."""

from __future__ import annotations

from typing import Any

import meshio
import numpy as np
import pytest
import trimesh

import curvcli
from curvcli.errors import InputError, UsageError
from curvcli.mesh.surface import Surface
from tests.helpers.every_format import SHAPES, Shape, assert_same, moebius, sphere
from tests.helpers.vtk_files import WORDS, data_set
from tests.loading.vtk_arrays import of_meshio


class Triangles:
    """A mesh with the names of open3d."""

    def __init__(self, shape: Shape) -> None:
        self.vertices, self.triangles = shape.points, shape.triangles


class Matrices:
    """A mesh with the names of pymeshlab."""

    def __init__(self, shape: Shape) -> None:
        self.shape = shape

    def vertex_matrix(self) -> Any:
        return self.shape.points

    def face_matrix(self) -> Any:
        return self.shape.triangles


@pytest.mark.parametrize("name", SHAPES)
def test_points_and_polygons_are_taken_as_they_are(name: str) -> None:
    shape = SHAPES[name]()
    mesh = of_meshio(shape)
    assert_same(curvcli.load(mesh), shape.surface())
    file = curvcli.load(mesh).file
    assert file is not None
    np.testing.assert_array_equal(file.polygon_properties["part"], shape.part)
    for given in (
        Triangles(shape),
        Matrices(shape),
        trimesh.Trimesh(shape.points, shape.triangles, process=False),
        trimesh.Trimesh(
            shape.points, shape.triangles, process=False, vertex_attributes={"value": shape.value}, metadata={"a": 1}
        ),
    ):
        assert_same(curvcli.load(given), shape.halved().surface())


@pytest.mark.parametrize("kind", ["polydata", "grid"])
@pytest.mark.parametrize("name", SHAPES)
def test_pyvista(name: str, kind: str) -> None:
    pyvista = pytest.importorskip("pyvista")
    shape = SHAPES[name]()
    mesh = pyvista.wrap(data_set(shape, kind))
    analysis = curvcli.analyze(mesh, "topology", regions="word")
    assert_same(analysis.surface, shape.surface())
    assert [region["name"] for region in analysis.report()["regions"]] == [
        word for k, word in enumerate(WORDS) if k in shape.part
    ]
    file = analysis.surface.file
    assert file is not None
    np.testing.assert_array_equal(file.vertex_properties["value"], shape.value)


def test_nibabel() -> None:
    gifti = pytest.importorskip("nibabel").gifti
    shape = sphere().single()
    arrays = [
        gifti.GiftiDataArray(shape.points.astype(np.float32), intent="NIFTI_INTENT_POINTSET"),
        gifti.GiftiDataArray(shape.triangles.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE"),
    ]
    assert_same(curvcli.load(gifti.GiftiImage(darrays=arrays)), shape.surface())


def surfaces() -> dict[str, Surface]:
    pyvista = pytest.importorskip("pyvista")
    return {"arrays": sphere().surface(), "data": curvcli.load(pyvista.wrap(data_set(moebius(), "polydata")))}


@pytest.mark.parametrize("library", ["trimesh", "pyvista", "meshio"])
def test_surfaces_lead_out_and_back(library: str) -> None:
    for name, surface in surfaces().items():
        mesh = getattr(surface, f"to_{library}")()
        assert type(mesh).__module__.partition(".")[0] == library
        back = curvcli.load(mesh)
        assert np.array_equal(back.points, surface.points)
        assert np.array_equal(back.faces, surface.faces)
        if name == "data":
            assert back.file is not None
            assert surface.file is not None
            assert list(back.file.vertex_properties) == list(surface.file.vertex_properties)
            np.testing.assert_array_equal(
                back.file.polygon_properties["part"], surface.file.polygon_properties["part"][surface.polygon]
            )
            words = surface.file.polygon_labels["word"]
            if library == "meshio":
                assert np.array_equal(back.file.polygon_properties["word"], words.codes[surface.polygon])
            else:
                again = back.file.polygon_labels["word"]
                assert [again.names[k] for k in again.codes] == [words.names[k] for k in words.codes[surface.polygon]]
        mesh.points if library != "trimesh" else mesh.vertices  # noqa: B018 - a mesh of its own
        assert not surface.points.flags.writeable


def test_tables_lead_out() -> None:
    analysis = curvcli.analyze(moebius().surface())
    frame = analysis.vertices.to_polars()
    assert frame.columns[:3] == ["status", "degree", "K"]
    assert "H_vec" not in frame.columns
    assert frame["K"].null_count() == len(frame)
    np.testing.assert_array_equal(frame["kappa_g"].to_numpy(), analysis.vertices["kappa_g"])
    pandas = pytest.importorskip("pandas")
    table = analysis.vertices.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    np.testing.assert_array_equal(table["A_vec_x"], analysis.vertices["A_vec"][:, 0])
    assert analysis.faces.to_polars().height == analysis.surface.n_faces


def test_what_is_no_surface_is_refused() -> None:
    shape = moebius()
    lines = meshio.Mesh(shape.points, [("tetra", np.array([[0, 1, 2, 3]]))])
    with pytest.raises(InputError, match="no faces, but 1 tetrahedron"):
        curvcli.load(lines)
    curved = meshio.Mesh(shape.points, [("triangle6", np.array([[0, 1, 2, 3, 4, 5]]))])
    with pytest.raises(InputError, match="curved"):
        curvcli.load(curved)
    beyond = Triangles(Shape(shape.points[:5], shape.polygons))
    with pytest.raises(InputError, match="vertex index"):
        curvcli.load(beyond)
    with pytest.raises(UsageError, match="weld"):
        curvcli.load(of_meshio(shape), weld="exact")
