"""Nodes to a solid, with what OpenSCAD makes of operands that are missing, empty, or of the wrong dimension."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..mesh import Mesh
from . import extrude, primitives, regions
from .fragments import Resolution
from .mesh_files import read_mesh
from .polyhedron import bulges, polyhedron
from .regions import Grid, Loops
from .solids import Solids
from .text import Node, ScadError
from .values import flag, number, vector
from .writing import written

_FLAT = 1e-14
"""Determinant, relative to the lengths of the columns, below which a matrix is singular."""


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
class Evaluator:
    """Evaluates nodes. `warnings` says what was left out; `leaves` counts the bodies and regions that were made."""

    solids: Solids
    grid: Grid = field(default_factory=Grid)
    folder: Path = Path()
    warnings: list[str] = field(default_factory=list)
    leaves: int = 0

    def solid(self, top: list[Node]):
        """What the whole file is, a solid or nothing."""
        root = Node("group", 1, children=top)
        marked = _first_marked(top)
        value = self._value(root if marked is None else Node("group", marked.line, children=[marked]))
        if isinstance(value, Region) and value.loops:
            raise ScadError(1, "the result is flat")
        return value.solid if isinstance(value, Body) else None

    def _value(self, root: Node) -> Value:
        """Children before their parents, without recursion."""
        values: list[Value] = []
        stack = [(root, False)]
        while stack:
            node, done = stack.pop()
            if not done:
                stack.append((node, True))
                stack += [(child, False) for child in reversed(node.children)]
                continue
            count = len(node.children)
            children = values[len(values) - count :] if count else []
            del values[len(values) - count :]
            # What is only shown in the background takes no part.
            kept = [v for v, child in zip(children, node.children) if "%" not in child.modifiers]
            values.append(self._node(node, kept))
        return values.pop()

    def _node(self, node: Node, children: list[Value]) -> Value:
        make = _MODULES.get(node.name)
        if make is None:
            raise ScadError(node.line, f"{node.name}() is not supported")
        return make(self, node, children)

    def _warn(self, node: Node, message: str) -> None:
        self.warnings.append(f"line {node.line}: {message}")

    # Operations on what children there are.

    def _operate(self, node: Node, children: list[Value], kind: str) -> Value:
        """The operation in the dimension of the first child that has one."""
        dimension = next((c.dimension for c in children if c is not None), 0)
        if any(c is not None and c.dimension != dimension for c in children):
            self._warn(node, "2D and 3D are mixed: what is not as the first child is left out")
        alike = [c if c is not None and c.dimension == dimension else None for c in children]
        if dimension == 2:
            return self._flat(alike, kind)
        return self._solid(node, alike, kind) if dimension == 3 else None

    def _flat(self, children: list[Region | None], kind: str) -> Region | None:
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

    def _solid(self, node: Node, children: list[Body | None], kind: str) -> Body | None:
        if kind == "hull":
            return self._hull(children)
        if len(children) == 1:
            return children[0]
        if kind == "union":
            return self._union(node, children)
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
        self._warn(node, "a body that touches itself along an edge or in a point is left out, as OpenSCAD does")
        return None

    def _union(self, node: Node, children: list[Body | None]) -> Body | None:
        kept = [c for c in children if c is not None and (c.solid is not None or c.flat is not None)]
        if len(kept) == 1:
            return kept[0]
        solid = [c.solid for c in (self._firm(node, c) for c in kept) if c is not None and c.solid is not None]
        if not solid:
            return None
        return Body(solid[0] if len(solid) == 1 else self.solids.combine("union", solid))

    def _hull(self, children: list[Body | None]) -> Body | None:
        points = [self._corners(c) for c in children if c is not None]
        every = np.concatenate([np.zeros((0, 3)), *points])
        solid = self.solids.hull(every) if len(every) > 3 else None
        return None if solid is None else Body(solid)

    def _corners(self, body: Body) -> np.ndarray:
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

    # Modules.

    def _moved(self, node: Node, children: list[Value], matrix: np.ndarray) -> Value:
        if not np.isfinite(matrix).all():
            self._warn(node, "a matrix of numbers that are not finite: what it moves is left out")
            return None
        value = self._operate(node, children, "union")
        if isinstance(value, Region):
            plane = matrix[:2][:, [0, 1, 3]]
            return Region(regions.transformed(self.grid, value.loops, plane)) if value.loops else value
        return self._moved_body(value, matrix) if value is not None else None

    def _moved_body(self, body: Body, matrix: np.ndarray) -> Body:
        flat = None if body.flat is None else body.flat @ matrix[:, :3].T + matrix[:, 3]
        if body.solid is None or not _is_singular(matrix):
            return Body(None if body.solid is None else self.solids.moved(body.solid, matrix), flat, body.loose)
        corners = self._corners(Body(body.solid))
        return Body(None, corners @ matrix[:, :3].T + matrix[:, 3])

    def _resized(self, node: Node, children: list[Value]) -> Value:
        value = self._operate(node, children, "union")
        size = vector(node.get("newsize", 0), 3) or [0.0] * 3
        auto = node.get("auto", 1)
        auto = [auto] * 3 if isinstance(auto, bool) else [flag(a) for a in auto or []] + [False] * 3
        if isinstance(value, Region) and value.loops:
            low, high = (getattr(np.concatenate(value.loops), end)(0) for end in ("min", "max"))
            factors = _factors(high - low, size[:2], auto)
            return Region([loop * factors for loop in value.loops])
        if isinstance(value, Body) and value.solid is not None:
            corners = self._corners(value)
            factors = _factors(np.ptp(corners, axis=0), size, auto) if len(corners) else np.ones(3)
            return self._moved_body(value, np.column_stack([np.diag(factors), np.zeros(3)]))
        return value

    def _offset(self, node: Node, children: list[Value]) -> Value:
        region = self._region(node, children)
        if region is None:
            return None
        by, join = number(node.get("r", 0), 0.0), "round"
        if isinstance(node.get("delta"), float):
            by, join = node.get("delta"), "square" if flag(node.get("chamfer")) else "miter"
        return Region(self.grid.offset(region.loops, by, join, Resolution.of(node)))

    def _region(self, node: Node, children: list[Value]) -> Region | None:
        """The union of all children, solid ones left out."""
        if any(isinstance(c, Body) for c in children):
            self._warn(node, "a solid where a flat shape is needed is left out")
        flat = [c if isinstance(c, Region) else None for c in children]
        return self._flat(flat, "union") if flat else None

    def _extruded(self, node: Node, children: list[Value]) -> Value:
        region = self._region(node, children)
        if region is None:
            return None
        convex = extrude.is_plain(node) and regions.is_convex(region.loops)
        mesh = extrude.linear(node, region.loops)
        return self._leaf(mesh, convex, mesh is not None and extrude.is_loose(node, region.loops, mesh))

    def _turned(self, node: Node, children: list[Value]) -> Value:
        region = self._region(node, children)
        if region is None:
            return None
        mesh = extrude.rotated(node, region.loops)
        return self._leaf(mesh, False, mesh is not None and extrude.touches_itself(mesh))

    def _projected(self, node: Node, children: list[Value]) -> Value:
        bodies = [c for c in children if isinstance(c, Body) and c.solid is not None]
        if not bodies:
            return None
        whole = self._union(node, bodies)
        if whole is None:
            return None
        mesh = self.solids.mesh(whole.solid)
        if flag(node.get("cut", 0)):
            halves = [section(mesh, True), section(mesh, False)]
            return Region(self.grid.tidied(self.grid.combine("union", halves)))
        return Region(self.grid.shadow(mesh.vertices[mesh.triangles][:, :, :2]))

    def _leaf(self, mesh: Mesh | None, convex: bool, loose: bool = False) -> Body:
        self.leaves += 1
        if mesh is None or not len(mesh.triangles):
            return EMPTY
        return Body(self.solids.leaf(mesh, convex), loose=loose)

    def _polyhedron(self, node: Node, children: list[Value]) -> Body:
        mesh = polyhedron(node)
        faults = {} if mesh is None else mesh.twin_faults()
        if "open" not in faults:
            if mesh is None or faults or not bulges(mesh):
                return self._leaf(mesh, False, bool(faults))
            self.leaves += 1
            return Body(self.solids.hull(mesh.vertices[np.unique(mesh.triangles)]))
        self.leaves += 1
        self._warn(node, f"a polyhedron that is not closed is left out: {faults['open']} open edges")
        return Body(None, mesh.vertices[np.unique(mesh.triangles)])

    def _imported(self, node: Node, children: list[Value]) -> Value:
        name = node.get("file", 0)
        path = self.folder / str(name)
        if not isinstance(name, str) or not path.is_file():
            self._warn(node, f"no file {name}: nothing is there")
            return EMPTY
        return self._leaf(read_mesh(path, node.line), False)

    def _written(self, node: Node, children: list[Value]) -> Value:
        self.leaves += 1
        return Region(self.grid.combine("union", [written(node)]))


def section(mesh: Mesh, above: bool) -> Loops:
    """Where the surface meets the x–y plane, seen from just above or just below it."""
    z = mesh.vertices[:, 2]
    up = z >= 0.0 if not above else z > 0.0
    following: dict = {}
    mixed = up[mesh.triangles].any(1) & ~up[mesh.triangles].all(1)
    for triangle in mesh.triangles[mixed].tolist():
        rising = falling = None
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            if up[a] != up[b]:
                edge = (min(a, b), max(a, b))
                rising, falling = (rising, edge) if up[a] else (edge, falling)
        following.setdefault(rising, []).append(falling)
    loops = []
    while following:
        start = next(iter(following))
        ring, edge = [], start
        while edge in following:
            ring.append(edge)
            nexts = following[edge]
            after = nexts.pop()
            if not nexts:
                del following[edge]
            edge = after
        loops.append(np.array([_crossing(mesh.vertices[list(e)]) for e in ring]))
    return loops


def _crossing(ends: np.ndarray) -> np.ndarray:
    a, b = ends
    return (a + a[2] / (a[2] - b[2]) * (b - a))[:2]


def _is_singular(matrix: np.ndarray) -> bool:
    lengths = np.linalg.norm(matrix[:, :3], axis=0)
    return not lengths.all() or abs(np.linalg.det(matrix[:, :3] / lengths)) <= _FLAT


def _factors(extent: np.ndarray, size: list[float], auto: list[bool]) -> np.ndarray:
    """Scales to a new size; those of an axis with 0 are 1, or on demand that of the largest size."""
    largest = int(np.argmax(size))
    if any(s and not e for s, e in zip(size, extent)):
        return np.ones(len(extent))
    common = size[largest] / extent[largest] if size[largest] else 1.0
    return np.array([s / e if s else common if a else 1.0 for s, e, a in zip(size, extent, auto)])


def _matrix(node: Node) -> np.ndarray:
    """The first three rows of what `multmatrix` says; the identity where it says nothing."""
    given = node.get("m", 0)
    matrix = np.eye(4)
    for i, row in enumerate(given[:4] if isinstance(given, list) else []):
        for j, value in enumerate(row[:4] if isinstance(row, list) else []):
            matrix[i, j] = number(value, matrix[i, j])
    return matrix[:3] / matrix[3, 3] if matrix[3, 3] not in (0.0, 1.0) else matrix[:3]


def _first_marked(top: list[Node]) -> Node | None:
    """The first node with `!`, which alone is made then."""
    stack = top[::-1]
    while stack:
        node = stack.pop()
        if "!" in node.modifiers:
            return node
        stack += node.children[::-1]
    return None


def _body(make: Callable[[Node], Mesh | None], convex: bool):
    return lambda self, node, children: self._leaf(make(node), convex)


def _outline(make: Callable[[Node], Loops]):
    def run(self: Evaluator, node: Node, children: list[Value]) -> Region:
        self.leaves += 1
        return Region(make(node))

    return run


def _operation(kind: str):
    return lambda self, node, children: self._operate(node, children, kind)


_MODULES = {name: _operation("union") for name in ("group", "union", "color", "render")} | {
    "difference": _operation("difference"),
    "intersection": _operation("intersection"),
    "hull": _operation("hull"),
    "minkowski": _operation("minkowski"),
    "multmatrix": lambda self, node, children: self._moved(node, children, _matrix(node)),
    "resize": Evaluator._resized,
    "offset": Evaluator._offset,
    "linear_extrude": Evaluator._extruded,
    "rotate_extrude": Evaluator._turned,
    "projection": Evaluator._projected,
    "import": Evaluator._imported,
    "text": Evaluator._written,
    "cube": _body(primitives.cube, True),
    "sphere": _body(primitives.sphere, True),
    "cylinder": _body(primitives.cylinder, True),
    "polyhedron": Evaluator._polyhedron,
    "square": _outline(primitives.square),
    "circle": _outline(primitives.circle),
    "polygon": lambda self, node, children: _outline(lambda n: primitives.polygon(n, self.grid))(self, node, children),
}
