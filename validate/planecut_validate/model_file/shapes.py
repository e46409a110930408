"""Points whose convex hull is a primitive."""

import math

import numpy as np

from ..angles import circle, cosine, sine
from .scope import Scope
from .text import check_keys, fail


def _ring(radius: float, segments: int, z: float) -> list[list[float]]:
    """A circle at a height; one point where the radius is 0."""
    if radius == 0.0:
        return [[0.0, 0.0, z]]
    return [[x, y, z] for x, y in circle(radius, segments)]


def box(value, path: str, scope: Scope) -> list:
    check_keys(value, path, {"min", "max"})
    low, high = (scope.numbers(value.get(key), f"{path}.{key}", 3) for key in ("min", "max"))
    if not all(a < b for a, b in zip(low, high)):
        fail(path, "a minimum below the maximum")
    return [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]


def _sphere_points(radius: float, segments: int, z: float = 0.0) -> list:
    rings = (segments + 1) // 2
    angles = [180.0 * (i + 0.5) / rings for i in range(rings)]
    return [p for a in angles for p in _ring(radius * sine(a), segments, z + radius * cosine(a))]


def sphere(value, path: str, scope: Scope) -> list:
    check_keys(value, path, {"radius", "segments"})
    return _sphere_points(scope.positive(value.get("radius"), f"{path}.radius"), scope.segments(value, path))


def capsule(value, path: str, scope: Scope) -> list:
    check_keys(value, path, {"height", "radius", "segments"})
    radius = scope.positive(value.get("radius"), f"{path}.radius")
    height = scope.positive(value.get("height"), f"{path}.height")
    segments = scope.segments(value, path)
    return _sphere_points(radius, segments) + _sphere_points(radius, segments, height)


def cylinder(value, path: str, scope: Scope) -> list:
    check_keys(value, path, {"height", "radius", "top_radius", "segments"})
    height = scope.positive(value.get("height"), f"{path}.height")
    radius = scope.positive(value.get("radius"), f"{path}.radius", zero=True)
    top = scope.positive(value.get("top_radius", radius), f"{path}.top_radius", zero=True)
    if radius == top == 0.0:
        fail(path, "a radius above 0")
    segments = scope.segments(value, path)
    return _ring(radius, segments, 0.0) + _ring(top, segments, height)


def _tapered(tip: bool, count: str):
    """A regular polygon with a tip above it, or with itself."""

    def points(value, path: str, scope: Scope) -> list:
        check_keys(value, path, {"height", "radius", count})
        height = scope.positive(value.get("height"), f"{path}.height")
        radius = scope.positive(value.get("radius"), f"{path}.radius")
        given = {count: 32} | value if count == "segments" else value
        sides = scope.whole(given.get(count), f"{path}.{count}", 3, 10_000)
        return _ring(radius, sides, 0.0) + _ring(0.0 if tip else radius, sides, height)

    return points


def wedge(value, path: str, scope: Scope) -> list:
    check_keys(value, path, {"size"})
    x, y, z = scope.numbers(value.get("size"), f"{path}.size", 3)
    if min(x, y, z) <= 0:
        fail(f"{path}.size", "numbers above 0")
    return [[a, b, c] for b in (0.0, y) for a, c in ((0.0, 0.0), (x, 0.0), (0.0, z))]


_GOLDEN = (1.0 + math.sqrt(5.0)) / 2.0
_CUBE = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def _cyclic(points: list) -> list:
    return [[*p[-k:], *p[:-k]] if k else p for p in points for k in range(3)]


_SOLIDS = {
    "tetrahedron": [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]],
    "cube": _CUBE,
    "octahedron": _cyclic([[1, 0, 0], [-1, 0, 0]]),
    "dodecahedron": _CUBE + _cyclic([[0, s / _GOLDEN, t * _GOLDEN] for s in (-1, 1) for t in (-1, 1)]),
    "icosahedron": _cyclic([[0, s, t * _GOLDEN] for s in (-1, 1) for t in (-1, 1)]),
}


def regular(value, path: str, scope: Scope) -> list:
    check_keys(value, path, {"solid", "radius"})
    if value.get("solid") not in _SOLIDS:
        fail(f"{path}.solid", f"one of {', '.join(_SOLIDS)}")
    points = np.array(_SOLIDS[value["solid"]], dtype=float)
    return (points * (scope.positive(value.get("radius"), f"{path}.radius") / np.linalg.norm(points[0]))).tolist()


def points(value, path: str, scope: Scope) -> list:
    if not isinstance(value, list) or not value:
        fail(path, "one or more points")
    return [scope.numbers(p, f"{path}[{i}]", 3) for i, p in enumerate(value)]


SHAPES = {
    "points": points, "box": box, "sphere": sphere, "cylinder": cylinder, "cone": _tapered(True, "segments"),
    "prism": _tapered(False, "sides"), "pyramid": _tapered(True, "sides"), "wedge": wedge, "capsule": capsule,
    "regular": regular,
}  # fmt: skip
"""Key of a NODE to the points of its body."""
