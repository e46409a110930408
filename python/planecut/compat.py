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
    *,
    max_ch_vertex: int | None = None,
    seed: int = 0,
    **ignored: Any,
) -> list[tuple[NDArray[np.float64], NDArray[np.int32]]]:
    """Convex hulls that enclose a mesh, as `coacd.run_coacd` gives them.

    The hulls hold all of the mesh, where those of CoACD may leave some of it out. They overlap a little.

    Args:
        vertices: Shape (n, 3); or an object with `vertices` and `indices`, as `coacd.Mesh`: then the arguments behind it are those of `coacd.run_coacd`, `threshold` and `max_convex_hull`.
        triangles: Shape (m, 3), numbers of vertices.
        threshold: Maximum volume added, relative to that of the mesh, where CoACD limits a distance.
        max_convex_hull: Maximum number of hulls, which takes precedence; -1 for no limit.
        max_ch_vertex: Maximum number of vertices of each hull, at least 8.
        seed: Nothing: the same mesh has the same hulls.
        ignored: Other settings of CoACD; a warning says that they are ignored.

    Returns:
        A list of vertices, shape (k, 3), and triangles, shape (l, 3), for each hull.
    """
    if hasattr(vertices, "vertices") and hasattr(vertices, "indices"):
        if triangles is not None:
            # one place further on than where they stand behind two arrays
            if threshold != 0.05:
                max_convex_hull = int(threshold)
            threshold = float(triangles)  # type: ignore[arg-type]
        vertices, triangles = vertices.vertices, vertices.indices
    if triangles is None:
        raise PlanecutError(f"vertices: found {type(vertices)} alone, expected an object with vertices and indices, or both arrays")
    if ignored:
        names = ", ".join(sorted(ignored))
        warnings.warn(f"planecut ignores settings that are CoACD's alone: {names}", stacklevel=2)
    mesh = Mesh(vertices, triangles)
    most = max_convex_hull if max_convex_hull > 0 else None
    hulls = None
    if most != 1 and mesh.is_watertight:
        hulls = coarsen(mesh, max_excess=threshold, max_vertices=max_ch_vertex)
    if hulls is None or (most is not None and len(hulls) > most):
        hulls = coarsen(mesh, max_cells=_MOST_OF_A_SHELL if most is None else most, max_vertices=max_ch_vertex)
    return [(cell.vertices.copy(), cell.triangles.astype(np.int32)) for cell in hulls.cells]
