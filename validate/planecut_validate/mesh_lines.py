"""Where lines cross the triangles of a mesh.

Triangles are looked at along each line, as flat pictures: a line crosses a triangle when it passes on the same side of
all three edges. The side of an edge is computed once per direction of the edge, so two triangles that share an edge
always agree about it: a line slips through no crack and counts no shared edge twice. The place of a crossing is a
convex combination of the corners, which stays accurate on slivers, where a normal would not be.
"""

import numpy as np

from .lines import Crossings, Lines
from .mesh import Mesh

_LEAF = 4
"""Triangles in a leaf of the tree."""


class TriangleTree:
    """A balanced tree of boxes over triangles in Morton order, walked for many lines at once."""

    def __init__(self, mesh: Mesh):
        self.mesh = mesh
        corners = mesh.vertices[mesh.triangles]
        low, high = corners.min(1), corners.max(1)
        self.order = np.argsort(_morton(0.5 * (low + high)))
        leaves = 1 << max(0, int(np.ceil(np.log2(max(1, len(self.order)) / _LEAF))))
        # The last triangle fills up the leaves; `crossings` skips the copies.
        slots = np.minimum(np.arange(leaves * _LEAF), len(self.order) - 1)
        margin = 1e-9 * (1.0 + np.abs(corners).max())
        low = low[self.order[slots]].reshape(leaves, _LEAF, 3).min(1) - margin
        high = high[self.order[slots]].reshape(leaves, _LEAF, 3).max(1) + margin
        self.levels = [(low, high)]
        while len(low) > 1:
            low, high = low.reshape(-1, 2, 3).min(1), high.reshape(-1, 2, 3).max(1)
            self.levels.append((low, high))
        self.levels.reverse()

    def crossings(self, lines: Lines) -> Crossings:
        """All crossings, sorted by line, then by place."""
        return self.crossings_and_cosines(lines)[0]

    def crossings_and_cosines(self, lines: Lines, chunk: int = 1024) -> tuple[Crossings, np.ndarray]:
        """All crossings, and the cosine between line and normal at each."""
        parts = [self._crossings(lines[at : at + chunk], at) for at in range(0, len(lines), chunk)]
        if not parts:
            none = np.zeros(0, dtype=np.int64)
            return Crossings(none, np.zeros(0), none), np.zeros(0)
        line, t, sign, cosine = (np.concatenate(column) for column in zip(*parts))
        order = np.lexsort((t, line))
        return Crossings(line[order], t[order], sign[order]), cosine[order]

    def _crossings(self, lines: Lines, first_line: int) -> tuple[np.ndarray, ...]:
        leaf, line = self._leaves(lines)
        slot = (leaf[:, None] * _LEAF + np.arange(_LEAF)).ravel()
        line = np.repeat(line, _LEAF)
        real = slot < len(self.order)
        triangles = self.mesh.triangles[self.order[slot[real]]]
        line = line[real]
        hit, t, sign, seen = _cross(self.mesh.vertices, triangles, lines, line)
        a, b, c = (self.mesh.vertices[triangles[hit, i]] for i in range(3))
        whole = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            return line[hit] + first_line, t, sign, seen / whole

    def _leaves(self, lines: Lines) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of a leaf and a line that meet in the leaf's box."""
        with np.errstate(divide="ignore"):
            inverse = 1.0 / lines.directions
        line = np.arange(len(lines))
        node = np.zeros_like(line)
        for depth, (low, high) in enumerate(self.levels):
            if depth:
                node = (2 * node[:, None] + [0, 1]).ravel()
                line = np.repeat(line, 2)
            with np.errstate(invalid="ignore"):
                first = (low[node] - lines.origins[line]) * inverse[line]
                second = (high[node] - lines.origins[line]) * inverse[line]
            meets = np.fmin(first, second).max(1) <= np.fmax(first, second).min(1)
            node, line = node[meets], line[meets]
        return node, line


def _morton(points: np.ndarray) -> np.ndarray:
    """Interleaved bits of the points' places in a grid of 2^10 cells a side."""
    low, high = points.min(0, initial=np.inf), points.max(0, initial=-np.inf)
    cells = ((points - low) / np.maximum(high - low, 1e-300) * 1023.0).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return code


def _cross(vertices, triangles, lines: Lines, line) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Which of the pairs of a triangle and a line cross; place, sign and twice the area seen along the line of those."""
    across, up = _frames(lines.directions)
    right, above, along = [], [], []
    for corner in range(3):
        offset = vertices[triangles[:, corner]] - lines.origins[line]
        right.append(_dot(offset, across[line]))
        above.append(_dot(offset, up[line]))
        along.append(_dot(offset, lines.directions[line]))
    weights, sides = [], []
    for corner in range(3):
        # The edge opposite to the corner, from the smaller index to the larger.
        i, j = (corner + 1) % 3, (corner + 2) % 3
        turned = triangles[:, i] > triangles[:, j]
        weight = right[i] * above[j] - right[j] * above[i]
        weights.append(weight)
        sides.append(np.where(np.where(turned, -weight, weight) > 0.0, 1, -1) * np.where(turned, -1, 1))
    total = weights[0] + weights[1] + weights[2]
    hit = (sides[0] == sides[1]) & (sides[1] == sides[2]) & (total != 0.0)
    t = sum(w[hit] * a[hit] for w, a in zip(weights, along)) / total[hit]
    return hit, t, sides[0][hit], total[hit]


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Row by row, each with the same roundings wherever it stands (a matrix product does not promise that)."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def _frames(directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors that make a right-handed frame with each direction."""
    axis = np.eye(3)[np.abs(directions).argmin(1)]
    across = np.cross(axis, directions)
    across /= np.linalg.norm(across, axis=1)[:, None]
    return across, np.cross(directions, across)
