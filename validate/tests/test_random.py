"""The random trees themselves, and how failing ones are made small."""

import unittest
from concurrent.futures import ThreadPoolExecutor

from planecut_validate.identities import IDENTITIES
from planecut_validate.model_file.node import read_document
from planecut_validate.random_trees import FAMILIES, random_document
from planecut_validate.shrink import leaves, shrink
from planecut_validate.tree_model import TreeModel


class RandomTrees(unittest.TestCase):
    def test_all_are_bounded_and_of_the_size_that_was_asked_for(self):
        empty = 0
        for seed in range(60):
            tree = random_document(seed, 20)
            self.assertEqual(tree, random_document(seed, 20))
            self.assertTrue(1 < leaves(tree["model"]) <= 20)
            model = TreeModel(read_document(tree))
            self.assertFalse(model.is_unbounded, f"seed {seed}")
            empty += model.is_empty
        self.assertLess(empty, 15)

    def test_faces_coincide_on_purpose(self):
        generic = {family: 0 for family in FAMILIES}
        for seed in range(60):
            generic[FAMILIES[seed % len(FAMILIES)]] += TreeModel(read_document(random_document(seed, 20))).is_generic
        self.assertEqual((generic["generic"], generic["grid"]), (10, 0), generic)

    def test_shrinking(self):
        tree = random_document(3, 40)["model"]

        def has_sphere(node: dict) -> bool:
            return "sphere" in str(node)

        self.assertTrue(has_sphere(tree))
        with ThreadPoolExecutor(2) as pool:
            small = shrink(tree, has_sphere, pool)
        self.assertEqual((list(small), leaves(small)), (["sphere"], 1))

    def test_identities_hold_for_truth_values(self):
        def value(node, given: dict) -> bool:
            if isinstance(node, str):
                return given[node]
            ((kind, operands),) = node.items()
            if kind == "box":
                return True
            if kind == "complement":
                return not value(operands, given)
            values = [value(operand, given) for operand in operands]
            if kind == "difference":
                return values[0] and not any(values[1:])
            return {"union": any, "intersection": all, "xor": lambda v: sum(v) % 2 == 1}[kind](values)

        for name, sides in IDENTITIES.items():
            for bits in range(8):
                given = {"a": bool(bits & 1), "b": bool(bits & 2), "c": bool(bits & 4)}
                left, right = (value(side, given) for side in sides("a", "b", "c"))
                # The one constant is nothing.
                self.assertEqual(left, False if "∅" in name else right, f"{name}, {given}")


if __name__ == "__main__":
    unittest.main()
