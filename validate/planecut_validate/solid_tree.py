"""A solid as set operations over bodies: what the line oracle and manifold3d are asked about."""

from collections.abc import Callable
from dataclasses import dataclass

import manifold3d
import numpy as np

from . import intervals
from .leaf import Leaf
from .lines import Coverage, Crossings, Lines


@dataclass
class SolidTree:
    """Leaves, and entries in postfix order: `("leaf", number)` or `(operation, how many operands)`; the last is the root."""

    leaves: list[Leaf]
    nodes: list[tuple[str, int]]

    @classmethod
    def of_leaf(cls, leaf: Leaf) -> "SolidTree":
        """The body alone."""
        return cls([leaf], [("leaf", 0)])

    @classmethod
    def nothing(cls) -> "SolidTree":
        """The union of no bodies."""
        return cls([], [("union", 0)])

    @classmethod
    def combine(cls, operation: str, operands: list["SolidTree"]) -> "SolidTree":
        """The operation on the operands, in their order."""
        leaves: list[Leaf] = []
        nodes: list[tuple[str, int]] = []
        for operand in operands:
            base = len(leaves)
            leaves += operand.leaves
            nodes += [(kind, base + n) if kind == "leaf" else (kind, n) for kind, n in operand.nodes]
        nodes.append((operation, len(operands)))
        return cls(leaves, nodes)

    def transformed(self, matrix: np.ndarray) -> "SolidTree":
        """The solid moved by a matrix of 3 rows of 4."""
        return SolidTree([leaf.transformed(matrix) for leaf in self.leaves], self.nodes)

    def within(self, low: np.ndarray, high: np.ndarray) -> "SolidTree":
        """The same tree with its unbounded leaves cut off at a box."""
        return SolidTree([leaf.within(low, high) for leaf in self.leaves], self.nodes)

    def is_union_of_convex(self) -> bool:
        """Whether nothing is ever taken away, and all leaves are bounded."""
        kinds = {kind for kind, count in self.nodes if kind not in ("leaf", "union") and count != 1}
        return (
            not kinds
            and all(kind != "complement" for kind, _ in self.nodes)
            and all(leaf.bounded for leaf in self.leaves)
        )

    def fold(self, leaf: Callable, operate: Callable):
        """The root's value, of `leaf(number)` and `operate(operation, values)`."""
        values: list = []
        for kind, count in self.nodes:
            if kind == "leaf":
                values.append(leaf(count))
            else:
                operands = values[len(values) - count :]
                del values[len(values) - count :]
                values.append(operate(kind, operands))
        return values.pop()

    def coverage(self, lines: Lines, size: float, chunk: int = 4096) -> Coverage:
        """Where the lines cross the solid, from the leaves' own definitions. `size`: the model's diagonal."""
        parts = [self._coverage(lines[at : at + chunk], at, size) for at in range(0, len(lines), chunk)]
        crossings = Crossings(
            *(np.concatenate([getattr(p.crossings, name) for p in parts]) for name in ("line", "t", "sign"))
        )
        return Coverage(
            crossings, *(np.concatenate([getattr(p, name) for p in parts]) for name in ("unclear", "endless"))
        )

    def _coverage(self, lines: Lines, first_line: int, size: float) -> Coverage:
        ends = [leaf.ends(lines, size) for leaf in self.leaves]
        places = intervals.Places(ends, len(lines), size)
        whole = self.fold(lambda i: places.sets[i], lambda kind, sets: intervals.apply(places, kind, sets))
        unclear = places.doubtful
        for body in ends:
            unclear[body.unclear] = True
        line = places.line[whole.places]
        turns = np.bincount(line, weights=whole.signs, minlength=len(lines)) + whole.begins
        crossings = Crossings(line + first_line, places.t[whole.places], -whole.signs)
        return Coverage(crossings, unclear, whole.begins | (turns > 0))

    def manifold(self, batch: bool = True) -> tuple[manifold3d.Manifold, bool]:
        """The tree by manifold3d, of bounded leaves: a solid, and whether what is meant is all of space but that solid.

        `batch`: operations on many operands at once; else two at a time, from the last to the first.
        """
        union, common, minus = (_batch if batch else _by_pairs)()
        algebra = _Algebra(union, common, minus)
        return self.fold(lambda i: (self.leaves[i].manifold(), False), algebra.apply)


def _batch():
    def many(kind):
        return lambda solids: manifold3d.Manifold.batch_boolean(solids, kind)

    subtract = many(manifold3d.OpType.Subtract)
    return many(manifold3d.OpType.Add), many(manifold3d.OpType.Intersect), lambda a, others: subtract([a, *others])


def _by_pairs():
    def many(operation):
        def run(solids):
            result = solids[-1]
            for solid in solids[-2::-1]:
                result = operation(result, solid)
            return result

        return run

    def minus(a, others):
        for solid in others[::-1]:
            a = a - solid
        return a

    return many(lambda a, b: a + b), many(lambda a, b: a ^ b), minus


@dataclass
class _Algebra:
    """Set operations on solids and complements of solids, without ever making a complement."""

    union: Callable
    common: Callable
    minus: Callable

    def apply(
        self, operation: str, operands: list[tuple[manifold3d.Manifold, bool]]
    ) -> tuple[manifold3d.Manifold, bool]:
        if operation == "complement":
            ((solid, outside),) = operands
            return solid, not outside
        if operation == "xor":
            return self._xor(operands)
        if operation == "difference":
            if not operands:
                return manifold3d.Manifold(), False
            return self._intersection([operands[0]] + [(solid, not outside) for solid, outside in operands[1:]])
        if operation == "intersection":
            return self._intersection(operands)
        solid, outside = self._intersection([(solid, not outside) for solid, outside in operands])
        return solid, not outside

    def _intersection(self, operands):
        solids = [solid for solid, outside in operands if not outside]
        holes = [solid for solid, outside in operands if outside]
        if not solids:
            return (self.union(holes) if len(holes) > 1 else holes[0] if holes else manifold3d.Manifold()), True
        first = self.common(solids) if len(solids) > 1 else solids[0]
        return (self.minus(first, holes) if holes else first), False

    def _xor(self, operands):
        result, outside = manifold3d.Manifold(), False
        for solid, other_outside in operands:
            result = self.union([result - solid, solid - result])
            outside ^= other_outside
        return result, outside
