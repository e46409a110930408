"""Closed meshes of torus, extrusion and revolution, from loops with the solid on their left."""

import math

import manifold3d
import numpy as np

from ..angles import circle, cosine, sine
from ..mesh import Mesh

Loops = list[np.ndarray]
"""Closed polygons `(n, 2)`, outer ones counter-clockwise and holes clockwise, that cross neither themselves nor others."""

_EQUAL = 1e-9
"""Relative difference up to which two diagonals are equally long."""


class _Builder:
    """Collects points and triangles; points that are named by the same key are one."""

    def __init__(self):
        self.points: list = []
        self.triangles: list = []
        self.numbers: dict = {}

    def point(self, key, position) -> int:
        if key not in self.numbers:
            self.numbers[key] = len(self.points)
            self.points.append(position)
        return self.numbers[key]

    def triangle(self, a: int, b: int, c: int) -> None:
        if len({a, b, c}) == 3:
            self.triangles.append([a, b, c])

    def mesh(self) -> Mesh:
        mesh = Mesh(
            np.array(self.points, dtype=float).reshape(-1, 3), np.array(self.triangles, dtype=np.int64).reshape(-1, 3)
        )
        return mesh if mesh.volume() >= 0 else Mesh(mesh.vertices, mesh.triangles[:, ::-1])


def _flat(loops: Loops) -> list[tuple[int, int]]:
    """Loop and number within it of each corner, in the order in which the triangulation counts."""
    return [(i, k) for i, loop in enumerate(loops) for k in range(len(loop))]


def extrude(loops: Loops, bottom: float, height: float, twist: float, scale: tuple[float, float], layers: int) -> Mesh:
    """Along z from `bottom`, turned clockwise by `twist` degrees and scaled on the way."""
    build = _Builder()

    def number(loop: int, corner: int, layer: int) -> int:
        part = layer / layers
        x, y = loops[loop][corner]
        sx, sy = (1.0 + (s - 1.0) * part for s in scale)
        c, s = cosine(-twist * part), sine(-twist * part)
        # A scale of 0 brings points together.
        x, y = x * sx, y * sy
        own = (x, y) if 0.0 in (sx, sy) else (loop, corner)
        return build.point((layer, own), [c * x - s * y, s * x + c * y, bottom + height * part])

    for i, loop in enumerate(loops):
        for k in range(len(loop)):
            for layer in range(layers):
                corners = [(i, k), (i, (k + 1) % len(loop))]
                a, b = (number(*corner, layer) for corner in corners)
                c, d = (number(*corner, layer + 1) for corner in corners)
                _side(build, a, b, c, d)
    corners = _flat(loops)
    for one in manifold3d.triangulate(loops).tolist():
        low = [number(*corners[k], 0) for k in one]
        high = [number(*corners[k], layers) for k in one]
        build.triangle(*low[::-1])
        build.triangle(*high)
    return build.mesh()


def _side(build: _Builder, a: int, b: int, c: int, d: int) -> None:
    """The side from the lower edge `a b` to the upper `c d`, cut along its shorter diagonal."""
    points = [np.array(build.points[k]) for k in (a, b, c, d)]
    rising, falling = np.linalg.norm(points[3] - points[0]), np.linalg.norm(points[1] - points[2])
    if rising <= falling * (1.0 + _EQUAL):
        build.triangle(a, b, d)
        build.triangle(a, d, c)
    else:
        build.triangle(a, b, c)
        build.triangle(b, d, c)


def revolve(loops: Loops, angle: float, segments: int) -> Mesh:
    """About z from the x–z plane, counter-clockwise seen from above; `segments` for this angle."""
    build = _Builder()
    whole = abs(angle) == 360.0
    steps = segments if whole else segments + 1
    turns = [(cosine(angle * j / segments), sine(angle * j / segments)) for j in range(steps)]

    def number(loop: int, corner: int, step: int, side: int) -> int:
        r, z = loops[loop][corner]
        step %= steps
        if r == 0.0:
            # Where a whole turn meets the axis in one point, the sides above and below it are two surfaces.
            return build.point((loop, corner, side if whole else 0), [0.0, 0.0, z])
        c, s = turns[step]
        return build.point((loop, corner, "at", step), [r * c, r * s, z])

    for i, loop in enumerate(loops):
        for k in range(len(loop)):
            following = (k + 1) % len(loop)
            if loop[k][0] == 0.0 and loop[following][0] == 0.0:
                continue
            for j in range(segments):
                a, b = number(i, k, j, 1), number(i, following, j, 0)
                d, c = number(i, k, j + 1, 1), number(i, following, j + 1, 0)
                build.triangle(a, b, c)
                build.triangle(a, c, d)
    if not whole:
        corners = _flat(loops)
        for one in manifold3d.triangulate(loops).tolist():
            # A turn backwards is mirrored; `mesh` sees to the orientation of all together.
            build.triangle(*(number(*corners[k], 0, 0) for k in one[::-1]))
            build.triangle(*(number(*corners[k], segments, 0) for k in one))
    return build.mesh()


def revolve_segments(segments: int, angle: float) -> int:
    """How many of a whole turn's segments an angle takes."""
    return math.ceil(segments * abs(angle) / 360.0)


def torus(radius: float, tube: float, segments: int, tube_segments: int) -> Mesh:
    """A circle about `(radius, 0)`, revolved."""
    profile = np.array([[radius + x, y] for x, y in circle(tube, tube_segments)])
    return revolve([profile], 360.0, segments)
