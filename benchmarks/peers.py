"""Reading, computing and writing with other libraries, as their users do; each function imports its library."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Faces = NDArray[np.int64]
Computed = dict[str, Any]  # K: angle defects, H: mean curvature, A: areas, as far as the library gives them


# ---------------------------------------------------------------- compute: points (V, 3), faces (F, 3)


def libigl_angle_defect(points: Floats, faces: Faces) -> Computed:
    """gaussian_curvature alone."""
    import igl

    return {"K": igl.gaussian_curvature(points, faces)}


def libigl(points: Floats, faces: Faces) -> Computed:
    """gaussian_curvature, cotmatrix, massmatrix and H = −L V / (2 M)."""
    import igl

    laplacian = igl.cotmatrix(points, faces)
    area = igl.massmatrix(points, faces, igl.MASSMATRIX_TYPE_VORONOI).diagonal()
    return {
        "K": igl.gaussian_curvature(points, faces),
        "H": -(laplacian @ points) / (2 * area[:, None]),
        "A": area,
    }


def vtk(points: Floats, faces: Faces) -> Computed:
    """vtkCurvatures, Gaussian and mean."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersGeneral import vtkCurvatures

    positions, cells, mesh = vtkPoints(), vtkCellArray(), vtkPolyData()
    positions.SetData(numpy_to_vtk(points))
    cells.SetData(3, numpy_to_vtkIdTypeArray(faces.ravel()))
    mesh.SetPoints(positions)
    mesh.SetPolys(cells)
    found = {}
    for key, kind in (("K", "Gauss"), ("H", "Mean")):
        curvatures = vtkCurvatures()
        curvatures.SetInputData(mesh)
        curvatures.SetCurvatureType(0 if kind == "Gauss" else 1)
        curvatures.Update()
        found[key] = vtk_to_numpy(curvatures.GetOutput().GetPointData().GetArray(f"{kind}_Curvature"))
    return {"pointwise": found["K"], "H": found["H"]}


def trimesh(points: Floats, faces: Faces) -> Computed:
    """Trimesh.vertex_defects alone."""
    import trimesh

    return {"K": trimesh.Trimesh(points, faces, process=False).vertex_defects}


def pymeshlab(points: Floats, faces: Faces) -> Computed:
    """compute_scalar_by_discrete_curvature_per_vertex, Gaussian and mean."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(points, faces))
    return discrete_curvatures(meshes)


def discrete_curvatures(meshes: Any) -> Computed:
    """Gaussian and mean curvature of the current mesh of a pymeshlab.MeshSet."""
    found = {}
    for key, kind in (("pointwise", "Gaussian Curvature"), ("H", "Mean Curvature")):
        meshes.compute_scalar_by_discrete_curvature_per_vertex(curvaturetype=kind)
        found[key] = meshes.current_mesh().vertex_scalar_array()
    return found


def gpytoolbox(points: Floats, faces: Faces) -> Computed:
    """angle_defect, cotangent_laplacian and massmatrix."""
    import gpytoolbox

    area = gpytoolbox.massmatrix(points, faces).diagonal()
    mean = gpytoolbox.cotangent_laplacian(points, faces) @ points / (2 * area[:, None])
    return {"K": gpytoolbox.angle_defect(points, faces), "H": mean, "A": area}


def potpourri3d(points: Floats, faces: Faces) -> Computed:
    """cotan_laplacian and vertex_areas; it has no Gauss curvature."""
    import potpourri3d

    area = potpourri3d.vertex_areas(points, faces)
    return {"H": potpourri3d.cotan_laplacian(points, faces) @ points / (2 * area[:, None]), "A": area}


COMPUTE: dict[str, Callable[[Floats, Faces], Computed]] = {
    "libigl angle defect": libigl_angle_defect,
    "libigl": libigl,
    "VTK": vtk,
    "trimesh angle defect": trimesh,
    "PyMeshLab": pymeshlab,
    "gpytoolbox": gpytoolbox,
    "potpourri3d": potpourri3d,
}


# ---------------------------------------------------------------- reading


def read_file_libigl(path: str) -> tuple[Floats, Faces]:
    """read_triangle_mesh."""
    import igl

    points, faces = igl.read_triangle_mesh(path)
    return points, faces


def read_libigl(path: str) -> tuple[Floats, Faces]:
    """read_triangle_mesh; STL merged exactly."""
    import igl

    points, faces = read_file_libigl(path)
    if path.endswith(".stl"):
        points, _, _, faces = igl.remove_duplicate_vertices(points, faces, 0.0)
    return points, faces


def read_vtk(path: str) -> tuple[Floats, Faces]:
    """VTK's readers; that of STL merges points."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader

    reader = {".obj": vtkOBJReader, ".stl": vtkSTLReader, ".ply": vtkPLYReader}[path[-4:]]()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    return points, vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def read_trimesh(path: str) -> tuple[Floats, Faces]:
    """trimesh.load, merging as it does by default."""
    import trimesh

    mesh = trimesh.load(path, force="mesh")
    return mesh.vertices, mesh.faces


