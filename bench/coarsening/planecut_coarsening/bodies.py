"""Convex bodies as closed triangle meshes in OBJ files, one for each object."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from manifold3d import Error, Manifold, Mesh64


@dataclass(frozen=True)
class Body:
    """One object of a file: `(v, 3)` corners, `(t, 3)` triangles into them."""

    corners: np.ndarray
    triangles: np.ndarray

    def hull(self) -> Manifold:
        """The convex hull of the corners."""
        return Manifold.hull_points(self.corners)

    def solid(self) -> Manifold:
        """What the triangles enclose, as they are written. Raises `ValueError` where they are no closed manifold."""
        solid = Manifold(Mesh64(self.corners, self.triangles.astype(np.uint64)))
        if solid.status() != Error.NoError:
            raise ValueError(f"not a closed manifold: {solid.status()}")
        return solid


def read_bodies(path: Path) -> list[Body]:
    """The objects and groups of a file, each with the corners that it uses. Faces become fans of triangles."""
    corners: list[list[float]] = []
    objects: list[list[list[int]]] = [[]]
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            corners.append([float(word) for word in words[1:4]])
        elif words[0] in ("o", "g") and objects[-1]:
            objects.append([])
        elif words[0] == "f":
            face = [int(word.split("/")[0]) for word in words[1:]]
            face = [index - 1 if index > 0 else len(corners) + index for index in face]
            objects[-1] += [[face[0], *pair] for pair in zip(face[1:], face[2:])]
    points = np.array(corners, dtype=float).reshape(-1, 3)
    return [_body(points, np.array(triangles)) for triangles in objects if triangles]


def write_bodies(path: Path, bodies: list[Body]) -> None:
    """The bodies as objects, with digits enough to read the same numbers again."""
    lines = []
    first = 1
    for number, body in enumerate(bodies):
        lines.append(f"o body_{number}")
        lines += ["v " + " ".join(map(repr, corner)) for corner in body.corners.tolist()]
        lines += ["f " + " ".join(map(str, triangle)) for triangle in (body.triangles + first).tolist()]
        first += len(body.corners)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _body(points: np.ndarray, triangles: np.ndarray) -> Body:
    used, renumbered = np.unique(triangles, return_inverse=True)
    return Body(points[used], renumbered.reshape(-1, 3))
