"""A procedural town: houses with gables, streets, trees and a castle. Writes town.glb and town.png.

    python examples/town.py [output folder]
"""

import sys
from pathlib import Path

import numpy as np
import planecut as pc
from castle import castle, of

BLOCK, STREET = 22.0, 5.0  # metres: a block of four houses, and the street around it


def upright(outline, depth):
    """An outline in x and z, extruded to both sides along y."""
    return pc.extrude(outline, depth).rotate("x", 90).translate([0, depth / 2, 0])


def house(width, depth, height, walls, roof):
    """A house with its door in front, towards negative y, below a gable."""
    x, y, top, low, out = width / 2, depth / 2, height + width * 0.45, height - 0.45, width / 2 + 0.5
    body = of(walls, upright([[-x, 0], [x, 0], [x, height], [0, top], [-x, height]], depth))
    eaves = [[-out, low], [0, top], [out, low], [out, low + 0.35], [0, top + 0.35], [-out, low + 0.35]]
    chimney = of("brick", pc.box([x / 2 - 0.4, -0.4, height], [x / 2 + 0.4, 0.4, top + 0.6]))
    window = of("glass", pc.box([-0.45, -0.2, 0], [0.45, 0.2, 1.3]))
    holes = [of("wood", pc.box([-0.6, -y - 1, 0], [0.6, -y + 0.25, 2.2]))]
    for z in np.arange(1.0, height - 1.0, 2.8):
        for place in np.linspace(-x + 1.2, x - 1.2, round(width / 2) - 1):
            holes += [window.translate([place, side, z]) for side in (-y, y) if side > 0 or z > 2 or abs(place) > 1.1]
        for place in np.linspace(-y + 1.4, y - 1.4, round(depth / 2) - 1):
            holes += [window.rotate("z", 90).translate([side, place, z]) for side in (-x, x)]
    return pc.difference(body, holes) | of(roof, upright(eaves, depth + 0.8)) | chimney


def tree(size):
    """A trunk and a crown."""
    crown = of("leaves", pc.sphere(size, segments=12)).scale([1, 1, 1.2]).translate([0, 0, 1.6 + size])
    return of("bark", pc.cylinder(2, 0.25, segments=8)) | crown


def town(blocks=5, seed=11):
    """A square of blocks between streets, with the castle in the middle."""
    rng, pitch, half = np.random.default_rng(seed), BLOCK + STREET, BLOCK / 2
    reach = (blocks * pitch + STREET) / 2
    parts = [of("street", pc.box([-reach, -reach, -2], [reach, reach, 0]))]
    for row, column in np.ndindex(blocks, blocks):
        is_middle = row == column == blocks // 2
        block = [of("grass", pc.box([-half, -half, -1.2], [half, half, 0]))] + [castle(BLOCK / 2 - 1.5)] * is_middle
        for quarter in range(0 if is_middle else 4):
            lot = [*rng.uniform(-0.5, 0.5, 2) + [half / 2, -half / 2], 0]
            plot = pc.union([tree(rng.uniform(1.2, 2)).translate([*rng.uniform(-3.5, 3.5, 2), 0]) for _ in range(4)])
            if rng.random() < 0.85:
                walls, roof = rng.choice(["plaster", "ochre", "chalk", "brick"]), rng.choice(["tiles", "clay", "slate"])
                plot = house(*rng.uniform([6, 7, 3.6], [8.2, 9, 8.5]), walls, roof)
            block.append(plot.translate(lot).rotate("z", 90 * quarter))
        place = (np.array([column, row]) - (blocks - 1) / 2) * pitch
        parts.append(pc.union(block).translate([*place, 0.2]))
    return pc.union(parts)


def main(folder=".", blocks=5, size=(1600, 900)):
    """Writes the town and its picture; returns the solid."""
    solid = town(blocks)
    solid.save(Path(folder) / "town.glb")
    solid.save(Path(folder) / "town.png", size=size, azimuth=-56, elevation=26)
    return solid


if __name__ == "__main__":
    made = main(*sys.argv[1:2])
    print(f"{made}: volume {made.volume:.1f} cubic metres, {len(made.mesh().triangles)} triangles")
