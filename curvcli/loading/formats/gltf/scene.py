"""The nodes of a glTF scene in the order of the file, with their transforms."""

from __future__ import annotations

import numpy as np

from ....errors import InputError
from ...copies import Matrix, compose
from .tree import Node, Tree


def placed_meshes(tree: Tree) -> list[tuple[int, int, Matrix]]:
    """(node, mesh, transform) of every node of the scene with a mesh, parents before children.

    Without any node, every mesh stands once where it is; its node is -1.
    Errors: InputError for a node out of range, or with two parents.
    """
    if not tree.nodes:
        return [(-1, mesh, np.eye(4)) for mesh in range(len(tree.meshes))]
    placed: list[tuple[int, int, Matrix]] = []
    visited: set[int] = set()
    stack = [(root, np.eye(4)) for root in reversed(_roots(tree))]
    while stack:
        number, outer = stack.pop()
        if number >= len(tree.nodes):
            raise InputError(f"node {number} found, 0 to {len(tree.nodes) - 1} expected")
        if number in visited:
            raise InputError("a node with two parents found, one expected", place=f"node {number}")
        visited.add(number)
        node = tree.nodes[number]
        matrix = compose(outer, _local(node))
        if node.mesh is not None:
            if node.mesh >= len(tree.meshes):
                problem = f"mesh {node.mesh} found, 0 to {len(tree.meshes) - 1} expected"
                raise InputError(problem, place=f"node {number}")
            placed.append((number, node.mesh, matrix))
        stack += [(child, matrix) for child in reversed(node.children)]
    return placed


def _roots(tree: Tree) -> list[int]:
    scene = tree.scene or 0
    if scene < len(tree.scenes):
        return tree.scenes[scene].nodes
    if tree.scene is not None:
        raise InputError(f"scene {scene} found, {len(tree.scenes)} exist")
    children = {child for node in tree.nodes for child in node.children}
    return [number for number in range(len(tree.nodes)) if number not in children]


def _local(node: Node) -> Matrix:
    """The transform of a node: its matrix, or translation · rotation · scale."""
    if node.matrix is not None:
        return np.array(node.matrix, np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    if node.rotation is not None:
        matrix[:3, :3] = _rotation(*node.rotation)
    if node.scale is not None:
        matrix[:3, :3] *= node.scale
    if node.translation is not None:
        matrix[:3, 3] = node.translation
    return matrix


def _rotation(x: float, y: float, z: float, w: float) -> Matrix:
    """The matrix of a quaternion of any length."""
    square = x * x + y * y + z * z + w * w
    s = 2 / square if square > 0 else 0.0
    return np.array(
        [
            [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
        ]
    )