def load_pymeshlab(path: str) -> Any:
    """load_new_mesh, which merges equal positions of STL."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(path)
    return meshes


def read_pymeshlab(path: str) -> tuple[Floats, Faces]:
    """The same, as arrays."""
    meshes = load_pymeshlab(path)  # a mesh does not keep its set alive
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


READ = {"libigl": read_libigl, "VTK": read_vtk, "trimesh": read_trimesh, "PyMeshLab": read_pymeshlab}


# ---------------------------------------------------------------- writing


def write_savetxt(path: str, names: list[str], table: list[NDArray[Any]]) -> None:
    """numpy.savetxt, nine digits."""
    pattern = ["%d", *["%.9g"] * (len(names) - 1)]
    np.savetxt(path, np.column_stack(table), fmt=pattern, delimiter=",", header=",".join(names), comments="")


def write_polars(path: str, names: list[str], table: list[NDArray[Any]]) -> None:
    """polars' CSV writer."""
    import polars

    polars.DataFrame(dict(zip(names, table, strict=True))).write_csv(path)


CSV = {"savetxt": write_savetxt, "polars": write_polars}


def write_coloured_ply(path: str, points: Floats, faces: Faces, values: Floats) -> None:
    """Binary PLY with a colour and a scalar at each vertex, by numpy alone."""
    low, high = np.nanpercentile(values, [2, 98])
    shade = np.clip((values - low) / (high - low or 1.0), 0, 1)
    vertices = np.empty(len(points), [("xyz", "<f4", 3), ("rgb", "u1", 3), ("value", "<f4")])
    vertices["xyz"], vertices["value"] = points, values
    vertices["rgb"] = (255 * np.stack([shade, 0 * shade, 1 - shade], axis=1)).astype(np.uint8)
    rows = np.empty(len(faces), [("size", "u1"), ("corners", "<i4", 3)])
    rows["size"], rows["corners"] = 3, faces
    properties = "".join(f"property float {axis}\n" for axis in "xyz")
    properties += (
        "".join(f"property uchar {colour}\n" for colour in ("red", "green", "blue")) + "property float value\n"
    )
    with open(path, "wb") as stream:
        stream.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{properties}".encode())
        stream.write(f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        vertices.tofile(stream)
        rows.tofile(stream)


def read_and_compute(library: str, path: str) -> tuple[Floats, Faces, Computed]:
    """Positions, triangles and what the library makes of them."""
    if library == "PyMeshLab":  # it computes on the mesh that it has read
        meshes = load_pymeshlab(path)
        found, mesh = discrete_curvatures(meshes), meshes.current_mesh()
        return mesh.vertex_matrix(), mesh.face_matrix(), found
    points, faces = READ[library](path)
    points, faces = np.ascontiguousarray(points, np.float64), np.ascontiguousarray(faces, np.int64)
    return points, faces, {"libigl": libigl, "VTK": vtk, "trimesh": trimesh}[library](points, faces)


def pipeline(library: str, writer: str, mesh: str, csv: str, ply: str) -> None:
    """File → CSV of twelve columns and coloured PLY; what a library does not give is filled up: all write alike."""
    points, faces, found = read_and_compute(library, mesh)
    K: Any = found.get("K", found.get("pointwise"))
    H: Any = found.get("H", K)
    H_vec = H if H.ndim == 2 else np.stack([H, H, H], axis=1)
    h = np.sqrt((H * H).sum(axis=1)) if H.ndim == 2 else H
    A: Any = found.get("A", np.ones(len(points)))
    names = ["vertex", "x", "y", "z", "K", "H_vec_x", "H_vec_y", "H_vec_z", "A", "h", "K_density", "willmore"]
    CSV[writer](csv, names, [np.arange(len(points)), *points.T, K, *H_vec.T, A, h, K / A, h * h * A])
    write_coloured_ply(ply, points, faces, h)


if __name__ == "__main__":
    pipeline(*sys.argv[1:])
