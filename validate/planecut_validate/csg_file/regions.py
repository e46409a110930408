"""Sets of the plane as closed loops, by the library that OpenSCAD uses for them (Clipper).

Clipper counts in whole numbers. OpenSCAD 2021.01 has 65536 of them per unit, and throws away corners that lie within a
thousandth of a unit of the line through their neighbours; `Grid(openscad=True)` does the same. Otherwise the grid is so fine
that its rounding is that of double precision, and nothing is thrown away.
"""

import math
from dataclasses import dataclass

import numpy as np
import pyclipper

from .fragments import Resolution, unit_circle

_OPENSCAD = 65536.0
_CLEANING = 0.001
_BITS = 48
"""Bits of the largest whole number on the fine grid."""
_SLIT = 1e-9
"""Width of a slit, relative to the largest coordinate, that a mesh makes by its rounding."""
_KINDS = {
    "union": pyclipper.CT_UNION,
    "intersection": pyclipper.CT_INTERSECTION,
    "difference": pyclipper.CT_DIFFERENCE,
}
Loops = list[np.ndarray]
"""Closed loops `(n, 2)`; outer ones counter-clockwise, holes clockwise, unless it says even-odd."""


@dataclass(frozen=True)
class Grid:
    """Set operations on regions of the plane."""

    openscad: bool = False

    def combine(self, kind: str, operands: list[Loops]) -> Loops:
        """Union or intersection of all, or what the others leave of the first."""
        scale = self._scale([loop for loops in operands for loop in loops])
        paths = [_rounded(loops, scale) for loops in operands]
        if kind != "intersection":
            return self._loops(_clip(_KINDS[kind], paths[0], [p for path in paths[1:] for p in path]), scale)
        found = paths[0]
        for path in paths[1:]:
            found = _clip(_KINDS[kind], found, path)
        return self._loops(found, scale)

    def sanitized(self, loops: Loops) -> Loops:
        """The even-odd region of the loops, whatever way they go around."""
        scale = self._scale(loops)
        return self._loops(_clip(pyclipper.CT_UNION, _rounded(loops, scale), [], pyclipper.PFT_EVENODD), scale)

    def offset(self, loops: Loops, by: float, join: str, resolution: Resolution) -> Loops:
        """The region grown, or shrunk where `by` is negative; `join`: `round`, `miter` or `square`."""
        if not loops:
            return []
        scale = self._scale([*loops, np.array([[2.0 * by, 2.0 * by]])])
        steps = resolution.fragments(abs(by))
        tolerance = abs(by) * (1.0 - unit_circle(2 * steps)[1][0]) * scale
        clipper = pyclipper.PyclipperOffset(_MITER_LIMIT, tolerance)
        for path in _rounded(loops, scale):
            clipper.AddPath(path, _JOINS[join], pyclipper.ET_CLOSEDPOLYGON)
        return self._loops(clipper.Execute(by * scale), scale)

    def minkowski(self, first: Loops, second: Loops) -> Loops:
        """The sum of two regions: the sums of their edges, and each beside a point of each outer loop of the other."""
        if not first or not second:
            return []
        scale = self._scale([np.concatenate(first) * 2.0, np.concatenate(second) * 2.0])
        a, b = _rounded(first, scale), _rounded(second, scale)
        pieces = [piece for p in a for q in b for piece in _swept(p, q)]
        for inner, outer in ((a, b), (b, a)):
            starts = [np.array(path[0]) for path in outer if pyclipper.Orientation(path)]
            pieces += [(np.array(path) + start).tolist() for path in inner for start in starts]
        return self._loops(_clip(pyclipper.CT_UNION, pieces, []), scale)

    def shadow(self, triangles: np.ndarray) -> Loops:
        """The union of triangles `(n, 3, 2)`, whatever way they go around."""
        if not len(triangles):
            return []
        a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
        turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        upward = np.where((turn > 0.0)[:, None, None], triangles, triangles[:, ::-1])[turn != 0.0]
        return self.tidied(self.combine("union", [list(upward)]))

    def tidied(self, loops: Loops) -> Loops:
        """The region without slits and spikes that only the rounding of a mesh has made."""
        scale = self._scale(loops)
        width = _SLIT * scale * max((float(np.abs(loop).max()) for loop in loops), default=0.0)
        paths = [pyclipper.CleanPolygon(path, width) for path in _rounded(loops, scale)]
        return [np.array(path, dtype=float) / scale for path in paths if len(path) > 2]

    def _scale(self, loops: Loops) -> float:
        if self.openscad:
            return _OPENSCAD
        largest = max((float(np.abs(loop).max(initial=0.0)) for loop in loops), default=0.0)
        # In steps of eight bits, so that a result lies on the grid of the next operation as well, most times.
        exponent = math.frexp(largest)[1]
        return 2.0 ** (_BITS - 8 * math.ceil(exponent / 8))

    def _loops(self, paths: list, scale: float) -> Loops:
        if self.openscad:
            paths = [pyclipper.CleanPolygon(path, _CLEANING * scale) for path in paths]
        return [np.array(path, dtype=float) / scale for path in paths if len(path) > 2]


