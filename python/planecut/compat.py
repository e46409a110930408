"""Functions with the names and results of other packages, to be put in their place."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._planecut import Mesh, PlanecutError, coarsen

__all__ = ["run_coacd"]

_MOST_OF_A_SHELL = 32
"""Maximum number of cells around a mesh that bounds no solid, where none is given: what a threshold is relative to is no volume then."""


def run_coacd(
    vertices: ArrayLike | Any,
    triangles: ArrayLike | None = None,
    threshold: float = 0.05,
    max_convex_hull: int = -1,
    **ignored: Any,
) -> list[tuple[NDArray[np.float64], NDArray[np.int32]]]:
    """Convex hulls that enclose a mesh, as `coacd.run_coacd` gives them.

    The hulls hold all of the mesh, where those of CoACD may leave some of it out. They overlap a little.

    Args:
        vertices: Shape (n, 3); or an object with `vertices` and `indices`, as `coacd.Mesh`.
        triangles: Shape (m, 3), numbers of vertices.
        threshold: Maximum volume added, relative to that of the mesh, where CoACD limits a distance.
        max_convex_hull: Maximum number of hulls, which takes precedence; -1 for no limit.
        ignored: Other settings of CoACD; a warning says that they are ignored.

    Returns:
        A list of vertices, shape (k, 3), and triangles, shape (l, 3), for each hull.
    """
    if ignored:
        names = ", ".join(sorted(ignored))
        warnings.warn(f"planecut ignores settings that are CoACD's alone: {names}", stacklevel=2)
    if triangles is None:
        if not (hasattr(vertices, "vertices") and hasattr(vertices, "indices")):
            raise PlanecutError(f"vertices: found {type(vertices)}, expected an array, or an object with vertices and indices")
        vertices, triangles = vertices.vertices, vertices.indices
    mesh = Mesh(vertices, triangles)
    most = max_convex_hull if max_convex_hull > 0 else None
    hulls = None
    if most is None or most > 1:
        hulls = coarsen(mesh, max_excess=threshold) if mesh.is_watertight else None
    if hulls is None or (most is not None and len(hulls) > most):
        hulls = coarsen(mesh, max_cells=_MOST_OF_A_SHELL if most is None else most)
    return [(cell.vertices.copy(), cell.triangles.astype(np.int32)) for cell in hulls.cells]
