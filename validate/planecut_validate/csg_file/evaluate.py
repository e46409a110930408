"""Nodes to a solid."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..mesh import Mesh
from . import extrude, primitives, regions
from .affine import factors, is_singular, matrix_of
from .fragments import Resolution
from .mesh_files import read_mesh
from .operations import EMPTY, Body, Operations, Region, Value
from .polyhedron import bulges, polyhedron
from .regions import Grid, Loops
from .sections import section
from .solids import Solids
from .text import Node, ScadError
from .values import flag, number, vector
from .writing import written


@dataclass
class Evaluator:
    """Evaluates nodes. `folder`: where imported files are looked for; `warnings` says what was left out."""

    solids: Solids
    grid: Grid = field(default_factory=Grid)
    folder: Path = Path()
    warnings: list[str] = field(default_factory=list)

    def __post_init__(self):
        self.operations = Operations(self.solids, self.grid, self._warn)

    def solid(self, top: list[Node]):
        """What the whole file is, a solid or nothing. Raises `ScadError` where it cannot be told."""
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

    def _moved(self, node: Node, children: list[Value], matrix: np.ndarray) -> Value:
        if not np.isfinite(matrix).all():
            self._warn(node, "a matrix of numbers that are not finite: what it moves is left out")
            return None
        value = self.operations.apply(node, children, "union")
        if isinstance(value, Region):
            plane = matrix[:2][:, [0, 1, 3]]
            return Region(regions.transformed(self.grid, value.loops, plane)) if value.loops else value
        return self._moved_body(value, matrix) if value is not None else None

    def _moved_body(self, body: Body, matrix: np.ndarray) -> Body:
        flat = None if body.flat is None else body.flat @ matrix[:, :3].T + matrix[:, 3]
        if body.solid is None or not is_singular(matrix):
            return Body(None if body.solid is None else self.solids.moved(body.solid, matrix), flat, body.loose)
        corners = self.operations.corners(Body(body.solid))
        return Body(None, corners @ matrix[:, :3].T + matrix[:, 3])

    def _resized(self, node: Node, children: list[Value]) -> Value:
        value = self.operations.apply(node, children, "union")
        size = vector(node.get("newsize", 0), 3) or [0.0] * 3
        auto = node.get("auto", 1)
        auto = [auto] * 3 if isinstance(auto, bool) else [flag(a) for a in auto or []] + [False] * 3
        if isinstance(value, Region) and value.loops:
            low, high = (getattr(np.concatenate(value.loops), end)(0) for end in ("min", "max"))
            by = factors(high - low, size[:2], auto)
            return Region([loop * by for loop in value.loops])
        if isinstance(value, Body) and value.solid is not None:
            corners = self.operations.corners(value)
            by = factors(np.ptp(corners, axis=0), size, auto) if len(corners) else np.ones(3)
            return self._moved_body(value, np.column_stack([np.diag(by), np.zeros(3)]))
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
        return self.operations.flat(flat, "union") if flat else None

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
        whole = self.operations.united(node, bodies)
        if whole is None:
            return None
        mesh = self.solids.mesh(whole.solid)
        if flag(node.get("cut", 0)):
            halves = [section(mesh, True), section(mesh, False)]
            return Region(self.grid.tidied(self.grid.combine("union", halves)))
        return Region(self.grid.shadow(mesh.vertices[mesh.triangles][:, :, :2]))

    def _leaf(self, mesh: Mesh | None, convex: bool, loose: bool = False) -> Body:
        if mesh is None or not len(mesh.triangles):
            return EMPTY
        return Body(self.solids.leaf(mesh, convex), loose=loose)

    def _polyhedron(self, node: Node, children: list[Value]) -> Body:
        mesh = polyhedron(node)
        faults = {} if mesh is None else mesh.twin_faults()
        if "open" in faults:
            self._warn(node, f"a polyhedron that is not closed is left out: {faults['open']} open edges")
            return Body(None, mesh.vertices[np.unique(mesh.triangles)])
        if mesh is None or faults or not bulges(mesh):
            return self._leaf(mesh, False, bool(faults))
        return Body(self.solids.hull(mesh.vertices[np.unique(mesh.triangles)]))

    def _imported(self, node: Node, children: list[Value]) -> Value:
        name = node.get("file", 0)
        path = self.folder / str(name)
        if not isinstance(name, str) or not path.is_file():
            self._warn(node, f"no file {name}: nothing is there")
            return EMPTY
        return self._leaf(read_mesh(path, node.line), False)

    def _written(self, node: Node, children: list[Value]) -> Value:
        return Region(self.grid.combine("union", [written(node)]))


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
    return lambda self, node, children: Region(make(node))


def _operation(kind: str):
    return lambda self, node, children: self.operations.apply(node, children, kind)


_MODULES = {name: _operation("union") for name in ("group", "union", "color", "render")} | {
    "difference": _operation("difference"),
    "intersection": _operation("intersection"),
    "hull": _operation("hull"),
    "minkowski": _operation("minkowski"),
    "multmatrix": lambda self, node, children: self._moved(node, children, matrix_of(node)),
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
    "polygon": lambda self, node, children: Region(primitives.polygon(node, self.grid)),
}
