"""Triangle meshes as one body: OBJ and binary STL."""

from pathlib import Path

import numpy as np
from manifold3d import Manifold

from .bodies import Body, read_bodies


def read_mesh(path: Path) -> Body:
    """All triangles of a file; corners at one place are one."""
    if path.suffix.lower() == ".stl":
        return _joined(_stl_corners(path))
    return _joined(np.concatenate([body.corners[body.triangles].reshape(-1, 3) for body in read_bodies(path)]))


def surface_points(mesh: Body, count: int, seed: int = 0) -> np.ndarray:
    """Random points on triangles, as many for each area."""
    random = np.random.default_rng(seed)
    a, b, c = (mesh.corners[mesh.triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = random.choice(len(areas), size=count, p=areas / areas.sum())
    u, v = random.random((2, count, 1))
    turned = u + v > 1.0
    u, v = np.where(turned, 1.0 - u, u), np.where(turned, 1.0 - v, v)
    return a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]


def boundary(solid: Manifold) -> Body:
    """The triangles of a solid."""
    mesh = solid.to_mesh64()
    return Body(np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64))


def _stl_corners(path: Path) -> np.ndarray:
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles = np.frombuffer(data, dtype=record, count=count, offset=84)
    return triangles["corners"].astype(float).reshape(-1, 3)


def _joined(corners: np.ndarray) -> Body:
    points, places = np.unique(corners, axis=0, return_inverse=True)
    return Body(points, places.reshape(-1, 3))
