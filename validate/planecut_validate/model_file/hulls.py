"""Convex hulls and Minkowski sums of trees."""

import numpy as np

from ..leaf import ConvexLeaf, MeshLeaf, mesh_of
from ..solid_tree import SolidTree
from ..tree_model import TreeModel
from .text import fail


def hull(trees: list[SolidTree], path: str) -> SolidTree:
    """The convex hull of all solids."""
    points = [np.zeros((0, 3))] + [_corners(tree, path) for tree in trees]
    every = np.concatenate(points)
    return SolidTree.of_leaf(ConvexLeaf.of_points(every)) if len(every) else SolidTree([], [("union", 0)])


def _corners(tree: SolidTree, path: str) -> np.ndarray:
    """All vertices of a solid, and maybe points within its hull."""
    if tree.is_union_of_convex():
        return np.concatenate([np.zeros((0, 3))] + [leaf.points for leaf in tree.leaves])
    model = TreeModel(tree)
    if model.is_unbounded:
        fail(path, "bounded solids")
    if model.is_empty:
        return np.zeros((0, 3))
    mesh = mesh_of(model.solid())
    return mesh.vertices[np.unique(mesh.triangles)]


def minkowski(trees: list[SolidTree], path: str) -> SolidTree:
    """The sum of two solids: of each convex part of the one with each of the other, or by manifold3d."""
    if all(t.is_union_of_convex() and all(isinstance(leaf, ConvexLeaf) for leaf in t.leaves) for t in trees):
        first, second = ([leaf.points for leaf in tree.leaves] for tree in trees)
        sums = [(a[:, None] + b).reshape(-1, 3) for a in first for b in second]
        return SolidTree.combine("union", [SolidTree.of_leaf(ConvexLeaf.of_points(s)) for s in sums])
    models = [TreeModel(tree) for tree in trees]
    if any(model.is_unbounded for model in models):
        fail(path, "bounded solids")
    if any(model.is_empty for model in models):
        return SolidTree([], [("union", 0)])
    first, second = (model.solid() for model in models)
    return SolidTree.of_leaf(MeshLeaf(mesh_of(first.minkowski_sum(second))))
