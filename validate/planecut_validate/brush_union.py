"""The reference model of a `.map`: the union of convex bodies."""

import random

import manifold3d
import numpy as np

from .convex_body import ConvexBody
from .leaf import ConvexLeaf
from .lines import POSITION, Coverage, Lines
from .reference import AGREED, ReferenceSurface, ReferenceVolume
from .result import SAME
from .solid_tree import SolidTree

_ORDERS = 6
"""Orders of the operands to try before giving up."""


class BrushUnion:
    """The union of convex bodies."""

    counts_brushes = True
    is_unbounded = False
    empty_may_be_refused = True
    box_is_exact = True
    # Brushes of a map touch nearly always; the area is held against the written mesh.
    is_generic = False
    is_simple = False
    exact = None
    limit = SAME
    position = POSITION

    def __init__(self, bodies: list[ConvexBody], brushes: int):
        self.brushes = brushes
        self.notes: list[str] = []
        unbounded = sum(len(b.vertices) > 0 and not b.bounded for b in bodies)
        bodies = [b for b in bodies if b.bounded]
        leaves = [ConvexLeaf.of_body(b) for b in bodies]
        solid = [i for i, leaf in enumerate(leaves) if leaf.manifold().num_tri() > 0]
        self.bodies = [bodies[i] for i in solid]
        self.hulls = [leaves[i].manifold() for i in solid]
        self.tree = SolidTree.combine("union", [SolidTree.of_leaf(leaves[i]) for i in solid])
        if unbounded:
            self.notes.append(f"{unbounded} unbounded")
        if (empty := brushes - unbounded - len(solid)) > 0:
            self.notes.append(f"{empty} empty")
        self.is_empty = not solid
        self.brush_volume_sum = float(sum(hull.volume() for hull in self.hulls))
        points = np.concatenate([np.zeros((0 if solid else 1, 3))] + [b.vertices for b in self.bodies])
        self.low, self.high = points.min(0), points.max(0)

    def volume(self, candidate: float | None = None) -> ReferenceVolume:
        """Two ways to one number: the batch union, and the sum over bodies of what earlier ones leave of each.

        The batch union now and then depends on the order of its operands (by 1e-5 of the volume on real maps), so where
        the two differ it is asked again in other orders until one of its answers meets the sum of parts.
        """
        parts = self._volume_by_parts()
        answers = {"parts": parts, "batch": _union(self.hulls)}
        for seed in range(_ORDERS):
            agreeing = [v for name, v in answers.items() if name != "parts" and abs(v - parts) <= AGREED * parts]
            if agreeing:
                return ReferenceVolume(agreeing[-1], answers)
            shuffled = list(self.hulls)
            random.Random(seed).shuffle(shuffled)
            answers[f"batch, order {seed}"] = _union(shuffled)
        raise ArithmeticError(f"manifold3d gives {answers}")

    def _volume_by_parts(self) -> float:
        low, high = (
            np.array([hull.bounding_box() for hull in self.hulls])[:, part] for part in (slice(3), slice(3, 6))
        )
        total = 0.0
        for i, hull in enumerate(self.hulls):
            earlier = np.nonzero(((low[:i] <= high[i]) & (high[:i] >= low[i])).all(1))[0]
            operands = [hull] + [self.hulls[j] for j in earlier]
            total += manifold3d.Manifold.batch_boolean(operands, manifold3d.OpType.Subtract).volume()
        return total

    def surface(self) -> ReferenceSurface:
        """Not asked: maps are not generic."""
        raise NotImplementedError

    def coverage(self, lines: Lines) -> Coverage:
        """Where the lines cross the union, by the brushes' half-spaces."""
        return self.tree.coverage(lines, float(np.linalg.norm(self.high - self.low)))


def _union(hulls: list[manifold3d.Manifold]) -> float:
    return manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add).volume()
