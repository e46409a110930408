"""Regions drawn out along z or around it, quad for quad and diagonal for diagonal as OpenSCAD does it."""

import math

import manifold3d
import numpy as np

from ..angles import cosine, sine
from ..mesh import Mesh
from .fragments import Resolution
from .primitives import without_flat
from .regions import Loops
from .text import Node
from .values import flag, number, vector

_EQUAL = 1e-5
"""Relative difference up to which two diagonals are equally long."""


def linear(node: Node, loops: Loops) -> Mesh | None:
    """`linear_extrude`; nothing where the height is not positive."""
    height = number(node.get("height", 0), 100.0)
    if not loops or not height > 0.0 or math.isinf(height):
        return None
    twist = number(node.get("twist"), 0.0)
    twist = twist if math.isfinite(twist) else 0.0
    scale = _scales(node.get("scale"))
    slices = number(node.get("slices"), 0.0)
    count = max(int(slices), 1) if slices else Resolution.of(node).slices(loops, height, twist, scale)
    bottom = -height / 2.0 if flag(node.get("center")) else 0.0
    return _layers(loops, bottom, height, twist, np.array(scale), count)


def is_plain(node: Node) -> bool:
    """Whether a convex region becomes a convex body: no twist, and one scale for both axes."""
    scale = _scales(node.get("scale"))
    return scale[0] == scale[1] and number(node.get("twist"), 0.0) == 0.0


def is_loose(node: Node, loops: Loops, mesh: Mesh) -> bool:
    """Whether the mesh is not a 2-manifold: where corners of the region lie at one place, or a scale ends at 0."""
    points = np.concatenate(loops)
    if 0.0 not in _scales(node.get("scale")):
        return len(np.unique(points, axis=0)) < len(points)
    top = mesh.vertices[:, 2].max()
    # A lid that has become a line is none.
    lid = (mesh.vertices[mesh.triangles][:, :, 2] == top).all(1)
    return touches_itself(Mesh(mesh.vertices, mesh.triangles[~lid]))


def touches_itself(mesh: Mesh) -> bool:
    """Whether the mesh is not a 2-manifold once corners at one place are one."""
    vertices, which = np.unique(mesh.vertices, axis=0, return_inverse=True)
    return bool(without_flat(Mesh(vertices, which.reshape(-1)[mesh.triangles])).twin_faults())


def _scales(value) -> tuple[float, float]:
    given = [value] * 2 if isinstance(value, float) else vector(value, 2) or [1.0, 1.0]
    return tuple(max(v, 0.0) if math.isfinite(v) else 1.0 for v in given)


def _layers(loops: Loops, bottom: float, height: float, twist: float, scale: np.ndarray, count: int) -> Mesh:
    points = np.concatenate(loops)
    rows = np.array([_placed(points, -twist * j / count, 1.0 - (1.0 - scale) * j / count) for j in range(count + 1)])
    z = bottom + height * np.arange(count + 1) / count
    vertices = np.concatenate([np.column_stack([row, np.full(len(row), h)]) for row, h in zip(rows, z)])
    lid = caps(loops)
    triangles = [lid[:, ::-1], lid + count * len(points)]
    at = 0
    for loop in loops:
        ring = at + np.arange(len(loop))
        at += len(loop)
        for j in range(count):
            at_zero = j == count - 1 and bool((scale == 0.0).any())
            triangles.append(_sides(rows, ring, j, _area(loop) > 0.0, twist <= 0.0, at_zero))
    return _joined_tip(Mesh(vertices, np.concatenate(triangles)), count, len(points), scale)


def _joined_tip(mesh: Mesh, count: int, size: int, scale: np.ndarray) -> Mesh:
    """Where both scales end at 0, the top is one point."""
    if scale.any():
        return mesh
    top = count * size
    return without_flat(Mesh(mesh.vertices[: top + 1], np.minimum(mesh.triangles, top)))


def _placed(points: np.ndarray, degrees: float, scale: np.ndarray) -> np.ndarray:
    """Turned first, scaled then."""
    c, s = cosine(degrees), sine(degrees)
    return points @ np.array([[c, s], [-s, c]]) * scale


