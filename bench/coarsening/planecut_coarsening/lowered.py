"""Hulls of many faces lowered to a few, beside `pchs` (Jacobson 2026, arXiv 2604.14468): library call against library call."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from .bodies import Body, read_bodies, write_bodies
from .entrant import Failed, library, lowered
from .setting import Setting

FACES = (400, 2000, 100_000)
"""Faces of the hulls: of points on a sphere, all of which are triangles."""
TARGETS = (64, 16)
MESHES = ("ember/99865.stl", "ember/58011.stl", "vhacd/bunny.obj")
"""Meshes whose vertices are taken, as points."""

_REPEATS = 3
"""Runs of which the fastest counts."""


@dataclass(frozen=True)
class Lowered:
    """One result. `added`: volume relative to that of the hull; `outside`: how far the farthest input point is, in diameters.

    `found` is how many faces there are, nothing where there is no result. `seconds` are those of lowering alone, with all that is made ready for it; `seconds_with_hull` with the hull of the points.
    """

    input: str
    faces: int
    asked: int
    entrant: str
    found: int | None
    added: float = math.nan
    outside: float = math.nan
    seconds: float = math.nan
    seconds_with_hull: float = math.nan


def measure_lowered(setting: Setting) -> list[Lowered]:
    """Spheres, spheres made long and flat, and meshes."""
    rows = []
    for name, points in _inputs(setting):
        hull = ConvexHull(points)
        source = setting.scratch / "points.obj"
        write_bodies(source, [Body(points[hull.vertices], _outward(points, hull))])
        faces = len(hull.simplices)
        for target in TARGETS:
            for entrant, run in (("planecut", _planecut), ("pchs", _pchs)):
                try:
                    body, seconds, with_hull = run(setting, source, target)
                except (Failed, ValueError) as error:
                    if entrant == "planecut":
                        setting.fail(f"{name} to {target} faces: {error}")
                    else:
                        print(f"{name} to {target} faces: {entrant} gives up: {error}", flush=True)
                        rows.append(Lowered(name, faces, target, entrant, None))
                    continue
                row = _row(name, faces, target, entrant, points, hull, body, seconds, with_hull)
                print(row, flush=True)
                if entrant == "planecut" and (row.found > target or row.outside > 1e-12):
                    setting.fail(f"{name} to {target} faces: {row.found} faces, {row.outside:.0e} outside")
                rows.append(row)
    return rows


def _inputs(setting: Setting) -> list[tuple[str, np.ndarray]]:
    random = np.random.default_rng(1)
    inputs = []
    for faces in FACES[:2] if setting.quick else FACES:
        # a hull of triangles has twice as many of them as corners, less four
        points = random.normal(size=(faces // 2 + 2, 3))
        points /= np.linalg.norm(points, axis=1)[:, None]
        inputs += [("sphere", points), ("long and flat", points * [10.0, 1.0, 0.3])]
    for mesh in MESHES:
        inputs.append((mesh, _vertices(setting.data / "mesh" / mesh)))
    return inputs


def _vertices(path: Path) -> np.ndarray:
    if path.suffix != ".stl":
        return np.vstack([body.corners for body in read_bodies(path)])
    # binary: 80 bytes of header, a count, and for each triangle a normal, its corners and two bytes
    triangle = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    corners = np.fromfile(path, dtype=triangle, offset=84)["corners"]
    return np.unique(corners.reshape(-1, 3).astype(float), axis=0)


def _planecut(setting: Setting, source: Path, target: int) -> tuple[Body, float, float]:
    runs = [lowered(setting.lower, source, target, setting.scratch) for _ in range(_REPEATS)]
    body, hull, seconds = min(runs, key=lambda run: run[2])
    return body, seconds, seconds + hull


def _pchs(setting: Setting, source: Path, target: int) -> tuple[Body, float, float]:
    runs = [library("pchs", source, setting.scratch, target=target) for _ in range(_REPEATS)]
    run = min(runs, key=lambda run: run.seconds)
    (body,) = run.bodies
    # the hull of the points is its first phase, which it tells
    return body, run.seconds - run.report["hull"], run.seconds


def _row(
    name: str,
    faces: int,
    target: int,
    entrant: str,
    points: np.ndarray,
    before: ConvexHull,
    body: Body,
    seconds: float,
    with_hull: float,
) -> Lowered:
    after = ConvexHull(body.corners)
    planes = np.unique(np.round(after.equations, 9), axis=0)
    reach = (after.equations[:, :3] @ points[before.vertices].T + after.equations[:, 3:]).max()
    diameter = np.linalg.norm(np.ptp(points, axis=0))
    outside = max(0.0, float(reach / diameter))
    added = after.volume / before.volume - 1.0
    return Lowered(name, faces, target, entrant, len(planes), added, outside, seconds, with_hull)


def _outward(points: np.ndarray, hull: ConvexHull) -> np.ndarray:
    """The triangles of a hull, counter-clockwise seen from outside, as numbers of its own corners."""
    triangles = hull.simplices.copy()
    a, b, c = (points[triangles[:, k]] for k in range(3))
    turned = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    triangles[turned] = triangles[turned][:, ::-1]
    numbers = np.empty(len(points), dtype=np.int64)
    numbers[hull.vertices] = np.arange(len(hull.vertices))
    return numbers[triangles]
