"""The reference model of a tree of any operations."""

from functools import cached_property

import manifold3d
import numpy as np

from . import rectilinear
from .coincidence import any_coincident_faces
from .lines import POSITION, Coverage, Lines
from .reference import AGREED, ReferenceSurface, ReferenceVolume
from .result import SAME
from .solid_tree import SolidTree

_FAR = 1e3
"""Side of the box that unbounded leaves are cut off at, in sizes of what the leaves themselves span."""
_NOTHING = 1e-13
"""Volume, relative to the leaves', below which a solid is rounding."""


class TreeModel:
    """A tree and what manifold3d makes of it.

    Unbounded leaves are cut off twice: far away, to find out where the solid ends, and then near to it, because
    manifold3d's tolerance grows with the size of its operands.
    """

    counts_brushes = False
    empty_may_be_refused = False
    limit = SAME
    position = POSITION

    def __init__(self, tree: SolidTree, notes: list[str] | None = None):
        self.tree = tree
        self.brushes = len(tree.leaves)
        self.notes = list(notes or [])
        low, high = _span(tree)
        self.is_unbounded = False
        self._bounded, self._frame, self._cut = tree, None, None
        if not _is_plainly_bounded(tree):
            low, high = self._cut_off(low, high)
        self._solid = self._evaluate(self._bounded)
        scale = max([float(np.prod(high - low))] + [leaf.manifold().volume() for leaf in self._bounded.leaves])
        # Thin remains of faces that coincide have an area, but no volume.
        self.is_empty = self._solid.volume() <= _NOTHING * scale
        box = np.array(self._solid.bounding_box()).reshape(2, 3)
        self.low, self.high = (low, high) if self.is_empty else (box[0], box[1])

    def _cut_off(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Finds a box around the solid, cuts the leaves off there, and returns its corners."""
        middle, half = 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low)) + 1e-3
        far = [middle - _FAR * half * _ODD, middle + _FAR * half * _ODD]
        solid = _within(self.tree.within(*far).manifold(), _box(*far))
        near = _box(middle - 0.5 * _FAR * half, middle + 0.5 * _FAR * half)
        self.is_unbounded = (solid - near).volume() > 1e-12 * near.volume()
        kept = solid ^ near
        if kept.num_tri() and kept.volume() > 0.0 and not self.is_unbounded:
            box = np.array(kept.bounding_box()).reshape(2, 3)
            low, high = np.minimum(low, box[0]), np.maximum(high, box[1])
        margin = 0.1 * _ODD * float(np.linalg.norm(high - low)) + 1e-3 * half
        self._cut = low - margin, high + margin
        self._bounded, self._frame = self.tree.within(*self._cut), _box(*self._cut)
        return low, high

    def _evaluate(self, tree: SolidTree, batch: bool = True, turn: np.ndarray | None = None) -> manifold3d.Manifold:
        """The solid; of the tree moved by `turn` where there is one."""
        moved = tree if turn is None else tree.transformed(turn)
        frame = self._frame if turn is None or self._frame is None else self._frame.transform(turn)
        return _within(moved.manifold(batch), frame)

    @cached_property
    def is_generic(self) -> bool:
        """Whether no faces of two leaves coincide."""
        return not any_coincident_faces(self._bounded.leaves, _span(self._bounded), self._cut)

    @property
    def is_simple(self) -> bool:
        """Whether no edge can have four faces: the two parts of a symmetric difference meet along such edges.

        How these are paired is a choice, and it decides how many surfaces there are.
        """
        return self.is_generic and all(kind != "xor" for kind, _ in self.tree.nodes)

    @cached_property
    def exact(self) -> tuple[float, float] | None:
        """Volume and area of a tree of boxes along the axes."""
        return None if self.is_unbounded else rectilinear.measure(self.tree)

    @property
    def box_is_exact(self) -> bool:
        """Sheets that manifold3d leaves where faces coincide may reach beyond the solid."""
        return self.is_generic

    def volume(self, candidate: float | None = None) -> ReferenceVolume:
        """The first answer if it is the candidate; else that of a grid of cells, or that of most ways.

        Where faces coincide but for rounding, manifold3d's answer may hang on how the model is turned (by 1e-3 of the volume
        of three boxes), so no single answer of it is a reason to call another one wrong.
        """
        answers = {"batch": self._solid.volume()}
        first = answers["batch"]
        agreed = AGREED * self.limit / SAME
        if candidate is not None and abs(first - candidate) <= agreed * abs(first):
            return ReferenceVolume(first, answers)
        answers |= {name: ask() for name, ask in self._other_ways()}
        if self.exact is not None:
            return ReferenceVolume(self.exact[0], answers)
        values = list(answers.values())
        votes = [sum(abs(value - other) <= agreed * abs(value) for other in values) for value in values]
        if 2 * max(votes) <= len(votes):
            raise ArithmeticError(f"manifold3d gives {answers}")
        return ReferenceVolume(values[votes.index(max(votes))], answers)

    def _other_ways(self):
        yield "two at a time", lambda: self._evaluate(self._bounded, batch=False).volume()
        for seed in range(3):
            turn = _turn(seed)
            yield f"turned, {seed}", lambda turn=turn: self._evaluate(self._bounded, turn=turn).volume()

    def solid(self) -> manifold3d.Manifold:
        """The solid by manifold3d."""
        return self._solid

    def frame(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners of a box that holds the solid with room around it."""
        low, high = _span(self._bounded)
        margin = 0.1 * _ODD * float(np.linalg.norm(high - low))
        return low - margin, high + margin

    def surface(self) -> ReferenceSurface:
        """What manifold3d says of the surface."""
        return ReferenceSurface.of(self._solid)

    def coverage(self, lines: Lines) -> Coverage:
        """Where the lines cross the solid, by the leaves' own definitions, none of them cut off."""
        return self.tree.coverage(lines, float(np.linalg.norm(self.high - self.low)))


_ODD = np.array([1.0, 1.0372, 1.0911])
"""So that the sides of the box lie in no other plane by accident."""


def _within(answer: tuple[manifold3d.Manifold, bool], frame: manifold3d.Manifold | None) -> manifold3d.Manifold:
    solid, outside = answer
    if frame is None:
        if outside:
            raise ArithmeticError("a complement without a frame")
        return solid
    return frame - solid if outside else solid


def _is_plainly_bounded(tree: SolidTree) -> bool:
    """Whether no leaf and no operation can make anything unbounded."""
    endless = any(kind == "complement" or (kind, count) == ("intersection", 0) for kind, count in tree.nodes)
    return not endless and all(leaf.bounded for leaf in tree.leaves)


def _span(tree: SolidTree) -> tuple[np.ndarray, np.ndarray]:
    """The box of all vertices, and of the points of planes without one that are nearest to the origin."""
    points = [leaf.points for leaf in tree.leaves]
    for leaf in tree.leaves:
        if not leaf.bounded:
            points.append(leaf.planes[:, :3] * leaf.planes[:, 3:])
    every = np.concatenate([*points, np.zeros((0, 3))])
    every = every[np.isfinite(every).all(1)]
    if not len(every):
        return np.full(3, -1.0), np.ones(3)
    return every.min(0), every.max(0)


def _box(low: np.ndarray, high: np.ndarray) -> manifold3d.Manifold:
    return manifold3d.Manifold.cube(high - low).translate(low)


def _turn(seed: int) -> np.ndarray:
    """A rotation about the origin, 3 rows of 4."""
    random = np.random.default_rng(seed)
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return np.column_stack([q, np.zeros(3)])
