"""How far hulls are from what they stand for."""

from dataclasses import dataclass

import numpy as np
from manifold3d import Manifold, OpType
from scipy.spatial import ConvexHull

from .bodies import Body

ON_THE_PLANE = 1e-12
"""Part of the diameter by which a point may lie beyond a plane and still count as inside."""


@dataclass(frozen=True)
class Reference:
    """A solid that hulls shall cover: its volume, the corners of its surface and their diameter."""

    solid: Manifold
    corners: np.ndarray
    volume: float
    diameter: float

    @classmethod
    def of(cls, solid: Manifold, bodies: list[Body]) -> "Reference":
        """That of the solid, with the corners of the bodies that it was made of."""
        corners = np.concatenate([body.corners for body in bodies])
        diameter = float(np.linalg.norm(np.ptp(corners, axis=0)))
        return cls(solid, corners, solid.volume(), diameter)


@dataclass(frozen=True)
class Measure:
    """Hulls against a reference: all volumes are parts of its volume, `farthest` is a part of its diameter.

    `union_excess`, `sum_excess`: volume of the hulls' union, and sum of their volumes, less the reference's. `missing`:
    volume of the reference in no hull. `outside`: corners of the reference in no hull, `farthest` the one farthest off.
    `flat`: hulls without an inside.
    """

    cells: int
    flat: int
    corners: int
    union_excess: float
    sum_excess: float
    missing: float
    outside: int
    farthest: float


def measure(bodies: list[Body], reference: Reference) -> Measure:
    """The hulls of the bodies against the reference."""
    hulls = [body.hull() for body in bodies]
    whole = union(hulls)
    full = [body for body, hull in zip(bodies, hulls) if hull.volume() > 0.0]
    beyond = _beyond(full, reference.corners) / reference.diameter
    return Measure(
        cells=len(bodies),
        flat=len(bodies) - len(full),
        corners=sum(len(body.corners) for body in bodies),
        union_excess=whole.volume() / reference.volume - 1.0,
        sum_excess=sum(hull.volume() for hull in hulls) / reference.volume - 1.0,
        missing=(reference.solid - whole).volume() / reference.volume,
        outside=int((beyond > ON_THE_PLANE).sum()),
        farthest=float(max(beyond.max(), 0.0)),
    )


def union(solids: list[Manifold]) -> Manifold:
    """All of them as one."""
    return Manifold.batch_boolean(solids, OpType.Add)


def _beyond(bodies: list[Body], points: np.ndarray) -> np.ndarray:
    """How far each point lies beyond the planes of the hull that it is the least beyond of; negative inside.

    The planes are Qhull's: those of the written triangles would be noise where a triangle is a sliver.
    """
    least = np.full(len(points), np.inf)
    for body in bodies:
        planes = ConvexHull(body.corners).equations
        least = np.minimum(least, (points @ planes[:, :3].T + planes[:, 3]).max(axis=1))
    return least
