"""Mean curvature on edges: dihedral angles, and their sine, angle and tangent times the length."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.conormals import conormals
from ..mesh.surface import Surface
from ..mesh.topology import InnerEdges
from ..mesh.triangles import EPSILON, cross, dot, span
from ..support.arrays import Column, Flags, Mask, VectorColumn
from ..support.blocks import for_each, slices
from .quantity import FlagNotice
from .registry import curvature_pass
from .star import null_where

# Enough that two threads rarely wait for the interpreter lock.
EDGES_PER_BLOCK = 32768

# Rounding of the sine between two unit normals.
FOLD = 8 * EPSILON


@curvature_pass(
    symbol="|e|",
    formula="|b − a|",
    on="edge",
    kind="length",
    length_exponent=1,
    boundary="same",
    source="curvcli conventions",
    column="length",
    after="",
)
def edge_length(surface: Surface) -> Column:
    """Length of the edge."""
    length = np.empty(len(surface.edges))

    def measure(block: slice) -> None:
        a, b = (end[block].astype(np.intp) for end in (surface.edges.a, surface.edges.b))
        along = span(surface.xyz, a, b)
        np.sqrt(dot(along, along), out=length[block])

    for_each(slices(len(length), EDGES_PER_BLOCK), measure)
    return length


@curvature_pass(
    symbol="θ_e",
    formula="atan2((n_L × n_R)·e/|e|, n_L·n_R), e = a → b, L the face that contains it",
    on="edge",
    kind="angle",
    parity="odd",
    signed=True,
    preserves="Steiner: the area at distance t grows by t Σ θ_e|e|",
    boundary="null; also where n_e ≠ 2; its size where the surface has no orientation; +π where it folds onto itself",
    source="Sullivan, Discrete surfaces",
    after="edge_length",
)
def theta(surface: Surface, unit_normal: VectorColumn) -> Column:
    """Exterior dihedral angle of the edge, positive where convex."""
    angle = np.full(len(surface.edges), np.nan)
    face_sign = surface.orientation.face_sign
    without = None if surface.orientable else ~surface.orientation.orientable[surface.orientation.patch]

    def turn_of(block: slice) -> None:
        edges = surface.edges.inner_edges(block)
        face, neighbour, forward, against = _sides(surface, edges)
        nu, mu = ([x.take(side) for x in unit_normal] for side in (face, neighbour))
        along = span(surface.xyz, edges.a, edges.b)
        # agree: −1 where the file winds the two faces against each other, so that mu has the opposite sign. A face is
        # on the left of the edge ab if its half-edge runs from a to b.
        agree = np.where(forward != against, 1.0, -1.0)
        side = np.where(forward, agree, -agree)
        if face_sign is not None:
            side *= face_sign[face]
        turn = side * dot(cross(nu, mu), along) / np.sqrt(dot(along, along))
        together = agree * dot(nu, mu)
        # Two faces folded onto each other turn by π; the sign of a sine within rounding is meaningless.
        turned = np.arctan2(np.where((together < 0) & (np.abs(turn) <= FOLD), np.abs(turn), turn), together)
        angle[edges.where] = turned if without is None else np.where(without[face], np.abs(turned), turned)

    for_each(slices(len(surface.edges.pairs[0]), EDGES_PER_BLOCK), turn_of)
    return angle


@curvature_pass(
    on="edge",
    kind="flag",
    public=False,
    notice=FlagNotice(
        "folded_edges",
        "[edge|edges] where the surface folds onto itself; H_tan has no value there",
        "H_theta and H_sin have one; sums of H_tan leave such edges out",
        after="clamped_radicand",
    ),
)
def folded(theta: Column) -> Flags:
    """Mask of the edges folded by π, to rounding."""
    mask: Flags = np.pi - np.abs(theta) <= FOLD
    return mask


def _sides(surface: Surface, edges: InnerEdges) -> tuple[NDArray[np.intp], NDArray[np.intp], Mask, Mask]:
    """The two faces at each edge, and flags of half-edges from a to b in the file."""
    tail = surface.faces.reshape(-1)
    forward, against = (tail.take(half_edges) == edges.a for half_edges in (edges.half_edge, edges.twin))
    return edges.half_edge // 3, edges.twin // 3, forward, against


@curvature_pass(
    symbol="**H**_e",
    formula="−Σ η_i|e| over the faces at e",
    on="edge",
    length_exponent=1,
    mean_degree=1,
    vector=True,
    preserves="force_balance on any set of faces",
    boundary="null; defined for any n_e ≥ 2, needs no orientation",
    source="Sullivan, Discrete surfaces",
    column="H_vec",
    after="theta",
)
def edge_H_vec(surface: Surface, unit_normal: VectorColumn) -> VectorColumn:
    """Mean curvature vector of the edge: minus the sum of its outward conormals, |e| long each."""
    vector = np.full((3, len(surface.edges)), np.nan)

    def bend(block: slice) -> None:
        edges = surface.edges.inner_edges(block)
        face, neighbour, forward, against = _sides(surface, edges)
        way, back = np.where(forward, 1.0, -1.0), np.where(against, 1.0, -1.0)
        between = [way * nu.take(face) + back * nu.take(neighbour) for nu in unit_normal]
        vector[:, edges.where] = cross(between, span(surface.xyz, edges.a, edges.b))

    for_each(slices(len(surface.edges.pairs[0]), EDGES_PER_BLOCK), bend)
    many = surface.nonmanifold_edges
    if many.any():
        half_edges = surface.edges.half_edges(np.flatnonzero(many))
        each = np.where(np.isnan(unit_normal[0, half_edges // 3]), np.nan, conormals(surface, half_edges))
        starts = np.cumsum(surface.edges.valence[many]) - surface.edges.valence[many]
        vector[:, many] = -np.add.reduceat(each, starts, axis=1)
    return vector


@curvature_pass(
    symbol="2 sin(θ/2)|e|",
    formula="2 sin(θ_e/2)|e|, its size is |**H**_e|",
    on="edge",
    length_exponent=1,
    mean_degree=1,
    parity="odd",
    signed=True,
    total="H_sin",
    preserves="force_balance: the size of H_e",
    boundary="null",
    source="Sullivan, Discrete surfaces",
    after="edge_H_vec",
    total_after="H_vec",
)
def H_sin(theta: Column, edge_length: Column) -> Column:
    """Mean curvature of the edge by the sine, as force balance has it."""
    return 2 * np.sin(theta / 2) * edge_length


@curvature_pass(
    symbol="θ|e|",
    formula="θ_e|e|",
    on="edge",
    length_exponent=1,
    mean_degree=1,
    parity="odd",
    signed=True,
    total="H_theta",
    preserves="Steiner's formula and mixed volumes",
    boundary="null",
    source="Sullivan, Discrete surfaces",
    after="H_sin",
    total_after="H_sin",
)
def H_theta(theta: Column, edge_length: Column) -> Column:
    """Mean curvature of the edge by the angle, as Steiner's formula has it."""
    return theta * edge_length


