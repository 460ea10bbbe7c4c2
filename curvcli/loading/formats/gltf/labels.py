"""Labels of the faces of a glTF scene: its nodes and its materials."""

from __future__ import annotations

from ....mesh.file import Labels
from ...copies import Matrix, Runs, label_runs, unique_names
from .tree import Tree


def scene_labels(tree: Tree, placed: list[tuple[int, int, Matrix]], nodes: Runs, materials: Runs) -> dict[str, Labels]:
    """Labels by kind. A node has its name or that of its mesh, with a number where another node has it too."""
    labels = {kind: label_runs(nodes, _node_names(tree, placed)) for kind in ("groups", "objects")}
    if any(code >= 0 for code, _ in materials):
        names = [material.name or f"material {k}" for k, material in enumerate(tree.materials)]
        labels["materials"] = label_runs(materials, unique_names(names))
    return labels


def _node_names(tree: Tree, placed: list[tuple[int, int, Matrix]]) -> list[str]:
    names = [(tree.nodes[node].name if node >= 0 else None) or tree.meshes[mesh].name for node, mesh, _ in placed]
    return unique_names([name or f"node {k}" for k, name in enumerate(names)])
