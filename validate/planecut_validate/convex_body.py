"""The vertices of a convex body from its half-spaces: floating point proposes, integers decide."""

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from .map_file import IntPlane, cross

_NEAR = 1e-6
"""Relative to the size of the body: how far off a proposed vertex may lie. Too large costs time, never a wrong vertex."""
_PARALLEL = 1e-12
"""Sine below which two planes, or a line and a plane, do not meet; the planes of a line itself come out as 1e-16."""


@dataclass(frozen=True)
class ConvexBody:
    """An intersection of half-spaces.

    `planes`: `(m, 4)` unit normals and offsets, `n·x ≤ d`. `vertices`: `(v, 3)`, each the exact one rounded once; empty
    where there is none. `bounded`: whether no ray stays inside. `redundant`: half-spaces that carry no face.
    """

    planes: np.ndarray
    vertices: np.ndarray
    bounded: bool
    redundant: int


def convex_body(planes: list[IntPlane]) -> ConvexBody:
    """The body of all points within every half-space."""
    planes = list(dict.fromkeys(planes))
    unit = np.array([_unit(p) for p in planes]).reshape(-1, 4)
    on_plane = [0] * len(planes)
    vertices = set()
    for triple in _proposed_triples(unit):
        point = _meeting_point(*(planes[i] for i in triple))
        if point is None:
            continue
        slacks = [_slack(p, point) for p in planes]
        if max(slacks) > 0:
            continue
        vertex = tuple(c / point[3] for c in point[:3])
        if vertex not in vertices:
            vertices.add(vertex)
            for i, slack in enumerate(slacks):
                on_plane[i] += slack == 0
    return ConvexBody(
        planes=unit,
        vertices=np.array(sorted(vertices), dtype=float).reshape(-1, 3),
        bounded=bool(vertices) and not _has_ray(planes, unit),
        redundant=sum(count < 3 for count in on_plane),
    )


def exact_plane(row: list[float]) -> IntPlane:
    """The half-space of four doubles, as they are, in integers."""
    exact = [Fraction(value) for value in row]
    scale = math.lcm(*(value.denominator for value in exact))
    plane = [int(value * scale) for value in exact]
    factor = math.gcd(*plane)
    return tuple(value // factor for value in plane)


def _unit(plane: IntPlane) -> list[float]:
    length = math.isqrt(sum(c * c for c in plane[:3]) << 128) / (1 << 64)
    return [c / length for c in plane]


def _meeting_point(a: IntPlane, b: IntPlane, c: IntPlane) -> tuple[int, int, int, int] | None:
    """The exact homogeneous point on three planes, with a positive last coordinate; nothing where they have no one."""
    bc, ca, ab = cross(b[:3], c[:3]), cross(c[:3], a[:3]), cross(a[:3], b[:3])
    weight = sum(n * m for n, m in zip(a[:3], bc))
    if weight == 0:
        return None
    point = [a[3] * u + b[3] * v + c[3] * w for u, v, w in zip(bc, ca, ab)]
    sign = 1 if weight > 0 else -1
    return tuple(sign * x for x in (*point, weight))


def _slack(plane: IntPlane, point: tuple[int, int, int, int]) -> int:
    """Positive where the point lies outside."""
    return sum(n * x for n, x in zip(plane[:3], point[:3])) - plane[3] * point[3]


def _proposed_triples(unit: np.ndarray) -> list[tuple[int, int, int]]:
    """Plane triples that may meet in a vertex: ends of the clipped lines in which two planes meet."""
    near = _NEAR * (1.0 + np.abs(unit[:, 3]).max(initial=0.0))
    triples = set()
    for first, second, direction in _pair_lines(unit):
        origin = _point_on_lines(unit, first, second, direction)
        rate = direction @ unit[:, :3].T
        room = unit[:, 3] - origin @ unit[:, :3].T
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = room / rate
        lower = np.where(rate < -_PARALLEL, reach, -np.inf).max(1)
        upper = np.where(rate > _PARALLEL, reach, np.inf).min(1)
        for end in (lower, upper):
            at_end = room - np.where(np.isfinite(end), end, 0.0)[:, None] * rate
            inside = np.isfinite(end) & (at_end >= -near).all(1)
            line, third = np.nonzero(inside[:, None] & (at_end <= near))
            for i, j, k in zip(first[line].tolist(), second[line].tolist(), third.tolist()):
                if k not in (i, j):
                    triples.add(tuple(sorted((i, j, k))))
    return sorted(triples)


def _pair_lines(unit: np.ndarray, chunk: int = 4096):
    """Pairs of planes that are not parallel and the unit directions of their lines, in portions."""
    all_first, all_second = np.triu_indices(len(unit), 1)
    for at in range(0, len(all_first), chunk):
        first, second = all_first[at : at + chunk], all_second[at : at + chunk]
        direction = np.cross(unit[first, :3], unit[second, :3])
        length = np.linalg.norm(direction, axis=1)
        keep = length > _PARALLEL
        yield first[keep], second[keep], direction[keep] / length[keep, None]


def _point_on_lines(unit: np.ndarray, first: np.ndarray, second: np.ndarray, direction: np.ndarray) -> np.ndarray:
    a, b = unit[first], unit[second]
    sine = np.linalg.norm(np.cross(a[:, :3], b[:, :3]), axis=1)
    across = a[:, 3:] * np.cross(b[:, :3], direction) + b[:, 3:] * np.cross(direction, a[:, :3])
    return across / sine[:, None]


def _has_ray(planes: list[IntPlane], unit: np.ndarray) -> bool:
    """Whether some direction leaves no half-space. A body with a vertex has an extreme ray on two planes then."""
    for first, second, direction in _pair_lines(unit):
        rate = direction @ unit[:, :3].T
        for sign in (1, -1):
            for pair in np.nonzero((sign * rate <= _NEAR).all(1))[0]:
                ray = cross(planes[first[pair]][:3], planes[second[pair]][:3])
                if all(sign * sum(n * r for n, r in zip(p[:3], ray)) <= 0 for p in planes):
                    return True
    return False
