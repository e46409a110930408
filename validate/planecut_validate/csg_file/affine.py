"""Matrices and sizes that nodes name."""

import numpy as np

from .text import Node
from .values import number

_FLAT = 1e-14
"""Determinant, relative to the lengths of the columns, below which a matrix is singular."""


def is_singular(matrix: np.ndarray) -> bool:
    """Whether it makes everything flat."""
    lengths = np.linalg.norm(matrix[:, :3], axis=0)
    return not lengths.all() or abs(np.linalg.det(matrix[:, :3] / lengths)) <= _FLAT


def factors(extent: np.ndarray, size: list[float], auto: list[bool]) -> np.ndarray:
    """Scales to a new size; those of an axis with 0 are 1, or on demand that of the largest size."""
    largest = int(np.argmax(size))
    if any(s and not e for s, e in zip(size, extent)):
        return np.ones(len(extent))
    common = size[largest] / extent[largest] if size[largest] else 1.0
    return np.array([s / e if s else common if a else 1.0 for s, e, a in zip(size, extent, auto)])


def matrix_of(node: Node) -> np.ndarray:
    """The first three rows of what `multmatrix` says; the identity where it says nothing."""
    given = node.get("m", 0)
    matrix = np.eye(4)
    for i, row in enumerate(given[:4] if isinstance(given, list) else []):
        for j, value in enumerate(row[:4] if isinstance(row, list) else []):
            matrix[i, j] = number(value, matrix[i, j])
    return matrix[:3] / matrix[3, 3] if matrix[3, 3] not in (0.0, 1.0) else matrix[:3]
