"""The bodies at the leaves of a tree: convex ones by their half-spaces, others by a closed mesh."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import manifold3d
import numpy as np
from scipy.spatial import ConvexHull, QhullError

from .convex_body import ConvexBody, convex_body, exact_plane
from .intervals import Ends
from .lines import CLOSE, GRAZING, Lines
from .mesh import Mesh
from .mesh_lines import TriangleTree

_FLAT = 1e-11
"""Distance from a plane, relative to the body, up to which corners lie on it."""
_WRONG = 1e-9
"""The same beyond which a plane is none of the body's."""
_CELLS = 4_000_000
"""Entries of the matrices of planes by lines that are worked on at once."""


class Leaf(Protocol):
    """A body: what the tree needs of it."""

    bounded: bool
    points: np.ndarray
    """Points of the body, `(n, 3)`; all its vertices where it is bounded."""

    def transformed(self, matrix: np.ndarray) -> "Leaf":
        """The body moved by a matrix of 3 rows of 4 that is not singular."""

    def within(self, low: np.ndarray, high: np.ndarray) -> "Leaf":
        """What lies of it in a box, where it is not bounded; else the body itself."""

    def manifold(self) -> manifold3d.Manifold:
        """The bounded body; empty where it has no interior."""

    def ends(self, lines: Lines, size: float) -> Ends:
        """Where the lines cross it. `size`: the diagonal of the whole model."""

    def faces(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Per plane of its boundary the unit row `[n, d]` and the corners of the faces on it; bounded bodies only."""


class ConvexLeaf:
    """All points within half-spaces `n·x ≤ d`, rows of `planes` `(m, 4)`; `points`: its vertices, exactly rounded."""

    def __init__(self, planes: np.ndarray, points: np.ndarray, bounded: bool):
        self.bounded = bounded
        self.points = points
        self._rows = planes
        self.planes = _distinct(planes / np.linalg.norm(planes[:, :3], axis=1)[:, None])

    @classmethod
    def of_half_spaces(cls, rows: np.ndarray) -> "ConvexLeaf":
        """The body of all points within every half-space; each row is taken exactly as it is."""
        return cls.of_body(convex_body([exact_plane(row) for row in rows.tolist()]), rows)

    @classmethod
    def of_body(cls, body: ConvexBody, rows: np.ndarray | None = None) -> "ConvexLeaf":
        """The body that `convex_body` found."""
        return cls(body.planes if rows is None else rows, body.vertices, body.bounded)

    @classmethod
    def of_points(cls, points: np.ndarray) -> "ConvexLeaf | MeshLeaf | None":
        """The convex hull of points; nothing where they lie in a plane."""
        hull = hull_of(points)
        if hull is None:
            return None
        used = points[hull.vertices]
        planes = np.unique(hull.equations * [1.0, 1.0, 1.0, -1.0], axis=0)
        beyond = (planes[:, :3] @ used.T - planes[:, 3:]).max()
        if len(planes) > _MANY or beyond > _WRONG * np.ptp(used, axis=0).max():
            return MeshLeaf(mesh_of(manifold3d.Manifold.hull_points(np.ascontiguousarray(used))))
        return cls(planes, used, True)

    def transformed(self, matrix: np.ndarray) -> "ConvexLeaf":
        linear, shift = matrix[:, :3], matrix[:, 3]
        # Cofactors instead of an inverse: small integers stay integers.
        cofactors = np.column_stack([np.cross(linear[:, (i + 1) % 3], linear[:, (i + 2) % 3]) for i in range(3)])
        determinant = float(linear[:, 0] @ cofactors[:, 0])
        normals = self._rows[:, :3] @ (np.sign(determinant) * cofactors).T
        offsets = self._rows[:, 3] * abs(determinant) + normals @ shift
        return ConvexLeaf(np.column_stack([normals, offsets]), self.points @ linear.T + shift, self.bounded)

    def within(self, low: np.ndarray, high: np.ndarray) -> "ConvexLeaf":
        if self.bounded:
            return self
        sides = [
            [*(sign * np.eye(3)[axis]), sign * corner[axis]]
            for axis in range(3)
            for sign, corner in ((1, high), (-1, low))
        ]
        return ConvexLeaf.of_half_spaces(np.concatenate([self._rows.reshape(-1, 4), sides]))

    @cached_property
    def _hull(self) -> manifold3d.Manifold:
        if len(self.points) < 4 or not self.bounded:
            return manifold3d.Manifold()
        hull = manifold3d.Manifold.hull_points(np.ascontiguousarray(self.points))
        return hull if hull.num_tri() > 0 and hull.volume() > 0.0 else manifold3d.Manifold()

    def manifold(self) -> manifold3d.Manifold:
        return self._hull

    def ends(self, lines: Lines, size: float) -> Ends:
        which = np.arange(len(lines))
        if self.bounded:
            center = 0.5 * (self.points.min(0) + self.points.max(0))
            which = lines.near(center, 1.001 * np.linalg.norm(self.points - center, axis=1).max() + CLOSE * size)
        chunk = max(1, _CELLS // max(1, len(self.planes)))
        parts = [self._clip(lines, which[at : at + chunk], size) for at in range(0, len(which), chunk)]
        return _joined(parts)

    def _clip(self, lines: Lines, which: np.ndarray, size: float) -> Ends:
        """Clips the lines against every half-space."""
        if not len(self.planes):
            return _no_ends(begins=which)
        normals, offsets = self.planes[:, :3], self.planes[:, 3:]
        rate = normals @ lines.directions[which].T
        room = offsets - normals @ lines.origins[which].T
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = room / rate
        enters = np.where(rate < 0, reach, -np.inf)
        leaves = np.where(rate > 0, reach, np.inf)
        enter, leave = enters.max(0), leaves.min(0)
        hit = (leave > enter) & ~((rate == 0) & (room < 0)).any(0)
        # One of the two is infinite where a line has no end in this body.
        unclear = np.isfinite(enter) & np.isfinite(leave) & (np.abs(leave - enter) <= CLOSE * size)
        with np.errstate(invalid="ignore"):
            for ends, end in ((enters, enter), (leaves, leave)):
                # Two planes at one end: the line passes an edge there.
                unclear |= hit & np.isfinite(end) & ((np.abs(ends - end) <= CLOSE * size).sum(0) > 1)
            bounds = ((enters == enter) & np.isfinite(enters)) | ((leaves == leave) & np.isfinite(leaves))
        unclear |= hit & (bounds & (np.abs(rate) < GRAZING)).any(0)
        into, out = hit & np.isfinite(enter), hit & np.isfinite(leave)
        line = np.concatenate([which[into], which[out]])
        sign = np.repeat([-1, 1], [into.sum(), out.sum()])
        return Ends(line, np.concatenate([enter[into], leave[out]]), sign, which[hit & ~into], which[unclear])

    def faces(self) -> list[tuple[np.ndarray, np.ndarray]]:
        extent = np.linalg.norm(np.ptp(self.points, axis=0)) if len(self.points) else 0.0
        tolerance = 100.0 * _FLAT * (extent + np.abs(self.points).max(initial=0.0))
        on = np.abs(self.planes[:, :3] @ self.points.T - self.planes[:, 3:]) <= tolerance
        return [(self.planes[i], self.points[on[i]]) for i in range(len(self.planes)) if on[i].sum() >= 3]


@dataclass
class MeshLeaf:
    """The inside of a closed, outward oriented mesh."""

    mesh: Mesh
    bounded = True

    @property
    def points(self) -> np.ndarray:
        return self.mesh.vertices

    @cached_property
    def _tree(self) -> TriangleTree:
        return TriangleTree(self.mesh)

    @cached_property
    def _solid(self) -> manifold3d.Manifold:
        return manifold_of(self.mesh)

    def transformed(self, matrix: np.ndarray) -> "MeshLeaf":
        linear = matrix[:, :3]
        turned = self.mesh.triangles[:, ::-1] if np.linalg.det(linear) < 0 else self.mesh.triangles
        return MeshLeaf(Mesh(self.mesh.vertices @ linear.T + matrix[:, 3], turned))

    def within(self, low: np.ndarray, high: np.ndarray) -> "MeshLeaf":
        return self

    def manifold(self) -> manifold3d.Manifold:
        return self._solid

    def ends(self, lines: Lines, size: float) -> Ends:
        if not len(self.mesh.triangles):
            return _no_ends()
        low, high = self.points.min(0), self.points.max(0)
        which = lines.near(0.5 * (low + high), 0.51 * np.linalg.norm(high - low) + CLOSE * size)
        found, cosine = self._tree.crossings_and_cosines(lines[which])
        gap = np.where(found.line[1:] == found.line[:-1], np.diff(found.t), np.inf)
        unclear = np.concatenate([found.line[np.abs(cosine) < GRAZING], found.line[1:][gap <= CLOSE * size]])
        line = which[found.line]
        return Ends(line, found.t, found.sign, np.zeros(0, dtype=np.int64), which[unclear])

    def faces(self) -> list[tuple[np.ndarray, np.ndarray]]:
        corners = self.mesh.vertices[self.mesh.triangles]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(normals, axis=1)
        longest = np.square(corners - np.roll(corners, 1, axis=1)).sum(2).max(1)
        # A sliver's normal says nothing; its neighbours have the plane.
        sound = area > 1e-6 * longest
        normals = normals[sound] / area[sound, None]
        planes = np.column_stack([normals, np.einsum("ij,ij->i", normals, corners[sound, 0])])
        return list(zip(planes, corners[sound]))


def mesh_of(solid: manifold3d.Manifold) -> Mesh:
    """The triangles of a solid by the vertices that manifold3d holds, in double precision."""
    if solid.is_empty():
        return Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    raw = solid.to_mesh64()
    merged = np.arange(len(raw.vert_properties))
    merged[np.array(raw.merge_from_vert, dtype=np.int64)] = np.array(raw.merge_to_vert, dtype=np.int64)
    triangles = merged[np.array(raw.tri_verts, dtype=np.int64).reshape(-1, 3)]
    return Mesh(np.array(raw.vert_properties, dtype=float).reshape(len(merged), -1)[:, :3], triangles)


def manifold_of(mesh: Mesh) -> manifold3d.Manifold:
    """The mesh by its indices. Raises `ArithmeticError` where manifold3d does not take it."""
    triangles = np.ascontiguousarray(mesh.triangles, dtype=np.uint64)
    solid = manifold3d.Manifold(manifold3d.Mesh64(np.ascontiguousarray(mesh.vertices), triangles))
    if solid.status() != manifold3d.Error.NoError:
        raise ArithmeticError(f"manifold3d refuses the mesh: {solid.status().name}")
    return solid


def hull_of(points: np.ndarray) -> ConvexHull | None:
    """The convex hull by Qhull, faces in one plane as one; nothing where the points lie in a plane.

    manifold3d's own loses corners where many points lie in one face (2e-7 of the volume of a box with rounded edges); of
    corners alone it makes no mistake.
    """
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    flat = _FLAT * hull.area * float(np.ptp(points, axis=0).max())
    return hull if hull.volume > flat else None


_MANY = 1500
"""Planes beyond which a mesh is looked at by its tree of triangles."""


def _distinct(planes: np.ndarray) -> np.ndarray:
    """The planes without those that only rounding tells from an earlier one: two planes at one end look like an edge."""
    if len(planes) > _MANY:
        return planes
    scale = np.array([1.0, 1.0, 1.0, 1.0 + np.abs(planes[:, 3]).max(initial=0.0)])
    near = (np.abs(planes[:, None] - planes) <= _FLAT * scale).all(2)
    return planes[~np.tril(near, -1).any(1)]


def _no_ends(begins: np.ndarray | None = None) -> Ends:
    none = np.zeros(0, dtype=np.int64)
    return Ends(none, np.zeros(0), none, none if begins is None else begins, none)


def _joined(parts: list[Ends]) -> Ends:
    if len(parts) == 1:
        return parts[0]
    if not parts:
        return _no_ends()
    return Ends(
        *(np.concatenate([getattr(p, name) for p in parts]) for name in ("line", "t", "sign", "begins", "unclear"))
    )
