"""Matrices of 3 rows of 4, and of 2 rows of 3, from what the file says."""

import numpy as np

from ..angles import cosine, sine
from .scope import Scope
from .text import check_keys, check_list, fail

IDENTITY = np.eye(3, 4)


def after(first: np.ndarray, then: np.ndarray) -> np.ndarray:
    """The map that does `first` and then `then`."""
    whole = then[:, :-1] @ first
    whole[:, -1] += then[:, -1]
    return whole


def node_matrix(node: dict, path: str, scope: Scope) -> np.ndarray:
    """What `"transform"` and `"matrix"` of a node say together."""
    matrix = IDENTITY.copy()
    if "transform" in node:
        matrix = steps(node["transform"], f"{path}.transform", scope)
    if "matrix" in node:
        matrix = after(matrix, rows(node["matrix"], f"{path}.matrix", scope, 3))
    return matrix


def rows(value, path: str, scope: Scope, size: int) -> np.ndarray:
    """A matrix of `size` rows, or one more that says nothing. Raises `ModelError` where it is singular."""
    check_list(value, path)
    if len(value) not in (size, size + 1):
        fail(path, f"{size} or {size + 1} rows")
    found = np.array([scope.numbers(row, f"{path}[{i}]", size + 1) for i, row in enumerate(value)])
    if len(found) > size and found[size].tolist() != [0.0] * size + [1.0]:
        fail(f"{path}[{size}]", f"{[0] * size + [1]}")
    return _regular(found[:size], path)


def _regular(matrix: np.ndarray, path: str) -> np.ndarray:
    linear = matrix[:, :-1]
    lengths = np.linalg.norm(linear, axis=0)
    if not np.isfinite(matrix).all() or not (lengths > 0).all() or abs(np.linalg.det(linear / lengths)) <= 1e-14:
        fail(path, "a matrix that is not singular")
    return matrix


def steps(value, path: str, scope: Scope) -> np.ndarray:
    """The steps of a transform, one after the other."""
    matrix = IDENTITY.copy()
    for i, one in enumerate(check_list(value, path)):
        matrix = after(matrix, _step(one, f"{path}[{i}]", scope))
    return matrix


def _step(value, path: str, scope: Scope) -> np.ndarray:
    check_keys(value, path, _STEPS)
    if len(value) != 1:
        fail(path, "one step")
    ((name, what),) = value.items()
    return _regular(_STEPS[name](what, f"{path}.{name}", scope), path)


def translation(by) -> np.ndarray:
    """A shift."""
    return np.column_stack([np.eye(3), by])


def rotation(axis, degrees: float) -> np.ndarray:
    """A turn about an axis through the origin, counter-clockwise seen against it."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    s, c = sine(degrees), cosine(degrees)
    outer = np.outer([x, y, z], [x, y, z])
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.column_stack([c * np.eye(3) + s * cross + (1 - c) * outer, np.zeros(3)])


def _translate(value, path: str, scope: Scope) -> np.ndarray:
    return translation(scope.numbers(value, path, 3))


def _rotate(value, path: str, scope: Scope) -> np.ndarray:
    if isinstance(value, dict):
        check_keys(value, path, {"axis", "angle"})
        axis = scope.numbers(value.get("axis"), f"{path}.axis", 3)
        if not any(axis):
            fail(f"{path}.axis", "an axis with a length")
        return rotation(axis, scope.number(value.get("angle"), f"{path}.angle"))
    matrix = IDENTITY.copy()
    for axis, angle in zip(np.eye(3), scope.numbers(value, path, 3)):
        matrix = after(matrix, rotation(axis, angle))
    return matrix


def _scale(value, path: str, scope: Scope) -> np.ndarray:
    factors = scope.numbers(value, path, 3) if isinstance(value, list) else [scope.number(value, path)] * 3
    return np.column_stack([np.diag(factors), np.zeros(3)])


def _mirror(value, path: str, scope: Scope) -> np.ndarray:
    normal = np.array(scope.numbers(value, path, 3))
    if not normal.any():
        fail(path, "a normal with a length")
    return np.column_stack([np.eye(3) - 2.0 * np.outer(normal, normal) / (normal @ normal), np.zeros(3)])


_STEPS = {
    "translate": _translate,
    "rotate": _rotate,
    "scale": _scale,
    "mirror": _mirror,
    "matrix": lambda value, path, scope: rows(value, path, scope, 3),
}
