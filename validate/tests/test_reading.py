"""The readers: map syntax, exact bodies, and the figures of the shared test data where these are present."""

import json
import unittest
from pathlib import Path

import numpy as np

from planecut_validate.brush_union import BrushUnion
from planecut_validate.convex_body import convex_body
from planecut_validate.map_file import MapSyntaxError, read_map
from planecut_validate.model import load

WORKSPACE = Path(__file__).resolve().parents[2]
SHARED = WORKSPACE.parent / "shared/data/map"

LAYOUTS = [
    "tex 0 0 0 1 1",
    "tex 0 0 0 1 1 7",
    "tex 0 0 0 1 1 1 2 3",
    "tex [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1",
    "{(grate) [ 1 0 0 .5 ] [ 0 -1 0 -1e-3 ] 0 1 1 0 0 0",
    '"quoted name" 0 0 0 1 1 // comment',
]


def cube(layouts: list[str], end: str = "\n") -> str:
    """A cube of side 2 around the origin, its faces laid out in several ways."""
    points = [
        "( 1 0 0 ) ( 1 1 0 ) ( 1 0 1 )", "( -1 0 0 ) ( -1 0 1 ) ( -1 1 0 )", "( 0 1 0 ) ( 0 1 1 ) ( 1 1 0 )",
        "( 0 -1 0 ) ( 1 -1 0 ) ( 0 -1 1 )", "( 0 0 1 ) ( 1 0 1 ) ( 0 1 1 )", "(0 0 -1)(0 1 -1)(1 0 -1)",
    ]  # fmt: skip
    outward = []
    for triple in points:
        a, b, c = [p + ")" for p in triple.split(")")[:3]]
        outward.append(f"{b} {a} {c}")
    faces = [f"{p} {layouts[i % len(layouts)]}" for i, p in enumerate(outward)]
    return end.join(["// map", "{", '"classname" "world{spawn"', '"path" "c:\\q\\"', "{", *faces, "}", "}", ""])


class Syntax(unittest.TestCase):
    def test_every_layout_and_line_end(self):
        for layouts in [LAYOUTS] + [[layout] for layout in LAYOUTS]:
            for end in ("\n", "\r\n"):
                with self.subTest(layouts=layouts, end=end):
                    brushes = read_map(cube(layouts, end))
                    self.assertEqual([len(b.planes) for b in brushes], [6])
                    model = BrushUnion([convex_body(brushes[0].planes)], 1)
                    self.assertAlmostEqual(model.volume().volume, 8.0, delta=1e-12)

    def test_patches_are_skipped(self):
        patch = "{\npatchDef2\n{\ntex\n( 3 3 0 0 0 )\n(\n( ( 0 0 0 0 0 ) )\n)\n}\n}\n"
        text = cube(LAYOUTS)[:-2] + patch + "}\n"
        self.assertEqual(len(read_map(text)), 1)

    def test_faults_name_their_line(self):
        for text, line in [("{\n{\n( 0 0 0 ) ( 1 0 0 )\n}\n}", 3), ("{\n", 2), ("x", 1), ("{\n{\n{\n}\n}\n}\n", 3)]:
            with self.subTest(text=text), self.assertRaisesRegex(MapSyntaxError, f"^line {line}:"):
                read_map(text)


class Bodies(unittest.TestCase):
    CUBE = [(1, 0, 0, 1), (-1, 0, 0, 1), (0, 1, 0, 1), (0, -1, 0, 1), (0, 0, 1, 1), (0, 0, -1, 1)]

    def test_redundant_and_touching_planes(self):
        body = convex_body(self.CUBE + [(1, 1, 1, 4), (1, 1, 1, 3), (1, 1, 0, 2)])
        self.assertEqual((len(body.vertices), body.bounded, body.redundant), (8, True, 3))

    def test_unbounded_and_empty(self):
        self.assertFalse(convex_body(self.CUBE[:5]).bounded)
        self.assertFalse(convex_body(self.CUBE[:2]).bounded)
        self.assertEqual(len(convex_body(self.CUBE + [(1, 0, 0, -2)]).vertices), 0)


@unittest.skipUnless(SHARED.is_dir(), "the shared test data are not here")
class Figures(unittest.TestCase):
    def test_sums_and_unions(self):
        for name, expected in json.loads((SHARED / "reference.json").read_text()).items():
            if not expected:
                continue
            with self.subTest(name):
                model = load(SHARED / name)
                self.assertEqual(model.brushes, expected["brushes"])
                self.assertEqual(sum(b.redundant for b in model.bodies), expected["redundant_faces"])
                # The reference box is printed to four decimals.
                np.testing.assert_allclose([*model.low, *model.high], expected["bbox"], atol=5.1e-5)
                for value, key in ((model.brush_volume_sum, "sum_volume"), (model.volume().volume, "union_volume")):
                    self.assertLessEqual(abs(value / expected[key] - 1.0), 1e-9)


if __name__ == "__main__":
    unittest.main()
