"""Operations on whatever children a node has: missing, empty, loose, or of the wrong dimension, as OpenSCAD takes them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import regions
from .regions import Grid, Loops
from .solids import Solids
from .text import Node


@dataclass(frozen=True)
class Region:
    """Something flat; empty where it has no loops."""

    loops: Loops

    dimension = 2


@dataclass(frozen=True)
class Body:
    """Something solid; empty where `solid` is nothing.

    `flat`: corners of what has no inside, made flat by a singular matrix or not closed; a hull has use for them.
    `loose`: its mesh is not a 2-manifold. OpenSCAD shows such a body alone, but leaves it out of every operation.
    """

    solid: object | None
    flat: np.ndarray | None = None
    loose: bool = False

    dimension = 3


EMPTY = Body(None)
Value = Region | Body | None
"""Nothing at all has no dimension, which is not the same as an empty body or region."""


@dataclass
class Operations:
    """Operations by name, in the dimension of the operands. `warn`: is told what was left out."""

    solids: Solids
    grid: Grid
    warn: Callable[[Node, str], None]

    def apply(self, node: Node, children: list[Value], kind: str) -> Value:
        """The operation in the dimension of the first child that has one."""
        dimension = next((c.dimension for c in children if c is not None), 0)
        if any(c is not None and c.dimension != dimension for c in children):
            self.warn(node, "2D and 3D are mixed: what is not as the first child is left out")
        alike = [c if c is not None and c.dimension == dimension else None for c in children]
        if dimension == 2:
            return self.flat(alike, kind)
        return self._bodies(node, alike, kind) if dimension == 3 else None

    def flat(self, children: list[Region | None], kind: str) -> Region | None:
        """The operation on regions; a child that is nothing is an empty one, and an only child stays as it is."""
        loops = [[] if c is None else c.loops for c in children]
        if kind == "hull":
            return Region(regions.hull([loop for each in loops for loop in each]))
        if len(children) == 1:
            return children[0]
        if kind == "minkowski":
            found = loops[0]
            for other in loops[1:]:
                found = self.grid.minkowski(found, other)
            return Region(found)
        return Region(self.grid.combine(kind, loops))

    def _bodies(self, node: Node, children: list[Body | None], kind: str) -> Body | None:
        if kind == "hull":
            return self._hull(children)
        if len(children) == 1:
            return children[0]
        if kind == "union":
            return self.united(node, children)
        if kind == "minkowski":
            return self._minkowski(children)
        children = [self._firm(node, c) for c in children]
        if children[0] is None or children[0].solid is None:
            return None
        others = [None if c is None else c.solid for c in children[1:]]
        if kind == "intersection" and any(o is None for o in others):
            return None
        operands = [children[0].solid, *(o for o in others if o is not None)]
        return Body(operands[0] if len(operands) == 1 else self.solids.combine(kind, operands))

    def _firm(self, node: Node, body: Body | None) -> Body | None:
        """The body as an operand: nothing where it is loose."""
        if body is None or not body.loose:
            return body
        self.warn(node, "a body that touches itself along an edge or in a point is left out, as OpenSCAD does")
        return None

    def united(self, node: Node, children: list[Body | None]) -> Body | None:
        """The union of what there is."""
        kept = [c for c in children if c is not None and (c.solid is not None or c.flat is not None)]
        if len(kept) == 1:
            return kept[0]
        solid = [c.solid for c in (self._firm(node, c) for c in kept) if c is not None and c.solid is not None]
        if not solid:
            return None
        return Body(solid[0] if len(solid) == 1 else self.solids.combine("union", solid))

    def _hull(self, children: list[Body | None]) -> Body | None:
        points = [self.corners(c) for c in children if c is not None]
        every = np.concatenate([np.zeros((0, 3)), *points])
        solid = self.solids.hull(every) if len(every) > 3 else None
        return None if solid is None else Body(solid)

    def corners(self, body: Body) -> np.ndarray:
        """Points with the same hull."""
        if body.solid is None:
            return np.zeros((0, 3)) if body.flat is None else body.flat
        parts = self.solids.convex_parts(body.solid)
        if parts is not None:
            return np.concatenate(parts)
        mesh = self.solids.mesh(body.solid)
        return mesh.vertices[np.unique(mesh.triangles)]

    def _minkowski(self, children: list[Body | None]) -> Body | None:
        kept = [c for c in children if c is not None and not self._is_empty(c)]
        if not kept:
            return None
        found = kept[0]
        for other in kept[1:]:
            found = self._sum(found, other)
        return found

    def _is_empty(self, body: Body) -> bool:
        if body.solid is None:
            return body.flat is None
        return self.solids.convex_parts(body.solid) is None and not len(self.solids.mesh(body.solid).triangles)

    def _sum(self, first: Body, second: Body) -> Body:
        parts = [self._parts(body) for body in (first, second)]
        if any(part is None for part in parts):
            return Body(self.solids.sum(first.solid, second.solid))
        sums = [self.solids.hull((a[:, None] + b).reshape(-1, 3)) for a in parts[0] for b in parts[1]]
        sums = [s for s in sums if s is not None]
        if not sums:
            return EMPTY
        return Body(sums[0] if len(sums) == 1 else self.solids.combine("union", sums))

    def _parts(self, body: Body) -> list[np.ndarray] | None:
        return [body.flat] if body.solid is None else self.solids.convex_parts(body.solid)
