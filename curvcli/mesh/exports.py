"""Surfaces as meshes of other libraries."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import MissingExtraError

if TYPE_CHECKING:
    from .file import Labels, MeshFile


class Exports:
    """Methods of a surface that give it as a mesh of another library, with the properties and labels of its file."""

    @property
    def points(self) -> NDArray[np.float64]:
        """(V, 3) positions."""
        raise NotImplementedError

    faces: NDArray[np.int32]
    polygon: NDArray[np.int32] | None
    file: MeshFile | None

    def to_trimesh(self) -> Any:
        """The surface as a `trimesh.Trimesh`: its rows and triangles, nothing merged; properties as attributes.

        Words of labels are arrays of text.
        """
        import trimesh

        return trimesh.Trimesh(
            self.points.copy(),
            self.faces.astype(np.int64),
            process=False,
            vertex_attributes=self._data("vertex", names=True),
            face_attributes=self._data("polygon", names=True),
        )

    def to_pyvista(self) -> Any:
        """The surface as a `pyvista.PolyData`: its rows and triangles, properties and labels as data.

        Errors: MissingExtraError without pyvista.
        """
        try:
            import pyvista
        except ImportError:
            raise MissingExtraError("to_pyvista needs pyvista: `pip install 'curvcli[pictures]'`") from None
        mesh = pyvista.PolyData.from_regular_faces(self.points.copy(), self.faces.astype(np.int64))
        for element, data in (("vertex", mesh.GetPointData()), ("polygon", mesh.GetCellData())):
            for name, values in self._data(element, names=True).items():
                data.AddArray(_vtk_array(name, values))
        return mesh

    def to_meshio(self) -> Any:
        """The surface as a `meshio.Mesh`: its rows and triangles, properties as data, labels as their codes.

        Errors: MissingExtraError without meshio.
        """
        try:
            import meshio
        except ImportError:
            raise MissingExtraError("to_meshio needs meshio: `pip install 'curvcli[formats]'`") from None
        return meshio.Mesh(
            self.points.copy(),
            [("triangle", self.faces.astype(np.int64))],
            point_data=self._data("vertex", names=False),
            cell_data={name: [values] for name, values in self._data("polygon", names=False).items()},
        )

    def _data(self, element: str, *, names: bool) -> dict[str, NDArray[Any]]:
        """Properties and labels of vertices, or of the polygon of each face. names: names of labels, not codes."""
        if self.file is None:
            return {}
        given: dict[str, NDArray[Any]] = getattr(self.file, f"{element}_properties")
        labels: dict[str, Labels] = getattr(self.file, f"{element}_labels")
        data = {name: np.array(values) for name, values in given.items()}
        data |= {name: _label_names(label) if names else label.codes.copy() for name, label in labels.items()}
        if element == "vertex" or self.polygon is None:
            return data
        return {name: values[self.polygon] for name, values in data.items()}


def _label_names(labels: Labels) -> NDArray[np.str_]:
    """Name of the label of each element, empty for none."""
    return np.array([*labels.names, ""])[labels.codes]


def _vtk_array(name: str, values: NDArray[Any]) -> Any:
    """An array of VTK; pyvista's own conversion refuses words beyond ASCII."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkStringArray

    if values.dtype.kind == "U":
        array = vtkStringArray()
        array.SetNumberOfValues(len(values))
        for row, word in enumerate(values.tolist()):
            array.SetValue(row, word)
    else:
        array = numpy_to_vtk(values.view(np.uint8) if values.dtype == np.bool_ else values, deep=True)
    array.SetName(name)
    return array
