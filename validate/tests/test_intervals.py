"""Trees along lines against the plain definition: a point is inside or not."""

import random
import unittest

import numpy as np

from planecut_validate.leaf import ConvexLeaf
from planecut_validate.lines import Lines
from planecut_validate.solid_tree import SolidTree


def random_tree(source: random.Random, depth: int) -> SolidTree:
    """Half-spaces, slabs and boxes, bounded or not."""
    if depth == 0 or source.random() < 0.2:
        rows = []
        for axis in range(3):
            for sign in (1, -1):
                if source.random() < 0.7:
                    rows.append([*(sign * np.eye(3)[axis]), source.randint(0, 3)])
        return SolidTree.of_leaf(ConvexLeaf.of_half_spaces(np.array(rows, dtype=float).reshape(-1, 4)))
    kind = source.choice(["union", "intersection", "difference", "xor", "complement"])
    count = 1 if kind == "complement" else source.randint(0, 4)
    return SolidTree.combine(kind, [random_tree(source, depth - 1) for _ in range(count)])


def inside(tree: SolidTree, point: np.ndarray) -> bool:
    """Membership, straight from the definitions."""
    operations = {
        "union": any,
        "intersection": all,
        "difference": lambda v: bool(v) and v[0] and not any(v[1:]),
        "xor": lambda v: sum(v) % 2 == 1,
        "complement": lambda v: not v[0],
    }
    planes = [leaf.planes for leaf in tree.leaves]
    leaf = [bool((p[:, :3] @ point <= p[:, 3]).all()) for p in planes]
    return tree.fold(lambda i: leaf[i], lambda kind, values: operations[kind](values))


class Trees(unittest.TestCase):
    def test_every_piece_of_every_line(self):
        directions = np.random.default_rng(1).normal(size=(20, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        for seed in range(150):
            tree = random_tree(random.Random(seed), 4)
            lines = Lines(np.random.default_rng(seed).uniform(-2, 2, (20, 3)), directions)
            coverage = tree.coverage(lines, 10.0)
            for line in np.nonzero(~coverage.unclear)[0]:
                own = coverage.crossings.of(line)
                ends = [-1e6, *own.t, 1e6]
                for k, (a, b) in enumerate(zip(ends, ends[1:])):
                    entered = own.sign[k] == 1 if k < len(own.sign) else own.sign[k - 1] == -1 if k else None
                    at = lines.origins[line] + 0.5 * (a + b) * lines.directions[line]
                    expected = inside(tree, at)
                    if entered is not None:
                        self.assertEqual(entered, expected, f"seed {seed}, line {line}, piece {k}")
                    elif expected:
                        self.assertTrue(coverage.endless[line])


if __name__ == "__main__":
    unittest.main()
