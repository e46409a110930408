"""A NODE to a tree."""

import numpy as np

from ..leaf import ConvexLeaf, MeshLeaf
from ..solid_tree import SolidTree
from . import affine, hulls, sweep
from .outline import read_outline
from .scope import Scope
from .shapes import SHAPES
from .text import ModelError, check_keys, check_list, fail

_MOST = 4_194_304
"""Bodies that a model may have after its instances are copied."""


def read_document(document) -> SolidTree:
    """The solid of a whole file. Raises `ModelError`."""
    check_keys(document, "$", {"planecut", "model", "materials", "parameters", "parts", "outlines"})
    if document.get("planecut") != 1 or isinstance(document["planecut"], bool):
        fail("$.planecut", "1")
    for name in ("materials", "parameters", "parts", "outlines"):
        check_keys(document.get(name, {}), f"$.{name}", document.get(name, {}))
    scope = Scope(document, {})
    return read_node(document.get("model"), "$.model", scope)


def read_node(value, path: str, scope: Scope) -> SolidTree:
    """The solid of a node, moved by the node's own matrices."""
    kinds = [key for key in check_keys(value, path, {*_KINDS, *_BESIDE, "with", "materials"}) if key in _KINDS]
    if len(kinds) != 1:
        fail(path, "exactly one key of a body or an operation")
    kind = kinds[0]
    if "with" in value and kind != "use":
        fail(f"{path}.with", "no `with` without `use`")
    if "materials" in value:
        if kind != "halfspaces":
            fail(f"{path}.materials", "no `materials` without `halfspaces`")
        if len(check_list(value["materials"], f"{path}.materials")) != len(check_list(value[kind], f"{path}.{kind}")):
            fail(f"{path}.materials", "a material for each half-space")
    place = f"{path}.{kind}"
    tree = _use(value, path, scope) if kind == "use" else _KINDS[kind](value[kind], place, scope)
    if len(tree.leaves) > _MOST:
        fail(path, f"at most {_MOST} bodies")
    matrix = affine.node_matrix(value, path, scope)
    return tree if (matrix == affine.IDENTITY).all() else tree.transformed(matrix)


def _nodes(value, path: str, scope: Scope) -> list[SolidTree]:
    if not check_list(value, path):
        fail(path, "one or more nodes")
    return [read_node(v, f"{path}[{i}]", scope) for i, v in enumerate(value)]


def _half_spaces(value, path: str, scope: Scope) -> SolidTree:
    rows = [scope.numbers(row, f"{path}[{i}]", 4) for i, row in enumerate(check_list(value, path))]
    for i, row in enumerate(rows):
        if not any(row[:3]):
            fail(f"{path}[{i}]", "a normal with a length")
    return SolidTree.of_leaf(ConvexLeaf.of_half_spaces(np.array(rows, dtype=float).reshape(-1, 4)))


def _shape(kind: str):
    def read(value, path: str, scope: Scope) -> SolidTree:
        return hulls.hull_of(np.array(SHAPES[kind](value, path, scope), dtype=float))

    return read


def _operation(kind: str):
    return lambda value, path, scope: SolidTree.combine(kind, _nodes(value, path, scope))


def _torus(value, path: str, scope: Scope) -> SolidTree:
    check_keys(value, path, {"radius", "tube", "segments", "tube_segments"})
    radius = scope.positive(value.get("radius"), f"{path}.radius")
    tube = scope.positive(value.get("tube"), f"{path}.tube")
    if tube >= radius:
        fail(f"{path}.tube", "a number below the radius")
    segments, around = scope.segments(value, path), scope.segments(value, path, "tube_segments")
    return SolidTree.of_leaf(MeshLeaf(sweep.torus(radius, tube, segments, around)))


def _extrude(value, path: str, scope: Scope) -> SolidTree:
    check_keys(value, path, {"outline", "height", "twist", "scale", "slices", "center"})
    loops = read_outline(value.get("outline"), f"{path}.outline", scope)
    height = scope.positive(value.get("height"), f"{path}.height")
    twist = scope.number(value.get("twist", 0), f"{path}.twist")
    given = value.get("scale", 1)
    scale = (
        scope.numbers(given, f"{path}.scale", 2)
        if isinstance(given, list)
        else [scope.number(given, f"{path}.scale")] * 2
    )
    if min(scale) < 0 or max(scale) == 0 and len(set(map(float, scale))) > 1:
        fail(f"{path}.scale", "numbers not below 0")
    layers = 1 if twist == 0 else int(np.ceil(abs(twist) / 5.0))
    if "slices" in value:
        layers = scope.whole(value["slices"], f"{path}.slices", 1, 100_000)
    if not isinstance(value.get("center", False), bool):
        fail(f"{path}.center", "true or false")
    bottom = -0.5 * height if value.get("center", False) else 0.0
    return _mesh(loops, lambda: sweep.extrude(loops, bottom, height, twist, tuple(scale), layers))


