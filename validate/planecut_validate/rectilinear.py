"""Trees of boxes along the axes: volume and area cell by cell, in a grid through all their sides."""

import numpy as np

from .leaf import ConvexLeaf
from .solid_tree import SolidTree

_MOST = 4_000_000
"""Cells of the grid that are still looked at."""
_LOGIC = {
    "union": lambda values: np.logical_or.reduce(values),
    "intersection": lambda values: np.logical_and.reduce(values),
    "xor": lambda values: np.logical_xor.reduce(values),
    "difference": lambda values: values[0] & ~np.logical_or.reduce(values[1:]) if len(values) > 1 else values[0],
    "complement": lambda values: ~values[0],
}


def measure(tree: SolidTree) -> tuple[float, float] | None:
    """Volume and area of a bounded solid; nothing where a leaf has another side, or there are too many cells."""
    ranges = [_ranges(leaf) for leaf in tree.leaves]
    if not ranges or any(r is None for r in ranges) or any(n == 0 and kind != "leaf" for kind, n in tree.nodes):
        return None
    corners = [np.unique([end for r in ranges for end in r[axis] if np.isfinite(end)]) for axis in range(3)]
    counts = [len(c) - 1 for c in corners]
    if min(counts) < 1 or np.prod(counts) > _MOST:
        return None
    middles = [0.5 * (c[1:] + c[:-1]) for c in corners]

    def cells(number: int) -> np.ndarray:
        x, y, z = ((m > low) & (m < high) for m, (low, high) in zip(middles, ranges[number]))
        return x[:, None, None] & y[None, :, None] & z[None, None, :]

    inside = tree.fold(cells, lambda operation, values: _LOGIC[operation](values))
    sides = [np.diff(c) for c in corners]
    volume = float(np.einsum("ijk,i,j,k->", inside.astype(float), *sides))
    return volume, _area(inside, sides)


def _area(inside: np.ndarray, sides: list[np.ndarray]) -> float:
    """Where inside and outside are neighbours, and where the solid meets the end of the grid."""
    total = 0.0
    for axis in range(3):
        turned = np.moveaxis(np.pad(inside, 1), axis, 0)[:, 1:-1, 1:-1]
        walls = (turned[1:] != turned[:-1]).sum(0)
        u, v = (sides[other] for other in range(3) if other != axis)
        total += float(u @ walls @ v)
    return total


def _ranges(leaf) -> list[tuple[float, float]] | None:
    """Lowest and highest coordinate on each axis."""
    if not isinstance(leaf, ConvexLeaf) or (np.count_nonzero(leaf.planes[:, :3], axis=1) != 1).any():
        return None
    ranges = []
    for axis in range(3):
        along = leaf.planes[:, axis]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = leaf.planes[:, 3] / along
        ranges.append((at[along < 0].max(initial=-np.inf), at[along > 0].min(initial=np.inf)))
    return ranges
