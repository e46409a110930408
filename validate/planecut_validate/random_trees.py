"""Random models for the checks: boxes on a grid, turned boxes, spheres, cylinders, half-spaces, and faces that coincide."""

import random

FAMILIES = ("grid", "turned", "round", "mixed", "deep", "generic")
"""Kinds of trees: boxes on a grid; boxes turned; spheres and cylinders; all of these; all of these in long chains; turned
boxes and spheres of which no two faces lie in one plane."""


def random_document(seed: int, most_leaves: int) -> dict:
    """A model file with a bounded tree with a maximum number of leaves; the same seed gives the same one."""
    maker = _Maker(random.Random(seed), FAMILIES[seed % len(FAMILIES)])
    return document(maker.bounded(maker.random.randint(2, max(2, most_leaves))))


def random_node(seed: int, leaves: int, family: str = "mixed") -> dict:
    """A bounded NODE with this number of leaves."""
    return _Maker(random.Random(seed), family).bounded(leaves)


def document(node: dict) -> dict:
    """The model file of a node."""
    return {"planecut": 1, "model": node}


class _Maker:
    """Makes nodes; remembers leaves, because copies of earlier ones have faces that coincide with theirs."""

    def __init__(self, source: random.Random, family: str):
        self.random = source
        self.family = family
        self.earlier: list[dict] = []

    def bounded(self, leaves: int) -> dict:
        """A bounded node. Unbounded ones may be operands where others bound them."""
        if leaves == 1:
            return self.leaf()
        chance = self.random.random()
        if chance < 0.04:
            return {"complement": {"complement": self.bounded(leaves)}}
        if chance < 0.45:
            return {"union": [self.bounded(n) for n in self.shares(leaves)]}
        if chance < 0.60:
            return {"xor": [self.bounded(n) for n in self.shares(leaves)]}
        first, *others = self.shares(leaves)
        kind = "difference" if chance < 0.87 else "intersection"
        return {kind: [self.bounded(first)] + [self.any(n, keep=kind == "intersection") for n in others]}

    def any(self, leaves: int, keep: bool) -> dict:
        """A node that may be unbounded; with `keep` one that holds much of space, else little."""
        chance = self.random.random()
        if leaves == 1:
            if chance < 0.25:
                return self.half_space()
            return {"complement": self.leaf()} if keep else self.leaf()
        if chance < 0.10:
            return {"intersection" if keep else "union": [self.any(n, keep) for n in self.shares(leaves)]}
        return {"complement": self.bounded(leaves)} if keep and chance < 0.75 else self.bounded(leaves)

    def shares(self, leaves: int) -> list[int]:
        """Splits leaves among operands: two or many, alike or, for a chain, one beside all others."""
        if self.family == "deep":
            return [leaves - 1, 1] if self.random.random() < 0.85 else [1, leaves - 1]
        count = self.random.choice([2, 2, 2, 3, 4, 8, 16])
        cuts = sorted(self.random.sample(range(1, leaves), min(count, leaves) - 1))
        return [b - a for a, b in zip([0, *cuts], [*cuts, leaves])]

    def leaf(self) -> dict:
        """A body; now and then a copy of an earlier one."""
        if self.earlier and self.family != "generic" and self.random.random() < 0.08:
            return self.random.choice(self.earlier)
        node = self.random.choice(_LEAVES[self.family])(self)
        self.earlier.append(node)
        return node

    def grid_box(self) -> dict:
        low = [self.random.randint(0, 6) for _ in range(3)]
        return {"box": {"min": low, "max": [c + self.random.randint(1, 4) for c in low]}}

    def decimal_box(self) -> dict:
        """Sides that are no short binary numbers."""
        low = [self.random.randint(0, 60) / 10 for _ in range(3)]
        return {"box": {"min": low, "max": [round(c + self.random.randint(5, 40) / 10, 1) for c in low]}}

    def turned_box(self) -> dict:
        size = [self.random.uniform(0.5, 4.0) for _ in range(3)]
        return {"box": {"min": [0, 0, 0], "max": size}, "transform": [self.turn(), self.shift()]}

    def turned_grid_box(self) -> dict:
        """All turned alike, so that sides coincide but for rounding."""
        return self.grid_box() | {"transform": [{"rotate": [20, 35, -50]}, {"translate": [2, 1, 5]}]}

    def sphere(self) -> dict:
        radius = self.random.uniform(0.5, 2.5)
        return {
            "sphere": {"radius": radius, "segments": self.random.randint(4, 12)},
            "transform": [self.turn(), self.shift()],
        }

    def grid_sphere(self) -> dict:
        shape = {"radius": self.random.randint(1, 3), "segments": self.random.choice([4, 6, 8, 12])}
        return {"sphere": shape, "transform": [{"translate": [self.random.randint(1, 8) for _ in range(3)]}]}

    def cylinder(self) -> dict:
        shape = {
            "height": self.random.randint(1, 5),
            "radius": self.random.choice([0.5, 1, 1.5, 2]),
            "segments": self.random.randint(3, 12),
        }
        if self.random.random() < 0.3:
            shape["top_radius"] = self.random.choice([0, 0.5, 1])
        place = [self.random.randint(0, 8) for _ in range(3)]
        return {"cylinder": shape, "transform": [*([self.turn()] * (self.random.random() < 0.4)), {"translate": place}]}

    def half_space(self) -> dict:
        if self.family != "generic" and (self.random.random() < 0.4 or self.family == "grid"):
            normal = [0, 0, 0]
            normal[self.random.randrange(3)] = self.random.choice([-1, 1])
            return {"halfspaces": [[*normal, sum(normal) * self.random.randint(1, 8)]]}
        normal = [self.random.uniform(-1, 1) for _ in range(3)]
        point = [self.random.uniform(1, 8) for _ in range(3)]
        return {"halfspaces": [[*normal, sum(n * p for n, p in zip(normal, point))]]}

    def turn(self) -> dict:
        return {"rotate": [self.random.randint(-180, 180) for _ in range(3)]}

    def shift(self) -> dict:
        return {"translate": [round(self.random.uniform(1, 8), 3) for _ in range(3)]}


_LEAVES = {
    "grid": [_Maker.grid_box],
    "turned": [_Maker.turned_box, _Maker.turned_grid_box, _Maker.decimal_box],
    "round": [_Maker.sphere, _Maker.grid_sphere, _Maker.cylinder],
    "generic": [_Maker.turned_box, _Maker.sphere],
    "mixed": [
        _Maker.grid_box, _Maker.decimal_box, _Maker.turned_box, _Maker.turned_grid_box, _Maker.sphere, _Maker.grid_sphere,
        _Maker.cylinder,
    ],
}  # fmt: skip
_LEAVES["deep"] = _LEAVES["mixed"]
