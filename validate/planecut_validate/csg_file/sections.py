"""Plane sections of meshes."""

import numpy as np

from ..mesh import Mesh
from .regions import Loops


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
