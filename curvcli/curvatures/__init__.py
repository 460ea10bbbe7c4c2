"""The built-in passes, one idea a file; the order of import is the order of the columns."""

from . import (  # noqa: F401, I001  (a pass may only need what stands above it)
    star,
    status,
    angle_defect,
    mean,
    faces,
    edges,
    absolute,
    directions,
    areas,
    delaunay,
    densities,
    principal,
    willmore,
    conformal,
    dirichlet,
    averaged,
    vertex_normals,
    corrected,
    fits,
    uncertainty,
)
