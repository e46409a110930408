"""Bullet takes the file as it is, with an object for each cell."""

from dataclasses import dataclass

import numpy as np
import pybullet
from scipy.spatial import ConvexHull

from .bodies import Body
from .decompositions import INPUTS
from .entrant import planecut
from .setting import Setting

_INPUT, _CELLS = "lego", 10
_RAYS = 20_000
_SCALE = 100.0
"""Bullet puts a margin of a thousandth of a unit around each shape."""
NEAR = 1e-4
"""Part of the diameter by which cells are made smaller and larger."""


@dataclass(frozen=True)
class BulletRays:
    """The cells in the file, Bullet's convex shapes, and the rays that hit one.

    `amiss`: rays that Bullet does not stop between where they hit the cells made larger and made smaller.
    """

    cells: int
    shapes: int
    rays: int
    hits: int
    amiss: int


def measure_bullet(setting: Setting) -> BulletRays:
    """The file as one shape, and random rays through it."""
    run = planecut(setting.binary, setting.data / INPUTS[_INPUT], setting.scratch, "--max-cells", str(_CELLS))
    corners = np.concatenate([body.corners for body in run.bodies])
    diameter = float(np.linalg.norm(np.ptp(corners, axis=0)))
    begins, ends = _rays((corners.min(axis=0) + corners.max(axis=0)) / 2.0, diameter / 2.0)
    shapes, parts = _bullet(str(setting.scratch / "cells.obj"), begins, ends)
    first = _entries(run.bodies, begins, ends, NEAR * diameter)
    last = _entries(run.bodies, begins, ends, -NEAR * diameter)
    amiss = int(((parts < first) | (parts > last)).sum())
    found = BulletRays(len(run.bodies), shapes, _RAYS, int(np.isfinite(parts).sum()), amiss)
    print(found, flush=True)
    return found


def _rays(middle: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Begins and ends, all on a sphere."""
    ways = np.random.default_rng(1).normal(size=(2, _RAYS, 3))
    begins, ends = middle + radius * ways / np.linalg.norm(ways, axis=2, keepdims=True)
    return begins, ends


def _bullet(file: str, begins: np.ndarray, ends: np.ndarray) -> tuple[int, np.ndarray]:
    """The number of convex shapes, and at which part of its length each ray is stopped, infinity where it is not."""
    client = pybullet.connect(pybullet.DIRECT)
    shape = pybullet.createCollisionShape(pybullet.GEOM_MESH, fileName=file, meshScale=[_SCALE] * 3)
    body = pybullet.createMultiBody(0, shape)
    shapes = len(pybullet.getCollisionShapeData(body, -1))
    hits = []
    # A batch has to be smaller than this.
    most = pybullet.MAX_RAY_INTERSECTION_BATCH_SIZE - 1
    for at in range(0, len(begins), most):
        batch = slice(at, at + most)
        hits += pybullet.rayTestBatch((_SCALE * begins[batch]).tolist(), (_SCALE * ends[batch]).tolist())
    pybullet.disconnect(client)
    return shapes, np.array([part if body >= 0 else np.inf for body, _, part, _, _ in hits])


def _entries(bodies: list[Body], begins: np.ndarray, ends: np.ndarray, larger: float) -> np.ndarray:
    """The same by the planes of the cells, each moved outwards by a distance."""
    least = np.full(len(begins), np.inf)
    for body in bodies:
        planes = ConvexHull(body.corners).equations
        before, after = (points @ planes[:, :3].T + planes[:, 3] - larger for points in (begins, ends))
        enters, leaves = (before > 0.0) & (after <= 0.0), (before <= 0.0) & (after > 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            parts = before / (before - after)
        first = np.where(enters, parts, 0.0).max(axis=1)
        last = np.where(leaves, parts, 1.0).min(axis=1)
        never = ((before > 0.0) & (after > 0.0)).any(axis=1) | (first > last)
        least = np.minimum(least, np.where(never, np.inf, first))
    return least
