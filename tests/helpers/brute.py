"""Topology and orientation of a triangle complex from the definitions, with dictionaries and loops."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from tests.helpers.meshes import Mesh

Face = tuple[int, int, int]
Edge = tuple[int, int]


def classes(things: Iterable[Any], together: Iterable[tuple[Any, Any]]) -> dict[Any, Any]:
    """The representative of each thing when pairs are merged."""
    parent = {thing: thing for thing in things}

    def root(thing: Any) -> Any:
        while parent[thing] != thing:
            thing = parent[thing]
        return thing

    for one, other in together:
        parent[root(one)] = root(other)
    return {thing: root(thing) for thing in parent}


def numbered(representative: dict[int, Hashable], members: Iterable[int]) -> list[int]:
    """Numbers 0, 1, … for the classes, in the order of their lowest member."""
    number: dict[Hashable, int] = {}
    return [number.setdefault(representative[member], len(number)) for member in members]


@dataclass
class Patch:
    """Faces joined through edges with n_e = 2."""

    faces: list[int]
    orientable: bool
    closed: bool
    volume: float


class Complex:
    """Everything about a list of faces, slowly."""

    def __init__(self, given: Mesh) -> None:
        self.points = given.points
        self.faces: list[Face] = [tuple(face) for face in given.faces.tolist()]
        self.at_edge: dict[Edge, list[tuple[int, bool]]] = defaultdict(list)
        self.star: dict[int, list[int]] = defaultdict(list)
        for number, face in enumerate(self.faces):
            for k, a in enumerate(face):
                b = face[(k + 1) % 3]
                self.at_edge[min(a, b), max(a, b)].append((number, a < b))
                self.star[a].append(number)
        self.vertices = sorted(self.star)
        self.edges = sorted(self.at_edge)
        self.rim = [edge for edge in self.edges if len(self.at_edge[edge]) == 1]
        self.crowded = [edge for edge in self.edges if len(self.at_edge[edge]) > 2]
        crowded_ends = {end for edge in self.crowded for end in edge}
        self.split = [v for v in self.vertices if v not in crowded_ends and self._fans(v) > 1]
        self.sign, self.patch_of, self.patches = self._orientation()
        of_vertex = classes(self.vertices, self.edges)
        self.component = numbered({n: of_vertex[face[0]] for n, face in enumerate(self.faces)}, range(len(self.faces)))

    def _fans(self, vertex: int) -> int:
        """Number of fans of the star, its faces joined through edges with n_e = 2."""
        spokes = [users for edge, users in self.at_edge.items() if vertex in edge and len(users) == 2]
        return len(set(classes(self.star[vertex], [(one, other) for (one, _), (other, _) in spokes]).values()))

    def _orientation(self) -> tuple[list[int], list[int], list[Patch]]:
        """The sign of each face relative to the file, its patch, and the patches by their lowest face."""
        beside: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for users in self.at_edge.values():
            if len(users) == 2:
                (one, way), (other, back) = users
                relation = -1 if way == back else 1
                beside[one].append((other, relation))
                beside[other].append((one, relation))
        sign: dict[int, int] = {}
        patch_of: dict[int, int] = {}
        patches: list[Patch] = []
        for seed in range(len(self.faces)):
            if seed in sign:
                continue
            sign[seed], patch_of[seed], stack, orientable = 1, len(patches), [seed], True
            members = [seed]
            while stack:
                face = stack.pop()
                for other, relation in beside[face]:
                    if other not in sign:
                        sign[other], patch_of[other] = sign[face] * relation, len(patches)
                        stack.append(other)
                        members.append(other)
                    elif sign[other] != sign[face] * relation:
                        orientable = False
            if not orientable:
                sign.update(dict.fromkeys(members, 1))
            patches.append(Patch(sorted(members), orientable, False, 0.0))
        signs = [sign[n] for n in range(len(self.faces))]
        for number, patch in enumerate(patches):
            own = [
                [(n, up) for n, up in users if patch_of[n] == number]
                for users in self.at_edge.values()
                if any(patch_of[n] == number for n, _ in users)
            ]
            patch.closed = all(len(users) == 2 for users in own)
            if patch.closed and patch.orientable:
                patch.closed = all(sum(signs[n] * (1 if up else -1) for n, up in users) == 0 for users in own)
            base = self.points[self.faces[patch.faces[0]][0]]
            patch.volume = sum(
                signs[n] * float(np.linalg.det(self.points[list(self.faces[n])] - base)) / 6 for n in patch.faces
            )
        return signs, [patch_of[n] for n in range(len(self.faces))], patches

    # ------------------------------------------------------------------ facts

    def facts(self, component: int | None = None) -> dict[str, Any]:
        """The facts under the names of the report, of the whole or of one component."""
        chosen = [n for n in range(len(self.faces)) if component in (None, self.component[n])]
        member = set(chosen)
        edges = [edge for edge in self.edges if self.at_edge[edge][0][0] in member]
        vertices = [v for v in self.vertices if self.star[v][0] in member]
        crowded = [edge for edge in self.crowded if edge in set(edges)]
        split = [v for v in self.split if v in set(vertices)]
        rim = [edge for edge in self.rim if edge in set(edges)]
        pairs = [self.at_edge[edge] for edge in edges if len(self.at_edge[edge]) == 2]
        triples = [frozenset(self.faces[n]) for n in chosen]
        seen: set[frozenset[int]] = set()
        doubled = 0
        for number, face in enumerate(self.faces):
            again = frozenset(face) in seen
            seen.add(frozenset(face))
            doubled += again and number in member
        found: dict[str, Any] = {
            "vertices": len(vertices),
            "edges": len(edges),
            "faces": len(triples),
            "euler_characteristic": len(vertices) - len(edges) + len(triples),
            "boundary_edges": len(rim),
            "closed": not rim,
            "manifold": not crowded and not split,
            "nonmanifold_edges": len(crowded),
            "nonmanifold_vertices": len(split),
            "consistent_winding": all(one[1] != other[1] for one, other in pairs),
            "orientable": all(self.patches[self.patch_of[n]].orientable for n in chosen),
            "duplicate_faces": doubled,
            "duplicate_vertices": self._doubled_vertices(vertices),
        }
        return found | self._kind(found, rim, component)

    def _doubled_vertices(self, vertices: list[int]) -> int:
        """Referenced vertices beyond the first of the whole mesh at exactly the same position."""
        first: dict[tuple[float, ...], int] = {}
        for v in self.vertices:
            first.setdefault(tuple(self.points[v] + 0.0), v)
        return sum(first[tuple(self.points[v] + 0.0)] != v for v in vertices)

    def _kind(self, found: dict[str, Any], rim: list[Edge], component: int | None) -> dict[str, int | None]:
        if component is None:
            each = [self.facts(number) for number in range(self.components)]
            return {"components": self.components} | {key: _sum(piece[key] for piece in each) for key in KINDS}
        if not found["manifold"]:
            return {"components": 1} | dict.fromkeys(KINDS)
        loops = len(set(classes({end for edge in rim for end in edge}, rim).values()))
        missing = 2 - found["euler_characteristic"] - loops
        return {
            "components": 1,
            "boundary_loops": loops,
            "genus": missing // 2 if found["orientable"] else None,
            "crosscaps": None if found["orientable"] else missing,
        }

    @property
    def components(self) -> int:
        return max(self.component) + 1

    def status(self, vertex: int, degenerate: Callable[[int], bool] = lambda _: False) -> str:
        """The status of a vertex."""
        if vertex not in self.star:
            return "unreferenced"
        at = [edge for edge in self.at_edge if vertex in edge]
        if vertex in self.split or any(len(self.at_edge[edge]) > 2 for edge in at):
            return "nonmanifold"
        if degenerate(vertex):
            return "degenerate"
        return "boundary" if any(len(self.at_edge[edge]) == 1 for edge in at) else "interior"


KINDS = ("boundary_loops", "genus", "crosscaps")


def _sum(values: Iterable[int | None]) -> int | None:
    known = list(values)
    return None if None in known else sum(value for value in known if value is not None)


def clashing_pairs(faces: list[Face]) -> set[Edge]:
    """Edges of exactly two faces that run along them the same way."""
    ways: dict[Edge, list[bool]] = defaultdict(list)
    for face in faces:
        for a, b in combinations(sorted(face), 2):
            at = face.index(a)
            ways[a, b].append(face[(at + 1) % 3] == b)
    return {edge for edge, each in ways.items() if len(each) == 2 and each[0] == each[1]}
