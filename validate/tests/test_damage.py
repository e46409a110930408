"""Every kind of damage must be caught, and a sound mesh must pass: the checks on trial, not planecut."""

import json
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from fake_files import fake_program

from planecut_validate.checks import check
from planecut_validate.result import Options

LINES, SEED = 4000, 7

# A notched block of three overlapping and touching boxes, and one apart.
BOXES = [
    ((0, 0, 0), (64, 64, 32)),
    ((32, 16, 16), (96, 48, 80)),
    ((64, 0, 0), (128, 64, 24)),
    ((160, 0, 0), (192, 32, 32)),
]

# Every operation, no two faces in one plane.
TREE = {"union": [
    {"xor": [
        {"difference": [{"box": {"min": [0, 0, 0], "max": [8, 8, 8]}}, {"box": {"min": [1, 2, 3], "max": [10, 5, 6]}}]},
        {"box": {"min": [5, 4, -2], "max": [12, 14, 5]}},
    ]},
    {"intersection": [{"box": {"min": [20, -1, -3], "max": [27, 7, 7]}}, {"complement": {"halfspaces": [[1, 0, 0, 22]]}}]},
]}  # fmt: skip

# What must be among the failures, for each damage of `fake_planecut.DAMAGES`.
CAUGHT = {
    "removed triangle": ["open", "lines differ", "OBJ volume", "manifold3d refuses"],
    "flipped triangle": ["doubled", "lines differ", "OBJ volume", "manifold3d refuses"],
    "moved vertex": ["lines differ", "OBJ volume"],
    "membrane": ["lines differ"],
    "bubble": ["lines differ"],
    "doubled surface": ["doubled", "lines differ", "OBJ volume"],
    "wrong report": ["solid.volume"],
    "not watertight": ["mesh.watertight"],
    "missing cell": ["sum of cells", "cell_lines"],
    "grown cell": ["sum of cells", "overlap", "cells overlap on"],
    "dented cell": ["not convex", "sum of cells", "cell_lines"],
    "doubled cell": ["sum of cells", "overlap", "cells overlap on"],
}

# The same for a wrong operation in the tree; of a tree of boxes the area is known too.
WRONG_OPERATIONS = {
    "union for xor": ["OBJ volume", "lines differ", "area", "volume by cells"],
    "union for difference": ["OBJ volume", "lines differ", "area", "volume by cells"],
    "difference for intersection": ["OBJ volume", "lines differ", "area", "volume by cells"],
}


def box_brush(low, high) -> str:
    """The text of one box."""
    faces = []
    for axis in range(3):
        for side, corner in ((-1, low), (1, high)):
            steps = [[int(i == (axis + k) % 3) for i in range(3)] for k in (1, 2)]
            first, third = steps if side > 0 else steps[::-1]
            points = [[c + s for c, s in zip(corner, step)] for step in (first, [0, 0, 0], third)]
            faces.append(" ".join("( {} {} {} )".format(*p) for p in points) + " tex 0 0 0 1 1")
    return "{\n" + "\n".join(faces) + "\n}\n"


class Damage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="planecut-validate-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.binary = fake_program(Path(cls.folder.name))
        cls.map = Path(cls.folder.name) / "boxes.map"
        brushes = "".join(box_brush(low, high) for low, high in BOXES)
        cls.map.write_text('{\n"classname" "worldspawn"\n' + brushes + "}\n")
        cls.tree = cls.map.with_name("tree.json")
        cls.tree.write_text(json.dumps({"planecut": 1, "model": TREE}))

    def run_with(self, damage: str, path: Path | None = None):
        with mock.patch.dict(os.environ, {"FAKE_DAMAGE": damage}):
            return check(path or self.map, Options(str(self.binary), LINES, SEED))

    def assert_caught(self, signs: list[str], failures: list[str]):
        for sign in signs:
            self.assertTrue(any(sign in failure for failure in failures), f"{sign!r} not in {failures}")

    def test_sound_meshes_pass(self):
        for path in (self.map, self.tree):
            with self.subTest(path.name):
                result = self.run_with("none", path)
                self.assertEqual(result.failures, [])
                self.assertGreater(result.lines["crossings"], LINES)
                self.assertGreater(result.cells, 3)

    def test_the_tree_is_compared_in_every_way(self):
        differences = self.run_with("none", self.tree).differences
        for name in ("OBJ volume", "area", "area by cells of a grid", "volume as manifold3d takes it", "sum of cells"):
            self.assertIn(name, differences)

    def test_every_damage_is_caught(self):
        for damage, signs in CAUGHT.items():
            for path in (self.map, self.tree):
                with self.subTest(damage, path=path.name):
                    self.assert_caught(signs, self.run_with(damage, path).failures)

    def test_every_wrong_operation_is_caught(self):
        for damage, signs in WRONG_OPERATIONS.items():
            with self.subTest(damage):
                self.assert_caught(signs, self.run_with(damage, self.tree).failures)

    def test_empty_and_unbounded_trees(self):
        box = {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}
        for node, status in (({"difference": [box, box]}, "empty"), ({"complement": box}, "refused")):
            path = self.map.with_name("odd.json")
            path.write_text(json.dumps({"planecut": 1, "model": node}))
            result = self.run_with("none", path)
            self.assertEqual((result.status, result.failures), (status, []))

    def test_a_refusal_of_a_sound_map_is_a_failure(self):
        with mock.patch.object(Damage, "map", self.map.with_name("broken.map")):
            self.map.write_text("{\n{\n( 0 0 0 )\n}\n}\n")
            self.assertEqual(self.run_with("none").status, "refused")
        refusing = self.binary.with_name("refusing")
        refusing.write_text("#!/bin/sh\necho 'error: no' >&2\nexit 2\n")
        refusing.chmod(0o755)
        with mock.patch.object(Damage, "binary", refusing):
            self.assertEqual(self.run_with("none").failures, ["error: no"])


if __name__ == "__main__":
    unittest.main()