def _revolve(value, path: str, scope: Scope) -> SolidTree:
    check_keys(value, path, {"outline", "angle", "segments"})
    loops = read_outline(value.get("outline"), f"{path}.outline", scope)
    angle = scope.number(value.get("angle", 360), f"{path}.angle")
    if not 0.0 < angle <= 360.0:
        fail(f"{path}.angle", "an angle above 0, up to 360")
    if any((loop[:, 0] < 0.0).any() for loop in loops):
        fail(f"{path}.outline", "an outline at x ≥ 0")
    segments = sweep.revolve_segments(scope.segments(value, path), angle)
    return _mesh(loops, lambda: sweep.revolve(loops, angle, segments))


def _mesh(loops: list, build) -> SolidTree:
    """The tree of a mesh; nothing where the outline is nothing."""
    return SolidTree.of_leaf(MeshLeaf(build())) if loops else SolidTree.nothing()


def _use(node: dict, path: str, scope: Scope) -> SolidTree:
    name = node["use"]
    if not isinstance(name, str) or name not in scope.parts:
        fail(f"{path}.use", f"the name of a part, one of {', '.join(scope.parts)}")
    given = check_keys(node.get("with", {}), f"{path}.with", scope.parameters)
    replaced = {key: scope.number(v, f"{path}.with.{key}") for key, v in given.items()}
    return read_node(scope.parts[name], f"$.parts.{name}", scope.entered(f"part {name}", replaced))


def _copies(tree: SolidTree, matrices: list[np.ndarray], path: str) -> SolidTree:
    if len(tree.leaves) * len(matrices) > _MOST:
        fail(path, f"at most {_MOST} bodies")
    return SolidTree.combine("union", [tree.transformed(m) for m in matrices])


def _place(value, path: str, scope: Scope) -> np.ndarray:
    if isinstance(value, dict):
        check_keys(value, path, {"matrix"})
        return affine.rows(value.get("matrix"), f"{path}.matrix", scope, 3)
    if check_list(value, path) and isinstance(value[0], dict):
        return affine.steps(value, path, scope)
    return affine.translation(scope.numbers(value, path, 3)) if value else affine.IDENTITY


def _instances(value, path: str, scope: Scope) -> SolidTree:
    check_keys(value, path, {"of", "at"})
    places = [_place(v, f"{path}.at[{i}]", scope) for i, v in enumerate(check_list(value.get("at"), f"{path}.at"))]
    return _copies(read_node(value.get("of"), f"{path}.of", scope), places, path)


def _array(value, path: str, scope: Scope) -> SolidTree:
    check_keys(value, path, {"of", "count", "step"})
    counts = check_list(value.get("count"), f"{path}.count")
    if len(counts) != 3:
        fail(f"{path}.count", "3 numbers")
    i, j, k = (scope.whole(c, f"{path}.count[{n}]", 1, _MOST) for n, c in enumerate(counts))
    step = np.array(scope.numbers(value.get("step"), f"{path}.step", 3))
    if i * j * k > _MOST:
        fail(path, f"at most {_MOST} bodies")
    steps = [affine.translation(step * [x, y, z]) for x in range(i) for y in range(j) for z in range(k)]
    return _copies(read_node(value.get("of"), f"{path}.of", scope), steps, path)


def _ring(value, path: str, scope: Scope) -> SolidTree:
    check_keys(value, path, {"of", "count", "angle"})
    count = scope.whole(value.get("count"), f"{path}.count", 1, _MOST)
    angle = scope.number(value.get("angle", 360), f"{path}.angle")
    turns = [affine.rotation([0, 0, 1], angle * i / count) for i in range(count)]
    return _copies(read_node(value.get("of"), f"{path}.of", scope), turns, path)


def _complement(value, path: str, scope: Scope) -> SolidTree:
    return SolidTree.combine("complement", [read_node(value, path, scope)])


def _hull(value, path: str, scope: Scope) -> SolidTree:
    return hulls.hull(_nodes(value, path, scope), path)


def _minkowski(value, path: str, scope: Scope) -> SolidTree:
    trees = _nodes(value, path, scope)
    if len(trees) != 2:
        fail(path, "two nodes")
    return hulls.minkowski(trees, path)


_BESIDE = {"material", "name", "matrix", "transform"}
_KINDS = {
    "halfspaces": _half_spaces, "torus": _torus, "extrude": _extrude, "revolve": _revolve, "complement": _complement,
    "hull": _hull, "minkowski": _minkowski, "use": _use, "instances": _instances, "array": _array, "ring": _ring,
    **{kind: _shape(kind) for kind in SHAPES},
    **{kind: _operation(kind) for kind in ("union", "intersection", "difference", "xor")},
}  # fmt: skip
__all__ = ["ModelError", "read_document", "read_node"]
