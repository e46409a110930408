"""The model file's reader: numbers, names, transforms, and shapes whose volumes are known without any kernel."""

import json
import math
import tempfile
import unittest
from pathlib import Path

from planecut_validate.model_file import read_model
from planecut_validate.model_file.expression import evaluate
from planecut_validate.tree_model import TreeModel

UNIT = {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}
SQUARE = {"rectangle": {"min": [0, 0], "max": [2, 2]}}


def polygon_area(radius: float, sides: int) -> float:
    """The area of a regular polygon."""
    return 0.5 * sides * radius * radius * math.sin(2.0 * math.pi / sides)


def read(node, **document) -> TreeModel:
    """The model of one node."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.json"
        path.write_text(json.dumps({"planecut": 1, "model": node} | document))
        return TreeModel(read_model(path))


def frustum(r: float, s: float, height: float, sides: int) -> float:
    """The volume between two regular polygons."""
    a, b = polygon_area(r, sides), polygon_area(s, sides)
    return height * (a + b + math.sqrt(a * b)) / 3.0


def sphere_volume(radius: float, segments: int) -> float:
    """Frustums between the rings."""
    rings = (segments + 1) // 2
    angles = [math.pi * (i + 0.5) / rings for i in range(rings)]
    cuts = [(radius * math.sin(a), radius * math.cos(a)) for a in angles]
    return sum(frustum(r, s, z - w, segments) for (r, z), (s, w) in zip(cuts, cuts[1:]))


class Numbers(unittest.TestCase):
    def test_expressions(self):
        for text, value in [
            ("1 + 2 * 3", 7), ("-2^2", -4), ("2^3^2", 512), ("2^-1", 0.5), ("(1 + 2) * 3", 9), ("-7 % 3", 2), ("7 % -3", -2),
            ("10 - 4 - 3", 3), ("8 / 4 / 2", 1), ("min(3, 1, 2)", 1), ("max(3)", 3), ("sin(30)", 0.5), ("cos(180)", -1),
            ("tan(0)", 0), ("atan2(1, -1)", 135), ("round(2.5)", 3), ("round(-2.5)", -3), ("sqrt(16)", 4),
            ("w / 2", 20), (".5e1", 5), ("abs(-pi) - pi", 0), ("--2", 2),
        ]:  # fmt: skip
            with self.subTest(text):
                self.assertAlmostEqual(evaluate(text, {"w": 40.0}.__getitem__), value, delta=1e-14)

    def test_what_is_no_expression(self):
        for text in ("", "1 +", "(1", "1 2", "foo(1)", "sin(1, 2)", "1 $ 2", "(-1)^0.5", "min()"):
            with self.subTest(text), self.assertRaises(ValueError):
                evaluate(text, {}.__getitem__)


class Documents(unittest.TestCase):
    def test_parameters_depend_on_each_other_and_are_replaced_within_a_part(self):
        document = {
            "parameters": {"b": "=a * 2", "a": 1},
            "parts": {"block": {"box": {"min": [0, 0, 0], "max": ["=a", "=b", 1]}}},
        }
        shifted = {"use": "block", "with": {"a": 3}, "transform": [{"translate": [10, 0, 0]}]}
        self.assertAlmostEqual(read({"union": [{"use": "block"}, shifted]}, **document).volume().volume, 2.0 + 18.0)

    def test_faults(self):
        for document in (
            {"planecut": 2, "model": UNIT},
            {"planecut": 1},
            {"planecut": 1, "model": UNIT, "extra": 1},
            {"planecut": 1, "model": UNIT | {"sphere": {"radius": 1}}},
            {"planecut": 1, "model": {"sphere": {"radius": -1}}},
            {"planecut": 1, "model": {"sphere": {"radius": "=r"}}, "parameters": {"r": "=q", "q": "=r"}},
            {"planecut": 1, "model": {"use": "a"}, "parts": {"a": {"use": "b"}, "b": {"use": "a"}}},
            {"planecut": 1, "model": UNIT | {"transform": [{"scale": [1, 0, 1]}]}},
            {"planecut": 1, "model": {"array": {"of": UNIT, "count": [1000, 1000, 1000], "step": [1, 1, 1]}}},
            {"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, True]}}},
        ):
            with self.subTest(document), self.assertRaises(ValueError):
                read(None, **document)


class Shapes(unittest.TestCase):
    def assert_volume(self, node: dict, volume: float):
        with self.subTest(node):
            self.assertAlmostEqual(read(node).volume().volume, volume, delta=1e-11 * max(1.0, volume))

    def test_convex(self):
        self.assert_volume({"sphere": {"radius": 2, "segments": 9}}, sphere_volume(2, 9))
        self.assert_volume({"sphere": {"radius": 2}}, sphere_volume(2, 32))
        self.assert_volume(
            {"cylinder": {"height": 3, "radius": 2, "top_radius": 1, "segments": 7}}, frustum(2, 1, 3, 7)
        )
        self.assert_volume({"cone": {"height": 3, "radius": 2, "segments": 5}}, frustum(2, 0, 3, 5))
        self.assert_volume({"prism": {"height": 3, "radius": 2, "sides": 6}}, 3 * polygon_area(2, 6))
        self.assert_volume({"pyramid": {"height": 3, "radius": 2, "sides": 4}}, polygon_area(2, 4))
        self.assert_volume({"wedge": {"size": [2, 3, 4]}}, 12)
        for solid, volume in (
            ("tetrahedron", 8 * math.sqrt(3) / 27), ("cube", 8 * math.sqrt(3) / 9), ("octahedron", 4 / 3),
            ("dodecahedron", 2 * (5 * math.sqrt(3) + math.sqrt(15)) / 9), ("icosahedron", 2 * math.sqrt(10 + 2 * math.sqrt(5)) / 3),
        ):  # fmt: skip
            self.assert_volume({"regular": {"solid": solid, "radius": 1}}, volume)

    def test_capsule_is_a_sphere_drawn_apart(self):
        rings = [1.5 * math.sin(math.pi * (i + 0.5) / 4) for i in range(4)]
        wall = 2 * polygon_area(max(rings), 8)
        self.assert_volume({"capsule": {"height": 2, "radius": 1.5, "segments": 8}}, sphere_volume(1.5, 8) + wall)

    def test_swept(self):
        # Pappus, with a regular polygon instead of a circle as the way of the centre.
        ring = 2 * math.pi * 3 * polygon_area(1, 12) * (polygon_area(1, 16) / math.pi)
        self.assert_volume({"torus": {"radius": 3, "tube": 1, "segments": 16, "tube_segments": 12}}, ring)
        self.assert_volume({"extrude": {"outline": SQUARE, "height": 3, "scale": 0}}, 4)
        self.assert_volume({"extrude": {"outline": SQUARE, "height": 3, "scale": [0.5, 1]}}, 9)
        self.assert_volume({"extrude": {"outline": SQUARE, "height": 3, "center": True}}, 12)
        profile = {"polygon": [[0, 0], [2, 0], [2, 1], [0, 1]]}
        self.assert_volume({"revolve": {"outline": profile, "segments": 6}}, polygon_area(2, 6))
        self.assert_volume({"revolve": {"outline": profile, "segments": 6, "angle": 60}}, polygon_area(2, 6) / 6)
        diamond = {"polygon": [[1, 0], [0, 1], [0, -1]]}
        self.assert_volume({"revolve": {"outline": diamond, "segments": 4}}, 4 / 3)

    def test_the_twist_is_cut_along_the_shorter_diagonal(self):
        # One layer, a square turned by 45°: an antiprism whose side triangles lie outwards of the straight edges.
        twisted = read(
            {
                "extrude": {
                    "outline": {"rectangle": {"min": [-1, -1], "max": [1, 1]}},
                    "height": 1,
                    "twist": 45,
                    "slices": 1,
                }
            }
        )
        mesh_volume = twisted.volume().volume
        hull = read(
            {
                "hull": [
                    {
                        "extrude": {
                            "outline": {"rectangle": {"min": [-1, -1], "max": [1, 1]}},
                            "height": 1,
                            "twist": 45,
                            "slices": 1,
                        }
                    }
                ]
            }
        )
        self.assertAlmostEqual(mesh_volume, hull.volume().volume, delta=1e-12)

    def test_outlines(self):
        def extruded(outline):
            return {"extrude": {"outline": outline, "height": 1}}

        hole = {"polygon": [[[0, 0], [4, 0], [4, 4], [0, 4]], [[1, 1], [1, 3], [3, 3], [3, 1]]]}
        self.assert_volume(extruded(hole), 12)
        other = {"rectangle": {"min": [1, 1], "max": [3, 3]}}
        for kind, area in (("union", 7), ("intersection", 1), ("difference", 3), ("xor", 6)):
            self.assert_volume(extruded({kind: [SQUARE, other]}), area)
        self.assert_volume(extruded({"offset": {"of": SQUARE, "by": 1, "join": "bevel"}}), 4 + 8 + 2)
        self.assert_volume(extruded({"offset": {"of": SQUARE, "by": 1, "join": "miter"}}), 16)
        self.assert_volume(extruded({"offset": {"of": SQUARE, "by": 1, "segments": 16}}), 12 + polygon_area(1, 16))
        self.assert_volume(extruded({"offset": {"of": hole, "by": -0.25, "join": "miter"}}), 3.5**2 - 2.5**2)
        self.assert_volume(extruded({"offset": {"of": SQUARE, "by": -1.5}}), 0)
        self.assert_volume(extruded(SQUARE | {"matrix": [[1, 1, 5], [0, 2, 6]]}), 8)
        self.assert_volume(
            extruded({"slice": {"of": {"difference": [UNIT, {"halfspaces": [[1, 0, 1, 0.5]]}]}, "z": 0.25}}), 0.75
        )
        self.assert_volume(
            extruded({"project": UNIT | {"transform": [{"rotate": {"axis": [0, 1, 0], "angle": 45}}]}}), math.sqrt(2)
        )
        self.assert_volume(extruded({"project": {"xor": [UNIT, {"wedge": {"size": [3, 1, 1]}}]}}), 3)

    def test_combining(self):
        self.assert_volume({"array": {"of": UNIT, "count": [2, 3, 1], "step": [1, 2, 0]}}, 6)
        self.assert_volume({"ring": {"of": UNIT, "count": 4}}, 4)
        self.assert_volume(
            {
                "instances": {
                    "of": UNIT,
                    "at": [
                        [0, 0, 0],
                        [{"translate": [5, 0, 0]}],
                        {"matrix": [[0, -1, 0, 9], [1, 0, 0, 0], [0, 0, 1, 0]]},
                    ],
                }
            },
            3,
        )
        self.assert_volume({"hull": [UNIT, UNIT | {"transform": [{"translate": [3, 0, 0]}]}]}, 4)
        self.assert_volume({"minkowski": [UNIT, {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}}]}, 24)
        ell = {"union": [UNIT, UNIT | {"transform": [{"translate": [1, 0, 0]}]}]}
        self.assert_volume({"minkowski": [ell, UNIT]}, 12)
        self.assert_volume({"intersection": [{"complement": {"halfspaces": [[0, 0, 1, 0.25]]}}, UNIT]}, 0.75)
        self.assert_volume(
            {
                "difference": [
                    {"halfspaces": [[1, 0, 0, 1], [-1, 0, 0, 0], [0, 1, 0, 1], [0, 0, 1, 1]]},
                    {"complement": UNIT},
                ]
            },
            1,
        )

    def test_transforms(self):
        turned = read(
            UNIT
            | {
                "transform": [
                    {"rotate": [90, 0, 90]},
                    {"scale": [2, 1, 1]},
                    {"mirror": [0, 0, 1]},
                    {"translate": [1, 2, 3]},
                ]
            }
        )
        # (x, y, z) ↦ x turn (x, −z, y) ↦ z turn (z, x, y) ↦ (2z, x, y) ↦ (2z, x, −y) ↦ + (1, 2, 3)
        self.assertEqual((turned.low.tolist(), turned.high.tolist()), ([1, 2, 2], [3, 3, 3]))

    def test_materials_of_faces(self):
        planes = {"halfspaces": [[0, 0, 1, 1], [0, 0, -1, 0]]}
        self.assertTrue(read(planes | {"materials": ["a", None]}).is_unbounded)
        for wrong in (planes | {"materials": ["a"]}, UNIT | {"materials": [None]}, planes | {"materials": "a"}):
            with self.assertRaises(ValueError):
                read(wrong)

    def test_unbounded(self):
        self.assertTrue(read({"complement": UNIT}).is_unbounded)
        self.assertTrue(read({"halfspaces": [[0, 0, 1, 1], [0, 0, -1, 0]]}).is_unbounded)
        self.assertTrue(read({"union": [UNIT, {"halfspaces": [[1, 2, 3, 4]]}]}).is_unbounded)
        self.assertFalse(read({"complement": {"complement": UNIT}}).is_unbounded)
        self.assertTrue(read({"difference": [{"halfspaces": [[1, 2, 3, 4]]}] * 2}).is_empty)


if __name__ == "__main__":
    unittest.main()
