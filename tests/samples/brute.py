"""Topology the slow way, from the definitions, to judge what samples claim about themselves."""

from __future__ import annotations

from collections import defaultdict

Face = tuple[int, int, int]


def topology(faces: list[Face]) -> dict[str, object]:
    """The facts of a triangle complex under the names of the report."""
    at_edge: dict[tuple[int, int], list[tuple[int, bool]]] = defaultdict(list)
    at_vertex: dict[int, list[int]] = defaultdict(list)
    for number, face in enumerate(faces):
        for a, b in zip(face, face[1:] + face[:1], strict=True):
            at_edge[min(a, b), max(a, b)].append((number, a < b))
            at_vertex[a].append(number)
    chi = len(at_vertex) - len(at_edge) + len(faces)
    crowded = {edge for edge, users in at_edge.items() if len(users) > 2}
    rim = [edge for edge, users in at_edge.items() if len(users) == 1]
    busy = {end for edge in crowded for end in edge}
    split = [v for v, star in at_vertex.items() if v not in busy and not _one_fan(v, [faces[n] for n in star])]
    manifold = not crowded and not split
    coherent = all(users[0][1] != users[1][1] for users in at_edge.values() if len(users) == 2)
    orientable = _two_sided(len(faces), [users for users in at_edge.values() if len(users) == 2])
    components = _pieces(at_vertex, at_edge)
    loops = _pieces({end for edge in rim for end in edge}, rim) if manifold else None
    deficit = None if loops is None else 2 * components - chi - loops
    return {
        "euler_characteristic": chi,
        "components": components,
        "boundary_loops": loops,
        "closed": not rim,
        "manifold": manifold,
        "orientable": orientable,
        "consistent_winding": coherent,
        "genus": deficit // 2 if deficit is not None and orientable else None,
        "crosscaps": deficit if deficit is not None and not orientable else None,
        "nonmanifold_edges": len(crowded),
        "nonmanifold_vertices": len(split),
        "degenerate_faces": 0,
        "duplicate_faces": len(faces) - len({frozenset(face) for face in faces}),
    }


def _one_fan(vertex: int, star: list[Face]) -> bool:
    """The opposite edges make one path or one cycle."""
    links = [tuple(corner for corner in face if corner != vertex) for face in star]
    ends = [end for link in links for end in link]
    return max(map(ends.count, ends)) <= 2 and _pieces(ends, links) == 1


def _pieces(things: object, links: object) -> int:
    """Number of connected pieces, by merging."""
    parent = {thing: thing for thing in things}  # type: ignore[attr-defined]

    def root(thing: int) -> int:
        while parent[thing] != thing:
            parent[thing] = parent[parent[thing]]
            thing = parent[thing]
        return thing

    for a, b in links:  # type: ignore[attr-defined]
        parent[root(a)] = root(b)
    return len({root(thing) for thing in parent})


def _two_sided(count: int, shared: list[list[tuple[int, bool]]]) -> bool:
    """Test for an orientation in which every shared edge has opposite half-edges."""
    turned: dict[int, bool] = {}
    beside: dict[int, list[tuple[int, bool]]] = defaultdict(list)
    for (a, way_a), (b, way_b) in shared:
        beside[a].append((b, way_a == way_b))
        beside[b].append((a, way_a == way_b))
    for seed in range(count):
        turned.setdefault(seed, False)
        stack = [seed] if len(turned) and beside[seed] else []
        while stack:
            face = stack.pop()
            for other, clash in beside[face]:
                if other not in turned:
                    turned[other] = turned[face] ^ clash
                    stack.append(other)
                elif turned[other] != turned[face] ^ clash:
                    return False
    return True
