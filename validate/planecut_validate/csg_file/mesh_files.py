"""Meshes that `import` names: STL (both kinds), OBJ and OFF."""

import struct
from pathlib import Path

import numpy as np

from ..mesh import Mesh
from .text import ScadError


def read_mesh(path: Path, line: int) -> Mesh:
    """The mesh, corners at one place made one. Raises `ScadError` where it cannot be read or is not closed."""
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise ScadError(line, f"import of {path.name} is not supported")
    try:
        mesh = _joined(reader(path.read_bytes()))
    except (ValueError, IndexError, struct.error) as error:
        raise ScadError(line, f"{path.name}: {error}") from error
    if "open" in mesh.twin_faults():
        raise ScadError(line, f"{path.name} is not closed")
    return Mesh(mesh.vertices, mesh.triangles[:, ::-1]) if mesh.volume() < 0.0 else mesh


def _joined(corners: np.ndarray) -> Mesh:
    vertices, triangles = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    t = triangles.reshape(-1, 3)
    return Mesh(vertices, t[(t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])])


def _stl(data: bytes) -> np.ndarray:
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        return np.ndarray((count, 12), "<f4", data, 84, (50, 4))[:, 3:].astype(float).reshape(-1, 3, 3)
    words = data.split()
    return np.array(
        [[float(w) for w in words[i + 1 : i + 4]] for i, word in enumerate(words) if word == b"vertex"]
    ).reshape(-1, 3, 3)


def _obj(data: bytes) -> np.ndarray:
    points, triangles = [], []
    for row in data.decode("latin-1").splitlines():
        words = row.split()
        if words[:1] == ["v"]:
            points.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            face = [int(w.split("/")[0]) for w in words[1:]]
            face = [i - 1 if i > 0 else len(points) + i for i in face]
            triangles += [[face[0], b, c] for b, c in zip(face[1:], face[2:])]
    return np.array(points)[np.array(triangles)]


def _off(data: bytes) -> np.ndarray:
    rows = [row.split("#")[0].split() for row in data.decode("latin-1").splitlines()]
    words = [w for row in rows for w in row]
    if not words or words[0] != "OFF":
        raise ValueError("no OFF file")
    count, faces = int(words[1]), int(words[2])
    points = np.array(words[4 : 4 + 3 * count], dtype=float).reshape(-1, 3)
    at, triangles = 4 + 3 * count, []
    for _ in range(faces):
        size = int(words[at])
        face = [int(w) for w in words[at + 1 : at + 1 + size]]
        triangles += [[face[0], b, c] for b, c in zip(face[1:], face[2:])]
        at += 1 + size
    return points[np.array(triangles)]


_READERS = {".stl": _stl, ".obj": _obj, ".off": _off}
