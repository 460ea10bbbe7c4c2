"""Principal directions from the curvature tensor of the star."""

from __future__ import annotations

import numpy as np

from ..mesh.surface import Surface
from ..mesh.triangles import EPSILON, dot, span
from ..support.arrays import Column, Floats, VectorColumn
from ..support.blocks import for_each, slices
from .kernels.tensor import ENTRIES, line, tangential
from .mean import pointed
from .quantity import Quantity
from .registry import curvature_pass

_SHARED = {
    "kind": "direction",
    "vector": True,
    "line": True,
    "boundary": "null; also where the tangential eigenvalues are equal to rounding or the patch has no orientation",
    "source": "Sullivan, Discrete surfaces; "
    "Cohen-Steiner and Morvan, Restricted Delaunay triangulations and normal cycle",
    "preserves": "dir_1 ⊥ dir_2, both ⊥ **A**_p",
}
# Eigenvalues nearer to each other than this part of Σ|e| differ by the rounding of the dihedral angles only.
_UMBILIC = 512 * EPSILON


@curvature_pass(
    provides=(
        Quantity(
            "dir_1",
            symbol="**e**₁",
            formula="tangential eigenvector of Σ θ_e|e| ê⊗ê to the smaller eigenvalue",
            partner="dir_2",
            description="Direction of κ₁, a line: of unit length, its largest component positive.",
            **_SHARED,  # type: ignore[arg-type]
            after="kappa_max",
        ),
        Quantity(
            "dir_2",
            symbol="**e**₂",
            formula="tangential eigenvector of Σ θ_e|e| ê⊗ê to the larger eigenvalue",
            partner="dir_1",
            description="Direction of κ₂, a line: of unit length, its largest component positive.",
            **_SHARED,  # type: ignore[arg-type]
            after="dir_1",
        ),
    )
)
def principal_directions(
    surface: Surface, theta: Column, A_vec: VectorColumn, star_area: Column
) -> tuple[VectorColumn, ...]:
    """Principal directions: the eigenvectors, in the plane orthogonal to **A**_p, of the curvature tensor of the star.

    An edge bends the surface across itself, so the direction of κ₁ belongs to the smaller eigenvalue: on a cylinder it
    goes round, not along. Lines rather than vectors: the first of their largest components (to rounding) is positive.
    """
    tensor, size = star_tensors(surface, theta)
    frames = np.full((2, 3, surface.n_vertices), np.nan)
    usable = pointed(surface.interior, np.sqrt(dot(A_vec, A_vec)), star_area) & (star_area > 0)

    def turned(block: slice) -> None:
        frames[:, :, block] = _tangential(tensor[:, block], size[block], A_vec[:, block])

    for_each(slices(surface.n_vertices), turned)
    frames[:, :, ~usable] = np.nan
    return frames[0], frames[1]


def star_tensors(surface: Surface, theta: Column) -> tuple[Floats, Floats]:
    """(6, V) Σ θ_e |e| ê⊗ê over the edges at each vertex, and (V,) Σ |e|, to which its rounding is proportional."""
    a, b = surface.edges.a, surface.edges.b
    tensor, size = np.zeros((6, surface.n_vertices)), np.zeros(surface.n_vertices)
    for block in slices(len(surface.edges)):
        ends = a[block].astype(np.intp), b[block].astype(np.intp)
        along = np.array(span(surface.xyz, *ends))
        length = np.sqrt(dot(along, along))
        bend = theta[block] * length
        with np.errstate(divide="ignore", invalid="ignore"):
            along /= length
        for total, part in (
            *((tensor[k], bend * along[i] * along[j]) for k, (i, j) in enumerate(ENTRIES)),
            (size, length),
        ):
            for end in ends:
                np.add.at(total, end, part)
    return tensor, size


def _tangential(tensor: Floats, size: Floats, normal: VectorColumn) -> Floats:
    """(2, 3, n) unit eigenvectors of the tensor's part orthogonal to the normal, the smaller eigenvalue first."""
    with np.errstate(divide="ignore", invalid="ignore"):
        _, half, larger, smaller = tangential(tensor, normal / np.sqrt(dot(normal, normal)))
        umbilic = half <= _UMBILIC * size
    pair = np.array([line(smaller), line(larger)])
    pair[:, :, umbilic] = np.nan
    return pair
