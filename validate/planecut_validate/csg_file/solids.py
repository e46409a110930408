"""Two ways to hold a solid while a tree is evaluated: manifold3d's own, or the tree itself for the line oracle."""

from dataclasses import dataclass
from typing import Protocol

import manifold3d
import numpy as np

from ..leaf import ConvexLeaf, MeshLeaf, manifold_of, mesh_of
from ..mesh import Mesh
from ..solid_tree import SolidTree
from ..tree_model import TreeModel


class Solids(Protocol):
    """What the evaluator needs of solids; `Solid` is whatever the way holds."""

    def leaf(self, mesh: Mesh, convex: bool): ...

    def moved(self, solid, matrix: np.ndarray): ...

    def combine(self, kind: str, solids: list): ...

    def convex_parts(self, solid) -> list[np.ndarray] | None:
        """Corners of convex bodies whose union it is, where that is known."""

    def mesh(self, solid) -> Mesh:
        """Its surface; of no triangles where it is empty."""

    def sum(self, first, second):
        """The Minkowski sum of two solids that are not convex."""


@dataclass(frozen=True)
class Held:
    """A solid of manifold3d; `parts`: convex ones whose union it is, where that is known."""

    solid: manifold3d.Manifold
    parts: tuple[manifold3d.Manifold, ...] | None = None


_OPERATIONS = {
    "union": manifold3d.OpType.Add,
    "difference": manifold3d.OpType.Subtract,
    "intersection": manifold3d.OpType.Intersect,
}


class Manifolds:
    """Solids of manifold3d, as many operands at once as there are. It puts work off until something is asked."""

    def leaf(self, mesh: Mesh, convex: bool) -> Held:
        solid = manifold_of(mesh)
        return Held(solid, (solid,) if convex else None)

    def moved(self, solid: Held, matrix: np.ndarray) -> Held:
        parts = None if solid.parts is None else tuple(part.transform(matrix) for part in solid.parts)
        whole = parts[0] if parts is not None and len(parts) == 1 else solid.solid.transform(matrix)
        return Held(whole, parts)

    def combine(self, kind: str, solids: list[Held]) -> Held:
        whole = manifold3d.Manifold.batch_boolean([s.solid for s in solids], _OPERATIONS[kind])
        if kind == "union" and all(s.parts is not None for s in solids):
            return Held(whole, tuple(part for s in solids for part in s.parts))
        return Held(whole)

    def convex_parts(self, solid: Held) -> list[np.ndarray] | None:
        return None if solid.parts is None else [mesh_of(part).vertices for part in solid.parts]

    def mesh(self, solid: Held) -> Mesh:
        return mesh_of(solid.solid)

    def sum(self, first: Held, second: Held) -> Held:
        return Held(first.solid.minkowski_sum(second.solid))

    def hull(self, points: np.ndarray) -> Held | None:
        """The hull of points; nothing where they lie in a plane."""
        solid = manifold3d.Manifold.hull_points(np.ascontiguousarray(points))
        return None if solid.is_empty() else Held(solid, (solid,))


@dataclass(frozen=True)
class Moved:
    """A tree that is still to be moved."""

    tree: SolidTree
    matrix: np.ndarray

    def settled(self) -> SolidTree:
        """The tree where it belongs."""
        return self.tree if np.array_equal(self.matrix, _STILL) else self.tree.transformed(self.matrix)


_STILL = np.eye(3, 4)


class Trees:
    """Trees of leaves that are known by themselves."""

    def leaf(self, mesh: Mesh, convex: bool) -> Moved:
        leaf = ConvexLeaf.of_points(mesh.vertices) if convex else None
        return _still(SolidTree.of_leaf(leaf or MeshLeaf(mesh)))

    def moved(self, solid: Moved, matrix: np.ndarray) -> Moved:
        whole = matrix[:, :3] @ solid.matrix
        whole[:, 3] += matrix[:, 3]
        return Moved(solid.tree, whole)

    def combine(self, kind: str, solids: list[Moved]) -> Moved:
        return _still(SolidTree.combine(kind, [s.settled() for s in solids]))

    def convex_parts(self, solid: Moved) -> list[np.ndarray] | None:
        tree = solid.settled()
        if not tree.is_union_of_convex() or not all(isinstance(leaf, ConvexLeaf) for leaf in tree.leaves):
            return None
        return [leaf.points for leaf in tree.leaves]

    def mesh(self, solid: Moved) -> Mesh:
        model = TreeModel(solid.settled())
        return Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)) if model.is_empty else mesh_of(model.solid())

    def sum(self, first: Moved, second: Moved) -> Moved:
        a, b = (TreeModel(s.settled()).solid() for s in (first, second))
        return _still(SolidTree.of_leaf(MeshLeaf(mesh_of(a.minkowski_sum(b)))))

    def hull(self, points: np.ndarray) -> Moved | None:
        """The hull of points; nothing where they lie in a plane."""
        leaf = ConvexLeaf.of_points(points)
        return None if leaf is None else _still(SolidTree.of_leaf(leaf))


def _still(tree: SolidTree) -> Moved:
    return Moved(tree, _STILL)