def _sides(rows: np.ndarray, ring: np.ndarray, j: int, positive: bool, back: bool, at_zero: bool) -> np.ndarray:
    """Two triangles per edge of one layer, cut along the shorter diagonal, or the longer one where a scale ends at 0."""
    size = rows.shape[1]
    following = np.roll(ring, -1)
    below, above = rows[j], rows[j + 1]
    first = np.linalg.norm(below[ring] - above[following], axis=1)
    other = np.linalg.norm(below[following] - above[ring], axis=1)
    equal = 2.0 * np.abs(first - other) <= _EQUAL * (first + other)
    # Of two diagonals as long as each other, the one that goes along with the twist.
    chosen = np.where(equal, positive != back, first < other) ^ at_zero
    a, b = ring + j * size, following + j * size
    c, d = a + size, b + size
    split = chosen[:, None, None]
    either = [np.stack(pair).transpose(2, 0, 1) for pair in ([[a, b, d], [a, d, c]], [[a, b, c], [b, d, c]])]
    return np.where(split, *either).reshape(-1, 3)


def caps(loops: Loops) -> np.ndarray:
    """Triangles `(n, 3)` of the region, by the numbers of its corners."""
    found = manifold3d.triangulate([np.ascontiguousarray(loop) for loop in loops])
    return np.asarray(found, dtype=np.int64).reshape(-1, 3)


def _area(loop: np.ndarray) -> float:
    following = np.roll(loop, -1, axis=0)
    return float((loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0]).sum())


def rotated(node: Node, loops: Loops) -> Mesh | None:
    """`rotate_extrude`; nothing where the region lies on both sides of the axis."""
    angle = number(node.get("angle", 0), 360.0)
    angle = angle if math.isfinite(angle) and -360.0 < angle <= 360.0 else 360.0
    if not loops or angle == 0.0:
        return None
    points = np.concatenate(loops)
    low, high = min(points[:, 0].min(), 0.0), max(points[:, 0].max(), 0.0)
    if low < 0.0 < high:
        return None
    fragments = max(int(Resolution.of(node).fragments(high - low) * abs(angle) / 360.0), 1)
    start = number(node.get("start"), 180.0 if angle == 360.0 else 0.0)
    whole = angle == 360.0
    mesh = _turned(loops, points, [start + angle * j / fragments for j in range(fragments + (not whole))], whole)
    return Mesh(mesh.vertices, mesh.triangles[:, ::-1]) if mesh.volume() < 0.0 else mesh


def _turned(loops: Loops, points: np.ndarray, degrees: list[float], whole: bool) -> Mesh:
    size, count = len(points), len(degrees)
    vertices = np.concatenate(
        [np.column_stack([points[:, 0] * cosine(a), points[:, 0] * sine(a), points[:, 1]]) for a in degrees]
    )
    # Corners on the axis are the same in every place.
    number_of = np.arange(count * size).reshape(count, size)
    number_of[:, points[:, 0] == 0.0] = number_of[0, points[:, 0] == 0.0]
    triangles = []
    if not whole:
        lid = caps(loops)
        triangles += [number_of[0][lid], number_of[-1][lid[:, ::-1]]]
    at = 0
    for loop in loops:
        here = number_of[:, at : at + len(loop)]
        at += len(loop)
        there = np.roll(here, -1, axis=0) if whole else here[1:]
        here = here if whole else here[:-1]
        here_next, there_next = np.roll(here, -1, axis=1), np.roll(there, -1, axis=1)
        triangles += [
            np.stack([here, there_next, here_next], axis=2).reshape(-1, 3),
            np.stack([here, there, there_next], axis=2).reshape(-1, 3),
        ]
    mesh = without_flat(Mesh(vertices, np.concatenate(triangles)))
    return _compact(mesh)


def _compact(mesh: Mesh) -> Mesh:
    used, triangles = np.unique(mesh.triangles, return_inverse=True)
    return Mesh(mesh.vertices[used], triangles.reshape(-1, 3))
