"""An OUTLINE to loops."""

import numpy as np

from ..angles import circle
from . import affine
from .arrangement import combine
from .offset import offset
from .scope import Scope
from .text import check_keys, check_list, fail


def read_outline(value, path: str, scope: Scope) -> list[np.ndarray]:
    """Closed loops with the inside on their left that do not cross. Raises `ModelError`."""
    loops = _read(value, path, scope)
    return combine([loops], lambda within: within[:, 0])


def _read(value, path: str, scope: Scope) -> list[np.ndarray]:
    """Loops, even-odd, moved by the outline's own matrix."""
    check_keys(value, path, {*_KINDS, "matrix"})
    kinds = [key for key in value if key in _KINDS]
    if len(kinds) != 1:
        fail(path, f"exactly one of {', '.join(sorted(_KINDS))}")
    loops = _KINDS[kinds[0]](value[kinds[0]], f"{path}.{kinds[0]}", scope)
    if "matrix" not in value:
        return loops
    matrix = affine.rows(value["matrix"], f"{path}.matrix", scope, 2)
    return [loop @ matrix[:, :2].T + matrix[:, 2] for loop in loops]


def _polygon(value, path: str, scope: Scope) -> list[np.ndarray]:
    check_list(value, path)
    nested = bool(value) and isinstance(value[0], list) and bool(value[0]) and isinstance(value[0][0], list)
    loops = value if nested else [value]
    read = []
    for i, loop in enumerate(loops):
        place = f"{path}[{i}]" if nested else path
        if len(check_list(loop, place)) < 3:
            fail(place, "at least 3 points")
        read.append(np.array([scope.numbers(p, f"{place}[{k}]", 2) for k, p in enumerate(loop)]))
    return read


def _rectangle(value, path: str, scope: Scope) -> list[np.ndarray]:
    check_keys(value, path, {"min", "max"})
    (x0, y0), (x1, y1) = (scope.numbers(value.get(key), f"{path}.{key}", 2) for key in ("min", "max"))
    if not (x0 < x1 and y0 < y1):
        fail(path, "a minimum below the maximum")
    return [np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])]


def _circle(value, path: str, scope: Scope) -> list[np.ndarray]:
    check_keys(value, path, {"radius", "segments"})
    return [np.array(circle(scope.positive(value.get("radius"), f"{path}.radius"), scope.segments(value, path)))]


_INSIDE = {
    "union": lambda within: within.any(1),
    "intersection": lambda within: within.all(1),
    "difference": lambda within: within[:, 0] & ~within[:, 1:].any(1),
    "xor": lambda within: within.sum(1) % 2 == 1,
}


def _operation(kind: str):
    def read(value, path: str, scope: Scope) -> list[np.ndarray]:
        operands = [_read(v, f"{path}[{i}]", scope) for i, v in enumerate(check_list(value, path))]
        return combine(operands, _INSIDE[kind]) if operands else []

    return read


def _offset(value, path: str, scope: Scope) -> list[np.ndarray]:
    check_keys(value, path, {"of", "by", "join", "segments"})
    join = value.get("join", "round")
    if join not in ("round", "miter", "bevel"):
        fail(f"{path}.join", "round, miter or bevel")
    loops = read_outline(value.get("of"), f"{path}.of", scope)
    return offset(loops, scope.number(value.get("by"), f"{path}.by"), join, scope.segments(value, path))


def _slice(value, path: str, scope: Scope) -> list[np.ndarray]:
    from .node import read_node
    from .sections import cut

    check_keys(value, path, {"of", "z"})
    return cut(read_node(value.get("of"), f"{path}.of", scope), scope.number(value.get("z"), f"{path}.z"))


def _project(value, path: str, scope: Scope) -> list[np.ndarray]:
    from .node import read_node
    from .sections import shadow

    return shadow(read_node(value, path, scope))


def _use(value, path: str, scope: Scope) -> list[np.ndarray]:
    if value not in scope.outlines:
        fail(path, f"the name of an outline, one of {', '.join(scope.outlines)}")
    return _read(scope.outlines[value], f"$.outlines.{value}", scope.entered(f"outline {value}", {}))


_KINDS = {
    "polygon": _polygon, "rectangle": _rectangle, "circle": _circle, "offset": _offset, "slice": _slice,
    "project": _project, "use": _use, **{kind: _operation(kind) for kind in _INSIDE},
}  # fmt: skip
