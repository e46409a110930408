"""An indexed triangle mesh and what can be said of it without any geometry library."""

from dataclasses import dataclass

import numpy as np


@dataclass
class Mesh:
    """`vertices`: `(v, 3)` doubles; `triangles`: `(t, 3)` indices, counter-clockwise seen from outside."""

    vertices: np.ndarray
    triangles: np.ndarray

    def _corners(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The corners relative to the middle of the mesh, which keeps digits far from the origin, and that middle."""
        used = self.vertices[np.unique(self.triangles)]
        middle = 0.5 * (used.min(0) + used.max(0)) if len(used) else np.zeros(3)
        a, b, c = (self.vertices[self.triangles[:, i]] - middle for i in range(3))
        return a, b, c, middle

    def volume(self) -> float:
        """The volume that the oriented triangles enclose."""
        a, b, c, _ = self._corners()
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)

    def area(self) -> float:
        """The sum of the triangles' areas."""
        a, b, c, _ = self._corners()
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)

    def centroid(self) -> np.ndarray:
        """The centroid of the enclosed volume."""
        a, b, c, middle = self._corners()
        weights = np.einsum("ij,ij->i", a, np.cross(b, c))
        return middle + (weights[:, None] * (a + b + c)).sum(0) / (4.0 * weights.sum())

    def twin_faults(self) -> dict[str, int]:
        """Counts what keeps the mesh from being a closed, oriented 2-manifold by its indices alone; empty where nothing.

        `degenerate`: triangles with a repeated index. `doubled`: directed edges that occur again. `open`: directed edges
        whose opposite is missing. `pinched`: vertices whose triangles form more than one fan.
        """
        edges = _directed_edges(self.triangles)
        stride = len(self.vertices)
        keys, counts = np.unique(edges[:, 0] * stride + edges[:, 1], return_counts=True)
        opposite = (keys % stride) * stride + keys // stride
        faults = {
            "degenerate": int((edges[:, 0] == edges[:, 1]).sum()),
            "doubled": int((counts - 1).sum()),
            "open": int((~np.isin(opposite, keys, assume_unique=True)).sum()),
        }
        if not any(faults.values()):
            faults["pinched"] = self._pinched(edges)
        return {name: count for name, count in faults.items() if count}

    def _pinched(self, edges: np.ndarray) -> int:
        """Fans in excess of one per vertex. `edges`: as of `_directed_edges`, each with its one twin."""
        stride = len(self.vertices)
        keys = edges[:, 0] * stride + edges[:, 1]
        order = np.argsort(keys)
        twin = order[np.searchsorted(keys[order], edges[:, 1] * stride + edges[:, 0])]
        # Around the first vertex of a half-edge: the half-edge after its twin starts at the same vertex.
        triangles = len(self.triangles)
        around = (twin + triangles) % (3 * triangles)
        fans = len(np.unique(_components(len(edges), np.arange(len(edges)), around)))
        return fans - len(np.unique(self.triangles))

    def components(self) -> int:
        """The number of connected surfaces."""
        return len(np.unique(self._labels()))

    def genus(self) -> int:
        """The sum of the genus over the connected surfaces of a closed oriented manifold."""
        vertices, faces = len(np.unique(self.triangles)), len(self.triangles)
        return self.components() - (vertices - faces // 2) // 2

    def _labels(self) -> np.ndarray:
        edges = _directed_edges(self.triangles)
        return _components(len(self.vertices), edges[:, 0], edges[:, 1])[np.unique(self.triangles)]


def _directed_edges(triangles: np.ndarray) -> np.ndarray:
    """`(3t, 2)`: the first edges of all triangles, then the second, then the third."""
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def _components(nodes: int, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Per node the smallest node that it is linked to, by hooking and pointer jumping."""
    label = np.arange(nodes)
    while True:
        a, b = label[first], label[second]
        if (a == b).all():
            return label
        low, high = np.minimum(a, b), np.maximum(a, b)
        np.minimum.at(label, high, low)
        while (label != label[label]).any():
            label = label[label]
