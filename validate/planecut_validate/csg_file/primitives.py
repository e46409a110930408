"""The bodies and regions that have a name, corner for corner as OpenSCAD makes them."""

import math

import numpy as np

from ..mesh import Mesh
from .fragments import Resolution, unit_circle
from .regions import Grid, Loops
from .text import Node
from .values import flag, indices, number, point, sizes


def _positive(*values: float) -> bool:
    return all(v > 0.0 and math.isfinite(v) for v in values)


def cube(node: Node) -> Mesh | None:
    """A box; nothing where a side is not positive."""
    size = sizes(node.get("size", 0), 3)
    if not _positive(*size):
        return None
    return box(np.array(size), flag(node.get("center", 1)))


def box(size: np.ndarray, center: bool) -> Mesh:
    """A box from the origin, or around it."""
    corners = (np.arange(8)[:, None] >> [0, 1, 2] & 1) * size
    return Mesh(corners - size / 2.0 if center else corners, _BOX)


_BOX = np.array([
    [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
    [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
])  # fmt: skip


def sphere(node: Node) -> Mesh | None:
    """Rings half a step away from the poles."""
    radius = _radius(node, "r", "d", 1.0)
    if not _positive(radius):
        return None
    count = Resolution.of(node).fragments(radius)
    rings = (count + 1) // 2
    heights = unit_circle(4 * rings)[1 : 2 * rings : 2] * radius
    levels = [(h[1], h[0]) for h in heights]
    # From the lowest to the highest.
    return _stacked(count, levels[::-1])


def cylinder(node: Node) -> Mesh | None:
    """A cylinder or a cone; the wider end tells how many corners it has."""
    height = number(node.get("h", 0), 1.0)
    both = _radius(node, "r", "d", 1.0)
    low, high = _radius(node, "r1", "d1", both, 1), _radius(node, "r2", "d2", both, 2)
    if not _positive(height, max(low, high)) or not (low >= 0.0 and high >= 0.0):
        return None
    if math.isinf(low) or math.isinf(high):
        return None
    bottom = -height / 2.0 if flag(node.get("center", 3)) else 0.0
    top = height / 2.0 if flag(node.get("center", 3)) else height
    return _stacked(Resolution.of(node).fragments(max(low, high)), [(low, bottom), (high, top)])


def _radius(node: Node, radius: str, diameter: str, default: float, place: int = 0) -> float:
    if isinstance(node.get(diameter), float):
        return node.get(diameter) / 2.0
    return number(node.get(radius, place), default)


def _stacked(count: int, levels: list[tuple[float, float]]) -> Mesh:
    """Circles `(radius, z)` from below, joined, with a lid at each end; a radius of 0 is a tip."""
    circle = unit_circle(count)
    rings, vertices, at = [], [], 0
    for radius, z in levels:
        corners = circle * radius if radius > 0.0 else np.zeros((1, 2))
        vertices.append(np.column_stack([corners, np.full(len(corners), z)]))
        rings.append(at + np.arange(count) % len(corners))
        at += len(corners)
    triangles = []
    for low, high in zip(rings, rings[1:]):
        low_next, high_next = np.roll(low, -1), np.roll(high, -1)
        triangles += [np.column_stack([low, low_next, high_next]), np.column_stack([low, high_next, high])]
    fan = np.column_stack([np.zeros(count - 2, dtype=int), np.arange(1, count - 1), np.arange(2, count)])
    triangles += [rings[0][fan[:, ::-1]], rings[-1][fan]]
    return without_flat(Mesh(np.concatenate(vertices), np.concatenate(triangles)))


def without_flat(mesh: Mesh) -> Mesh:
    """The mesh without triangles that have one corner twice."""
    t = mesh.triangles
    return Mesh(mesh.vertices, t[(t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])])


def square(node: Node) -> Loops:
    """A rectangle."""
    size = sizes(node.get("size", 0), 2)
    if not _positive(*size):
        return []
    corners = np.array([[0.0, 0.0], [size[0], 0.0], size, [0.0, size[1]]])
    return [corners - np.array(size) / 2.0 if flag(node.get("center", 1)) else corners]


def circle(node: Node) -> Loops:
    """A regular polygon."""
    radius = _radius(node, "r", "d", 1.0)
    return [unit_circle(Resolution.of(node).fragments(radius)) * radius] if _positive(radius) else []


def polygon(node: Node, grid: Grid) -> Loops:
    """Paths over points, even-odd; nothing where a point is no pair of finite numbers."""
    given = node.get("points", 0)
    points = [point(p, 2, 2) for p in given] if isinstance(given, list) else []
    if not points or any(p is None for p in points):
        return []
    corners = np.array(points)
    paths = node.get("paths", 1)
    if not isinstance(paths, list) or not paths:
        loops = [corners]
    else:
        loops = [corners[[i for i in indices(path) if i < len(corners)]] for path in paths]
    return grid.sanitized([loop for loop in loops if len(loop) > 2])
