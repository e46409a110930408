"""Reads the triangles of a Wavefront OBJ, indices exactly as written."""

from pathlib import Path

import numpy as np

from .mesh import Mesh


def read_obj(path: Path) -> Mesh:
    """The mesh of all objects and groups in the file. Raises `ValueError` where a face is no triangle or has no vertex."""
    vertices, objects = _read(path)
    return Mesh(vertices, np.concatenate([np.zeros((0, 3), dtype=np.int64), *objects]))


def read_objects(path: Path) -> list[Mesh]:
    """One mesh per object (`o`) with faces, with the vertices that it uses. Raises as `read_obj` does."""
    vertices, objects = _read(path)
    meshes = []
    for triangles in objects:
        if len(triangles):
            used, renumbered = np.unique(triangles, return_inverse=True)
            meshes.append(Mesh(vertices[used], renumbered.reshape(-1, 3)))
    return meshes


def _read(path: Path) -> tuple[np.ndarray, list[np.ndarray]]:
    """All vertices, and the triangles of each object."""
    vertices: list[list[float]] = []
    objects: list[list[list[int]]] = [[]]
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append([float(w) for w in words[1:4]])
        elif words[0] == "o":
            objects.append([])
        elif words[0] == "f":
            corners = [int(w.split("/")[0]) for w in words[1:]]
            if len(corners) != 3:
                raise ValueError(f"{path.name}:{number}: a face with {len(corners)} corners, expected triangles")
            indices = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            if 0 in corners or not all(0 <= i < len(vertices) for i in indices):
                raise ValueError(f"{path.name}:{number}: a face names a vertex that is not there")
            objects[-1].append(indices)
    triangles = [np.array(one, dtype=np.int64).reshape(-1, 3) for one in objects]
    return np.array(vertices, dtype=float).reshape(-1, 3), triangles
