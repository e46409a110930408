"""Random OpenSCAD trees for the checks: every module but `text` and `import`, and what OpenSCAD forgives."""

import random
from collections.abc import Iterator
from dataclasses import replace

from .fragments import unit_circle
from .text import Node

FAMILIES = ("solids", "grid", "extrusions", "hulls", "lenient", "mixed")
"""Kinds of trees: turned bodies; boxes on a grid; outlines drawn out or turned around; hulls and sums; all that with
modifiers, nothing, and things that have no size; and all of these."""


def random_nodes(seed: int, most_leaves: int) -> list[Node]:
    """The nodes at the top of a file with about this number of leaves at most; the same seed gives the same ones."""
    maker = _Maker(random.Random(seed), FAMILIES[seed % len(FAMILIES)])
    top = [maker.solid(n) for n in maker.shares(maker.random.randint(1, max(1, most_leaves)))]
    return [_still(node) for node in top]


def leaves(top: list[Node]) -> int:
    """Nodes without children."""
    return sum(leaves(node.children) if node.children else 1 for node in top)


def smaller(top: list[Node]) -> Iterator[list[Node]]:
    """Trees with one node left out, replaced by its children, or without its modifiers or special arguments."""
    for i, node in enumerate(top):
        before, after = top[:i], top[i + 1 :]
        if len(top) > 1:
            yield before + after
        if node.children:
            yield before + node.children + after
        if node.modifiers:
            yield [*before, replace(node, modifiers=""), *after]
        for name in ("twist", "scale", "center", "$fn", "angle", "slices"):
            if name in node.named:
                yield [*before, replace(node, named={k: v for k, v in node.named.items() if k != name}), *after]
        for children in smaller(node.children):
            yield [*before, replace(node, children=children), *after]


def _still(node: Node) -> Node:
    """Whole numbers as they are read back."""

    def value(v):
        return [value(w) for w in v] if isinstance(v, list) else float(f"{v:g}") if type(v) in (int, float) else v

    named = {name: value(v) for name, v in node.named.items()}
    return replace(node, named=named, given=value(node.given), children=[_still(c) for c in node.children])


def _call(name: str, *given, children: list[Node] | None = None, **named) -> Node:
    return Node(name, 0, "", {k.replace("S_", "$"): v for k, v in named.items()}, list(given), children or [])