@curvature_pass(
    symbol="2 tan(θ/2)|e|",
    formula="2 tan(θ_e/2)|e|",
    on="edge",
    length_exponent=1,
    mean_degree=1,
    parity="odd",
    signed=True,
    total="H_tan",
    preserves="the area of parallel surfaces whose edges meet in mitres",
    boundary="null; also where the surface folds onto itself: the mitre there has no end",
    source="Sullivan, Discrete surfaces",
    after="H_theta",
    total_after="H_theta",
)
def H_tan(theta: Column, edge_length: Column, folded: Flags) -> Column:
    """Mean curvature of the edge by the tangent, as mitred parallel surfaces have it."""
    return null_where(folded, 2 * np.tan(theta / 2) * edge_length)


@curvature_pass(
    symbol="κ_e",
    formula="2 sin(θ_e/2)|e| / area of the two faces at e = 2 sin(θ_e/2) / mean height of the two faces over e",
    on="edge",
    kind="density",
    length_exponent=-1,
    parity="odd",
    signed=True,
    preserves="1/r on a cylinder of radius r whose facets are equally wide and inscribed, however long they are",
    boundary="null; also where θ_e is",
    source="curvcli",
    after="H_tan",
)
def kappa_across(surface: Surface, theta: Column, edge_length: Column, face_area: Column) -> Column:
    """Curvature across the edge: its bend per width of its two faces, positive where convex.

    The curvature of a tessellated fillet or cylinder. An edge that bends more than the angular step of a tessellation
    is sharp: its radius is 0, and this number depends on the width of its faces only.
    """
    curvature = np.full(len(surface.edges), np.nan)

    def divide(block: slice) -> None:
        edges = surface.edges.inner_edges(block)
        area = face_area.take(edges.half_edge // 3) + face_area.take(edges.twin // 3)
        chord = 2 * np.sin(theta[edges.where] / 2) * edge_length[edges.where]
        with np.errstate(divide="ignore", invalid="ignore"):
            curvature[edges.where] = chord / area

    for_each(slices(len(surface.edges.pairs[0]), EDGES_PER_BLOCK), divide)
    return null_where(np.isnan(theta), curvature)
