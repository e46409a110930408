"""OpenSCAD trees as text: what is read, with its line, and what is refused."""

import re
import unittest

from planecut_validate.csg_file.printing import printed
from planecut_validate.csg_file.random_files import FAMILIES, leaves, random_nodes, smaller
from planecut_validate.csg_file.text import ScadError, parse


class Reading(unittest.TestCase):
    def test_arguments_children_and_lines(self):
        text = """// first
        group() {
          /* two
             lines */ color([1, 0.5, -2e-1, 1], name = "a \\"b\\" \\x41\\u00e9\\n") {
            cube(size = [1, 2, [3]], center = true);
          }
        }
        """
        (group,) = parse(text)
        (color,) = group.children
        (cube,) = color.children
        self.assertEqual([n.line for n in (group, color, cube)], [2, 4, 5])
        self.assertEqual(color.get("c", 0), [1.0, 0.5, -0.2, 1.0])
        self.assertEqual(color.get("name"), 'a "b" Aé\n')
        self.assertEqual((cube.get("size"), cube.get("center"), cube.get("absent")), ([1.0, 2.0, [3.0]], True, None))

    def test_words_that_are_no_numbers(self):
        (node,) = parse("cylinder($fn = inf, h = undef, r1 = -inf, r2 = [nan, 1], center = false);")
        self.assertEqual(
            [node.get(k) for k in ("$fn", "h", "r1", "r2", "center")], [None, None, None, [None, 1.0], False]
        )

    def test_modifiers(self):
        top = parse("%#group() { *cube(); !sphere(); }\n*group() { cube(); }")
        self.assertEqual([(n.name, n.modifiers) for n in top], [("group", "%#")])
        self.assertEqual([(n.name, n.modifiers) for n in top[0].children], [("sphere", "!")])

    def test_ten_thousand_groups(self):
        (node,) = parse("group() {\n" * 10_000 + "cube();" + "}" * 10_000)
        depth = 0
        while node.children:
            (node,), depth = node.children, depth + 1
        self.assertEqual((depth, node.name, node.line), (10_000, "cube", 10_001))

    def test_what_is_refused(self):
        for text, line, words in (
            ("cube();\n}", 2, "without {"),
            ("group() {\n cube();", 1, "not closed"),
            ("cube(", 1, "found None"),
            ("\n\ncube(size = [1, 2);", 3, "found ')'"),
            ("cube() sphere();", 1, "expected ; or {"),
            ("cube(size = );", 1, "expected a value"),
            ('cube(size = "1);', 1, "unexpected"),
            ("7;", 1, "expected a module"),
            ("cube(size = three);", 1, "expected a value"),
        ):
            with self.assertRaisesRegex(ScadError, f"line {line}: .*{re.escape(words)}", msg=text):
                parse(text)


class RandomFiles(unittest.TestCase):
    def test_text_and_back(self):
        for seed in range(60):
            nodes = random_nodes(seed, 20)
            text = printed(nodes)
            self.assertEqual(text, printed(random_nodes(seed, 20)), f"seed {seed}")
            kept = printed(parse(text))
            self.assertEqual(kept, printed(parse(kept)), f"seed {seed}")
            if "*" not in text:
                self.assertEqual(kept, text, f"seed {seed}")

    def test_every_module_occurs(self):
        text = "".join(printed(random_nodes(seed, 24)) for seed in range(200))
        for name in (
            "group union difference intersection multmatrix color render cube sphere cylinder polyhedron square circle polygon "
            "linear_extrude rotate_extrude hull minkowski offset projection resize"
        ).split():
            self.assertIn(name + "(", text)

    def test_smaller_ones(self):
        nodes = next(random_nodes(seed, 20) for seed in range(len(FAMILIES)) if leaves(random_nodes(seed, 20)) > 5)
        every = list(smaller(nodes))
        self.assertTrue(every)
        for tree in every:
            self.assertLess(len(printed(tree)), len(printed(nodes)))


if __name__ == "__main__":
    unittest.main()
