"""`polyhedron`: faces over points, clockwise seen from outside."""

import math

import manifold3d
import numpy as np

from ..mesh import Mesh
from .text import Node
from .values import indices, point

_PLANAR = 1e-9
"""Distance from a face's own plane, relative to the face, up to which corners lie on it."""
_NEARLY = math.cos(math.radians(0.1))


def polyhedron(node: Node) -> Mesh | None:
    """The mesh, whether it is closed or not; nothing where a point is none."""
    points, faces = _given(node)
    if points is None or not faces:
        return None
    vertices, which = np.unique(points, axis=0, return_inverse=True)
    which = which.reshape(-1)
    triangles = [t for face in faces for t in _triangles(vertices, _distinct(which[face[::-1]].tolist()))]
    mesh = Mesh(vertices, np.array(triangles, dtype=np.int64).reshape(-1, 3))
    if not len(mesh.triangles):
        return None
    # Some files give their faces the wrong way around, all of them.
    return Mesh(vertices, mesh.triangles[:, ::-1]) if mesh.volume() < 0.0 else mesh


def bulges(mesh: Mesh) -> bool:
    """Whether the mesh is nearly convex but not quite: OpenSCAD takes its hull where no edge is turned in by more than 0.1°.

    Such meshes come from faces whose corners do not lie in one plane.
    """
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None] + 1e-300
    size = len(mesh.vertices)
    edges = np.concatenate([mesh.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    tips = np.concatenate([mesh.triangles[:, (k + 2) % 3] for k in range(3)])
    face = np.tile(np.arange(len(mesh.triangles)), 3)
    order = np.argsort(edges[:, 0] * size + edges[:, 1])
    found = np.searchsorted((edges[:, 0] * size + edges[:, 1])[order], edges[:, 1] * size + edges[:, 0])
    twin = order[found]
    beyond = np.einsum("ij,ij->i", normals[face], mesh.vertices[tips[twin]] - mesh.vertices[edges[:, 0]])
    bent = np.einsum("ij,ij->i", normals[face], normals[face[twin]])
    inward = beyond > _PLANAR * np.ptp(mesh.vertices, axis=0).max()
    return bool(inward.any() and (bent[inward] >= _NEARLY).all())


def _given(node: Node) -> tuple[np.ndarray | None, list[np.ndarray]]:
    given, faces = node.get("points", 0), node.get("faces", 1)
    faces = node.get("triangles") if faces is None else faces
    points = [point(p, 2, 3) for p in given] if isinstance(given, list) else []
    count = len(points)
    used = [np.array([i for i in indices(face) if i < count], dtype=int) for face in faces or []]
    if any(points[i] is None for face in used for i in face):
        return None, []
    return np.array([p or [0.0] * 3 for p in points]).reshape(-1, 3), [face for face in used if len(face) > 2]


def _distinct(face: list[int]) -> list[int]:
    """The face without corners that repeat the one before, and without spikes."""
    kept = face
    while len(kept) > 2:
        drop = next((i for i in range(len(kept)) if kept[i] == kept[i - 1] or kept[i - 2] == kept[i]), None)
        if drop is None:
            return kept
        if kept[drop] == kept[drop - 1]:
            kept = kept[:drop] + kept[drop + 1 :]
        else:
            gone = {drop % len(kept), (drop - 1) % len(kept)}
            kept = [v for i, v in enumerate(kept) if i not in gone]
    return []


def _triangles(vertices: np.ndarray, face: list[int]) -> list[list[int]]:
    """Triangles of one face, Delaunay's in the plane of the two axes that see most of it, as OpenSCAD has them."""
    if len(face) <= 3:
        return [face] if len(face) == 3 else []
    corners = vertices[face]
    following = np.roll(corners, -1, axis=0)
    normal = np.cross(corners - corners[0], following - corners[0]).sum(0)
    axis = int(np.abs(normal).argmax())
    flat = np.delete(corners, axis, axis=1)
    if (normal[axis] < 0.0) != (axis == 1):
        flat = flat[:, ::-1]
    found = [list(t) for t in manifold3d.triangulate([np.ascontiguousarray(flat)]).tolist()]
    extent = np.abs(corners - corners[0]).max()
    if np.abs((corners - corners[0]) @ (normal / (np.linalg.norm(normal) + 1e-300))).max() > _PLANAR * extent:
        found = _delaunay(flat, found)
    return [[face[i] for i in t] for t in found]


def _delaunay(points: np.ndarray, triangles: list[list[int]]) -> list[list[int]]:
    """Turns diagonals that have a corner within the circle of their triangle, until there are none."""
    for _ in range(10 * len(points)):
        edges = {(t[k], t[(k + 1) % 3]): (n, t[(k + 2) % 3]) for n, t in enumerate(triangles) for k in range(3)}
        for (a, b), (n, c) in edges.items():
            if (b, a) not in edges:
                continue
            m, d = edges[b, a]
            if _in_circle(points[[a, b, c]], points[d]) and _convex(points[[a, d, b, c]]):
                triangles[n], triangles[m] = [c, a, d], [d, b, c]
                break
        else:
            return triangles
    return triangles


def _in_circle(triangle: np.ndarray, point: np.ndarray) -> bool:
    rows = triangle - point
    scale = np.abs(rows).max()
    return bool(np.linalg.det(np.column_stack([rows, np.square(rows).sum(1)])) > 1e-12 * scale**4)


def _convex(quad: np.ndarray) -> bool:
    along = np.roll(quad, -1, axis=0) - quad
    after = np.roll(along, -1, axis=0)
    return bool((along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0] > 0.0).all())
