"""Reads the triangles of a Wavefront OBJ, indices exactly as written."""

from pathlib import Path

import numpy as np

from .mesh import Mesh


def read_obj(path: Path) -> Mesh:
    """The mesh of all objects and groups in the file. Raises `ValueError` where a face is no triangle or has no vertex."""
    vertices: list[list[float]] = []
    triangles: list[list[int]] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append([float(w) for w in words[1:4]])
        elif words[0] == "f":
            corners = [int(w.split("/")[0]) for w in words[1:]]
            if len(corners) != 3:
                raise ValueError(f"{path.name}:{number}: a face with {len(corners)} corners, expected triangles")
            indices = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            if 0 in corners or not all(0 <= i < len(vertices) for i in indices):
                raise ValueError(f"{path.name}:{number}: a face names a vertex that is not there")
            triangles.append(indices)
    return Mesh(np.array(vertices, dtype=float).reshape(-1, 3), np.array(triangles, dtype=np.int64).reshape(-1, 3))
