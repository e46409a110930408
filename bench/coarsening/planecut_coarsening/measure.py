"""How far hulls are from what they stand for."""

from dataclasses import dataclass, replace

import numpy as np
from manifold3d import Manifold, OpType
from scipy.spatial import ConvexHull, QhullError, cKDTree

from .bodies import Body
from .meshes import boundary, surface_points

ON_THE_PLANE = 1e-12
"""Part of the diameter by which a point may lie beyond a plane and still count as inside."""


_ON_REFERENCE = 200_000
_ON_HULLS = 20_000
"""Random points on both surfaces between which distances are measured."""


@dataclass(frozen=True)
class Reference:
    """A solid that hulls shall cover: its volume, the corners of its surface, their diameter, and points on its surface."""

    solid: Manifold
    corners: np.ndarray
    volume: float
    diameter: float
    surface: cKDTree | None = None

    @classmethod
    def of(cls, solid: Manifold, bodies: list[Body]) -> "Reference":
        """That of the solid, with the corners of the bodies that it was made of."""
        corners = np.concatenate([body.corners for body in bodies])
        diameter = float(np.linalg.norm(np.ptp(corners, axis=0)))
        return cls(solid, corners, solid.volume(), diameter)

    @classmethod
    def of_mesh(cls, mesh: Body) -> "Reference":
        """That of a closed mesh, to whose surface distances are measured. Raises `ValueError` where it is not closed."""
        found = cls.of(mesh.solid(), [mesh])
        return replace(found, surface=cKDTree(surface_points(mesh, _ON_REFERENCE)))


@dataclass(frozen=True)
class Measure:
    """Hulls against a reference: all volumes are parts of its volume, `farthest` is a part of its diameter.

    `union_excess`, `sum_excess`: volume of the hulls' union, and sum of their volumes, less the reference's. `missing`:
    volume of the reference in no hull. `outside`: corners of the reference in no hull, `farthest` the one farthest off.
    `flat`: hulls without an inside. `hausdorff`: how far the farthest point of the union's surface is from that of the reference, a part of its diameter, by
    random points; `None` where that was not asked for.
    """

    cells: int
    flat: int
    corners: int
    union_excess: float
    sum_excess: float
    missing: float
    outside: int
    farthest: float
    hausdorff: float | None = None


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
        hausdorff=_hausdorff(whole, reference),
    )


def union(solids: list[Manifold]) -> Manifold:
    """All of them as one."""
    return Manifold.batch_boolean(solids, OpType.Add)


def _hausdorff(whole: Manifold, reference: Reference) -> float | None:
    if reference.surface is None:
        return None
    distances, _ = reference.surface.query(surface_points(boundary(whole), _ON_HULLS))
    return float(distances.max()) / reference.diameter


def _beyond(bodies: list[Body], points: np.ndarray) -> np.ndarray:
    """How far each point lies beyond the planes of the hull that it is the least beyond of; negative inside.

    The planes are Qhull's: those of the written triangles would be noise where a triangle is a sliver.
    """
    least = np.full(len(points), np.inf)
    for body in bodies:
        try:
            # from a corner: of a cell whose faces were bent by 1e-11, a long way from the origin for that, Qhull made facets without end
            origin = body.corners[0]
            planes = ConvexHull(body.corners - origin).equations
        except QhullError:
            # It is flat but for rounding: it holds nothing.
            continue
        least = np.minimum(least, ((points - origin) @ planes[:, :3].T + planes[:, 3]).max(axis=1))
    return least
