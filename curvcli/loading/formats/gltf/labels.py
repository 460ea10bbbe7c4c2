"""Labels of the faces of a glTF scene: its nodes and its materials."""

from __future__ import annotations

import numpy as np

from ....mesh.file import Labels
from .scene import Matrix
from .tree import Tree

Runs = list[tuple[int, int]]
"""A label and a number of consecutive faces; -1 for no label."""


def scene_labels(tree: Tree, placed: list[tuple[int, int, Matrix]], nodes: Runs, materials: Runs) -> dict[str, Labels]:
    """Labels by kind. A node has its name or that of its mesh, with a number where another node has it too."""
    labels = {kind: _labels(nodes, _node_names(tree, placed)) for kind in ("groups", "objects")}
    if any(code >= 0 for code, _ in materials):
        names = [material.name or f"material {k}" for k, material in enumerate(tree.materials)]
        labels["materials"] = _labels(materials, distinct(names))
    return labels


def _labels(runs: Runs, names: list[str]) -> Labels:
    """One label per face from the label of each run of faces."""
    codes, counts = np.array(runs, np.int64).T
    used = np.unique(codes[codes >= 0])
    new = np.full(len(names) + 1, -1, np.int32)
    new[used] = np.arange(len(used))
    return Labels(np.repeat(new[codes], counts), tuple(names[k] for k in used.tolist()))


def _node_names(tree: Tree, placed: list[tuple[int, int, Matrix]]) -> list[str]:
    """The name of each node, or of its mesh; with its number where that name is not its own."""
    names = [(tree.nodes[node].name if node >= 0 else None) or tree.meshes[mesh].name for node, mesh, _ in placed]
    return distinct([name or f"node {k}" for k, name in enumerate(names)])


def distinct(names: list[str]) -> list[str]:
    """Names of which each stands once: a repeated one gets its number."""
    seen: set[str] = set()
    for k in range(len(names)):
        while names[k] in seen:
            names[k] += f" #{k}"
        seen.add(names[k])
    return names
