"""Every kind of damage must be caught, and a sound mesh must pass: the checks on trial, not planecut."""

import os
import stat
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from planecut_validate.checks import check

TESTS = Path(__file__).resolve().parent
LINES, SEED = 4000, 7

# A notched block of three overlapping and touching boxes, and one apart.
BOXES = [((0, 0, 0), (64, 64, 32)), ((32, 16, 16), (96, 48, 80)), ((64, 0, 0), (128, 64, 24)), ((160, 0, 0), (192, 32, 32))]

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
        cls.binary = Path(cls.folder.name) / "planecut"
        cls.binary.write_text(f"#!/bin/sh\nexec '{sys.executable}' '{TESTS / 'fake_planecut.py'}' \"$@\"\n")
        cls.binary.chmod(cls.binary.stat().st_mode | stat.S_IXUSR)
        cls.map = Path(cls.folder.name) / "boxes.map"
        brushes = "".join(box_brush(low, high) for low, high in BOXES)
        cls.map.write_text('{\n"classname" "worldspawn"\n' + brushes + "}\n")

    def run_with(self, damage: str):
        with mock.patch.dict(os.environ, {"FAKE_DAMAGE": damage}):
            return check(self.map, str(self.binary), LINES, SEED)

    def test_sound_mesh_passes(self):
        result = self.run_with("none")
        self.assertEqual(result.failures, [])
        self.assertGreater(result.lines["crossings"], LINES)

    def test_every_damage_is_caught(self):
        for damage, signs in CAUGHT.items():
            with self.subTest(damage):
                failures = self.run_with(damage).failures
                for sign in signs:
                    self.assertTrue(any(sign in failure for failure in failures), f"{sign!r} not in {failures}")

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
