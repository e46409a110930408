"""Convex hulls and Minkowski sums of trees."""

import numpy as np

from ..leaf import ConvexLeaf, MeshLeaf, mesh_of
from ..solid_tree import SolidTree
from ..tree_model import TreeModel
from .text import fail


def hull_of(points: np.ndarray) -> SolidTree:
    """The convex hull of points; nothing where they lie in a plane."""
    leaf = ConvexLeaf.of_points(points) if len(points) else None
    return SolidTree.nothing() if leaf is None else SolidTree.of_leaf(leaf)


def hull(trees: list[SolidTree], path: str) -> SolidTree:
    """The convex hull of all solids."""
    return hull_of(np.concatenate([_corners(tree, path) for tree in trees]))


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
        return SolidTree.combine("union", [hull_of(s) for s in sums])
    models = [TreeModel(tree) for tree in trees]
    if any(model.is_unbounded for model in models):
        fail(path, "bounded solids")
    if any(model.is_empty for model in models):
        return SolidTree.nothing()
    first, second = (model.solid() for model in models)
    return SolidTree.of_leaf(MeshLeaf(mesh_of(first.minkowski_sum(second))))