class _Maker:
    """Makes nodes of one family."""

    def __init__(self, source: random.Random, family: str):
        self.random = source
        self.family = family

    def shares(self, count: int) -> list[int]:
        """Splits leaves among a few children."""
        pieces = min(count, self.random.choice([1, 2, 2, 3, 4]))
        cuts = sorted(self.random.sample(range(1, count), pieces - 1)) if count > 1 else []
        return [b - a for a, b in zip([0, *cuts], [*cuts, count])]

    def chance(self, share: float) -> bool:
        return self.random.random() < share

    def is_one_of(self, *families: str) -> bool:
        return self.family in families or (self.family == "mixed" and self.chance(0.5))

    def solid(self, count: int) -> Node:
        """Something solid, most times."""
        node = self._solid(count)
        if self.is_one_of("lenient") and self.chance(0.12):
            node.modifiers = self.random.choice(["%", "#", "#", "*"])
        return node

    def _solid(self, count: int) -> Node:
        if self.is_one_of("lenient") and self.chance(0.08):
            return self.random.choice(_NOTHING)(self)
        if count == 1:
            return self.placed(self.body())
        kind = self.random.random()
        children = [self.solid(n) for n in self.shares(count)]
        if kind < 0.12 and self.is_one_of("hulls"):
            return _call("hull", children=children)
        if kind < 0.2 and self.is_one_of("hulls") and count < 5:
            return _call("minkowski", children=[children[0], self.small_body()])
        if kind < 0.35:
            return self.placed(_call("group", children=children))
        if kind < 0.42:
            color = [round(self.random.random(), 6) for _ in range(3)] + [1]
            return _call("color", color, children=children)
        name = self.random.choice(["union", "difference", "difference", "difference", "intersection", "render"])
        return _call(name, children=children)

    def body(self) -> Node:
        """One primitive or one extrusion."""
        if self.is_one_of("extrusions"):
            return self.random.choice([self.drawn_out, self.drawn_out, self.turned_around, self.cut_through])()
        if self.family == "grid":
            return self.cube()
        return self.random.choice([self.cube, self.sphere, self.cylinder, self.cylinder, self.octahedron])()

    def size(self) -> float:
        if self.family == "grid":
            return self.random.randint(1, 4)
        return self.random.choice([self.random.randint(1, 6), round(self.random.uniform(0.5, 6.0), 3)])

    def cube(self) -> Node:
        return _call("cube", size=[self.size() for _ in range(3)], center=self.chance(0.4))

    def sphere(self) -> Node:
        return _call("sphere", **self.resolution(), r=self.size())

    def cylinder(self) -> Node:
        low = self.size()
        high = self.random.choice([low, low, 0, self.size()])
        return _call("cylinder", **self.resolution(), h=self.size(), r1=low, r2=high, center=self.chance(0.4))

    def octahedron(self) -> Node:
        """A closed mesh; now and then inside out."""
        r, h = self.size(), self.size()
        points = [[r, 0, 0], [0, r, 0], [-r, 0, 0], [0, -r, 0], [0, 0, h], [0, 0, -h]]
        faces = [[4, (i + 1) % 4, i] for i in range(4)] + [[5, i, (i + 1) % 4] for i in range(4)]
        faces = [face[::-1] for face in faces] if self.is_one_of("lenient") and self.chance(0.3) else faces
        return _call("polyhedron", points=points, faces=faces, convexity=1)

    def small_body(self) -> Node:
        return self.random.choice(
            [
                _call("cube", size=[0.5, 0.5, 0.25], center=True),
                _call("sphere", S_fn=6, S_fa=12, S_fs=2, r=0.5),
                _call("cylinder", S_fn=5, S_fa=12, S_fs=2, h=0.5, r1=0.5, r2=0.25, center=False),
            ]
        )

    def resolution(self) -> dict:
        return {
            "S_fn": self.random.choice([0, 0, 3, 4, 5, 6, 8, 12, 17]),
            "S_fa": 12,
            "S_fs": self.random.choice([2, 0.7]),
        }

    def placed(self, node: Node) -> Node:
        """Moved; turned too, where the family does so."""
        if self.chance(0.15):
            return node
        shift = [self.random.randint(-4, 4) for _ in range(3)]
        rows = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        if self.family != "grid" and self.chance(0.5):
            rows = self.turn()
            shift = [round(self.random.uniform(-4, 4), 3) for _ in range(3)]
        matrix = [[*row, by] for row, by in zip(rows, shift)] + [[0, 0, 0, 1]]
        return _call("multmatrix", matrix, children=[node])

    def turn(self) -> list[list[float]]:
        """A turn about one axis, a scale, a mirror; six digits each."""
        kind = self.random.random()
        if kind < 0.2:
            return [[self.random.choice([-1, 0.5, 1, 2]) if i == j else 0 for j in range(3)] for i in range(3)]
        c, s = unit_circle(self.random.choice([8, 12, 72, 360, 1000]))[self.random.randint(1, 7)].tolist()
        axis = self.random.randrange(3)
        rows = [[1.0 if i == j else 0.0 for j in range(3)] for i in range(3)]
        i, j = (k for k in range(3) if k != axis)
        rows[i][i], rows[i][j], rows[j][i], rows[j][j] = c, -s, s, c
        return rows

    def drawn_out(self) -> Node:
        """An extrusion; a third of them twisted or with two scales."""
        named = {"height": self.size(), "center": self.chance(0.3), "convexity": 1} | self.resolution()
        kind = self.random.random()
        if kind < 0.2:
            named["twist"] = self.random.choice([-90, 15, 45, 60, 200])
            # With fewer layers, sides may cross each other.
            named["slices"] = self.random.randint(1, 4) + abs(named["twist"]) // 20
            if self.chance(0.5):
                del named["slices"]
                named["S_fn"] = self.random.choice([0, 18])
        if kind < 0.1 or kind > 0.8:
            named["scale"] = self.random.choice([[2, 2], [0.5, 1], [0.3, 0.3], [1, 1.5]])
        return _call("linear_extrude", **named, children=[self.outline(2)])

    def turned_around(self) -> Node:
        named = {"angle": self.random.choice([360, 360, 90, 200, -120]), "convexity": 2}
        away = self.random.choice([0, 7, 9])
        inside = self.outline(1) if away else _call("square", size=[self.size(), self.size()], center=False)
        moved = _call("multmatrix", [[1, 0, 0, away], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], children=[inside])
        resolution = self.resolution()
        if resolution["S_fn"] and named["angle"] != 360:
            # One piece of half a turn or more crosses itself.
            resolution["S_fn"] = max(resolution["S_fn"], 5)
        return _call("rotate_extrude", **named, **resolution, children=[moved])

    def cut_through(self) -> Node:
        """The section or the shadow of a body, drawn out."""
        body = self.placed(self.random.choice([self.cube, self.sphere, self.cylinder])())
        flat = _call("projection", cut=self.chance(0.5), convexity=0, children=[body])
        return _call(
            "linear_extrude", height=self.size(), center=False, convexity=1, **self.resolution(), children=[flat]
        )

    def outline(self, depth: int) -> Node:
        """Something flat."""
        if depth == 0 or self.chance(0.3):
            return self.random.choice([self.square, self.circle, self.polygon])()
        kind = self.random.random()
        children = [self.outline(depth - 1) for _ in range(self.random.randint(1, 3))]
        if kind < 0.25:
            by = self.random.choice(
                [{"r": 0.5}, {"r": -0.3}, {"delta": 0.4, "chamfer": False}, {"delta": 0.4, "chamfer": True}]
            )
            return _call("offset", **by, **self.resolution(), children=children)
        if kind < 0.35:
            return _call("hull", children=children)
        if kind < 0.42:
            return _call("minkowski", children=[children[0], _call("square", size=[0.5, 0.25], center=True)])
        return _call(self.random.choice(["union", "difference", "intersection"]), children=children)

    def square(self) -> Node:
        return _call("square", size=[self.size(), self.size()], center=self.chance(0.5))

    def circle(self) -> Node:
        return _call("circle", **self.resolution(), r=self.size() / 2)

    def polygon(self) -> Node:
        """A star around the origin."""
        count = self.random.randint(3, 9)
        corners = unit_circle(count) * [[self.random.uniform(1, 4)] for _ in range(count)]
        return _call("polygon", points=corners.round(3).tolist(), paths=None, convexity=1)

    def nothing(self) -> Node:
        return _call("group")

    def without_size(self) -> Node:
        return _call("cube", size=[self.random.choice([0, -1, 2]), -2, 1], center=False)

    def flattened(self) -> Node:
        flat = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]
        return _call("multmatrix", flat, children=[self.cube()])

    def outline_among_solids(self) -> Node:
        return _call("group", children=[self.cube(), self.square()])

    def resized(self) -> Node:
        size = [self.random.choice([0, 2, 5]) for _ in range(3)]
        return _call("resize", newsize=size, auto=[self.chance(0.5)] * 3, convexity=0, children=[self.body()])


_NOTHING = [_Maker.nothing, _Maker.without_size, _Maker.flattened, _Maker.outline_among_solids, _Maker.resized]
