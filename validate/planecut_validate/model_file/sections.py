"""Plane sections and shadows of solids, as loops."""

import numpy as np

from ..leaf import ConvexLeaf, Leaf, mesh_of
from ..solid_tree import SolidTree
from ..tree_model import TreeModel
from .arrangement import combine


def cut(tree: SolidTree, z: float) -> list[np.ndarray]:
    """Where the solid meets the plane at height `z`: the tree of the sections of its leaves."""
    low, high = TreeModel(tree).frame()
    bounded = tree.within(low, high)
    operands = [_section(leaf, z) for leaf in bounded.leaves]
    # A rectangle around all, so that a complement has an end.
    (x0, y0), (x1, y1) = low[:2], high[:2]
    frame = [np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])]

    def inside(within: np.ndarray) -> np.ndarray:
        return tree.fold(lambda i: within[:, i], _logic) & within[:, -1]

    return combine([*operands, frame], inside)


def _logic(operation: str, values: list[np.ndarray]) -> np.ndarray:
    if operation == "complement":
        return ~values[0]
    if operation == "xor":
        return np.logical_xor.reduce(values)
    if operation == "difference":
        return values[0] & ~np.logical_or.reduce(values[1:], axis=0) if len(values) > 1 else values[0]
    return np.logical_and.reduce(values) if operation == "intersection" else np.logical_or.reduce(values)


def _section(leaf: Leaf, z: float) -> list[np.ndarray]:
    """The loops in which the surface of a leaf meets the plane; just above it where a face lies in it."""
    mesh = mesh_of(leaf.manifold())
    above = mesh.vertices[:, 2] > z
    following: dict[tuple, tuple] = {}
    for triangle in mesh.triangles[above[mesh.triangles].any(1) & ~above[mesh.triangles].all(1)].tolist():
        down = up = None
        for k in range(3):
            a, b = triangle[k], triangle[(k + 1) % 3]
            edge = (min(a, b), max(a, b))
            if above[a] and not above[b]:
                down = edge
            elif above[b] and not above[a]:
                up = edge
        following[up] = down
    loops = []
    while following:
        start, edge = following.popitem()
        ring = [start]
        while edge != start:
            ring.append(edge)
            edge = following.pop(edge)
        loops.append(np.array([_at(mesh.vertices[list(e)], z) for e in ring]))
    return loops


def _at(ends: np.ndarray, z: float) -> list[float]:
    a, b = ends
    part = (z - a[2]) / (b[2] - a[2])
    return (a + part * (b - a))[:2].tolist()


def shadow(tree: SolidTree) -> list[np.ndarray]:
    """The shadow of a bounded solid on the x–y plane."""
    if tree.is_union_of_convex() and all(isinstance(leaf, ConvexLeaf) for leaf in tree.leaves):
        operands = [[_hull(leaf.points[:, :2])] for leaf in tree.leaves]
    else:
        mesh = mesh_of(TreeModel(tree).solid())
        corners = mesh.vertices[mesh.triangles][:, :, :2]
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        upward = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        operands = [[one] for one in corners[upward > 1e-12 * np.square(np.ptp(corners.reshape(-1, 2), axis=0).max())]]
    return combine(operands, lambda within: within.any(1)) if operands else []


def _hull(points: np.ndarray) -> np.ndarray:
    """The convex hull, counter-clockwise (monotone chain)."""
    ordered = sorted({tuple(p) for p in points.tolist()})
    chains = []
    for run in (ordered, ordered[::-1]):
        chain: list = []
        for p in run:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    return np.array(chains[0] + chains[1])


def _turn(a, b, c) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
