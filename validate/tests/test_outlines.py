"""Set operations on polygons against the plain definition: a point is inside or not."""

import unittest

import numpy as np

from planecut_validate.model_file.arrangement import combine
from planecut_validate.model_file.offset import offset


def inside(loops: list, points: np.ndarray) -> np.ndarray:
    """Even-odd membership by a ray along x."""
    parity = np.zeros(len(points), dtype=bool)
    for loop in loops:
        for a, b in zip(loop, np.roll(loop, -1, axis=0)):
            crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
            with np.errstate(divide="ignore", invalid="ignore"):
                x = a[0] + (points[:, 1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            parity ^= crosses & (x > points[:, 0])
    return parity


def signed_area(loops: list) -> float:
    """The area with the inside on the left."""
    return sum(0.5 * float(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - np.roll(p[:, 0], -1) * p[:, 1])) for p in loops)


class Combining(unittest.TestCase):
    def test_random_polygons_on_a_grid_and_off_it(self):
        rules = [
            lambda w: w.any(1),
            lambda w: w.all(1),
            lambda w: w[:, 0] & ~w[:, 1:].any(1),
            lambda w: w.sum(1) % 2 == 1,
        ]
        for seed in range(120):
            random = np.random.default_rng(seed)
            operands = []
            for _ in range(random.integers(1, 5)):
                # On the grid, corners and edges coincide and polygons cross themselves at will.
                corners = random.integers(0, 5, (random.integers(3, 8), 2)).astype(float)
                operands.append([corners if seed % 2 else corners + random.random(corners.shape)])
            points = random.random((400, 2)) * 7.0 - 1.0
            within = np.column_stack([inside(loops, points) for loops in operands])
            for number, rule in enumerate(rules):
                loops = combine(operands, rule)
                np.testing.assert_array_equal(inside(loops, points), rule(within), f"seed {seed}, rule {number}")
                share = float(rule(within).mean())
                # The inside is on the left: areas add up, holes with a minus.
                self.assertAlmostEqual(signed_area(loops) / 49.0, share, delta=0.12, msg=f"seed {seed}, rule {number}")

    def test_shifted_copies_that_only_rounding_parts(self):
        square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
        noisy = (square @ turn.T) @ turn
        self.assertEqual(combine([[square], [noisy]], lambda w: w.sum(1) == 1), [])


class Offsets(unittest.TestCase):
    def test_distance(self):
        random = np.random.default_rng(3)
        loop = np.array([[0, 0], [6, 0], [6, 5], [4, 5], [4, 1], [3, 3], [1, 4], [0, 4]], dtype=float)
        points = random.random((3000, 2)) * 10.0 - 2.0
        a, b = loop, np.roll(loop, -1, axis=0)
        part = np.clip(np.einsum("pei,ei->pe", points[:, None] - a, b - a) / np.square(b - a).sum(1), 0.0, 1.0)
        distance = np.linalg.norm(a + part[..., None] * (b - a) - points[:, None], axis=2).min(1)
        here = inside([loop], points)
        for by in (0.4, 1.2, -0.3, -0.8):
            grown = inside(offset([loop], by, "round", 720), points)
            expected = here | (distance < by) if by > 0 else here & (distance > -by)
            clear = np.abs(distance - abs(by)) > 1e-3
            np.testing.assert_array_equal(grown[clear], expected[clear], f"by {by}")


if __name__ == "__main__":
    unittest.main()