_MITER_LIMIT = 1e6
_JOINS = {"round": pyclipper.JT_ROUND, "miter": pyclipper.JT_MITER, "square": pyclipper.JT_SQUARE}


def _rounded(loops: Loops, scale: float) -> list:
    """Whole numbers; the library of OpenSCAD cuts their fractions off."""
    cut = np.trunc if scale == _OPENSCAD else np.rint
    return [cut(loop * scale).astype(np.int64).tolist() for loop in loops if len(loop) > 2]


def _clip(kind: int, subjects: list, clips: list, fill: int = pyclipper.PFT_NONZERO) -> list:
    clipper = pyclipper.Pyclipper()
    for role, paths in ((pyclipper.PT_SUBJECT, subjects), (pyclipper.PT_CLIP, clips)):
        for path in paths:
            try:
                clipper.AddPath(path, role, True)
            except pyclipper.ClipperException:
                pass  # A loop without any area.
    try:
        return clipper.Execute(kind, fill, fill)
    except pyclipper.ClipperException:
        return []


def _swept(path: list, along: list) -> list:
    """Each edge of the one moved along each edge of the other, counter-clockwise."""
    a, b = np.array(path), np.array(along)
    corners = b[:, None] + a
    right, up = np.roll(corners, -1, axis=0), np.roll(corners, -1, axis=1)
    quads = np.stack([corners, right, np.roll(right, -1, axis=1), up], axis=2).reshape(-1, 4, 2)
    return [quad if pyclipper.Orientation(quad) else quad[::-1] for quad in quads.tolist()]


def transformed(grid: Grid, loops: Loops, matrix: np.ndarray) -> Loops:
    """The loops under a matrix of 2 rows of 3."""
    moved = [loop @ matrix[:, :2].T + matrix[:, 2] for loop in loops]
    if np.linalg.det(matrix[:, :2]) <= 0.0:
        return grid.sanitized(moved)
    return moved


def hull(loops: Loops) -> Loops:
    """The convex hull of all corners, counter-clockwise (monotone chain)."""
    points = np.unique(np.concatenate([np.zeros((0, 2)), *loops]), axis=0).tolist()
    if len(points) < 3:
        return []
    chains = []
    for run in (points, points[::-1]):
        chain: list = []
        for p in run:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 0.0:
                chain.pop()
            chain.append(p)
        chains.append(chain[:-1])
    found = np.array(chains[0] + chains[1])
    return [found] if len(found) > 2 else []


def _turn(a, b, c) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def is_convex(loops: Loops) -> bool:
    """Whether the region is one convex polygon."""
    if len(loops) != 1:
        return False
    along = np.roll(loops[0], -1, axis=0) - loops[0]
    after = np.roll(along, -1, axis=0)
    turns = along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0]
    around = np.arctan2(turns, (along * after).sum(1)).sum()
    return bool((turns >= 0.0).all() and around < 7.0)


def area(loops: Loops) -> float:
    """The area, holes taken away."""
    return sum(0.5 * float((p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)).sum()) for p in loops)
