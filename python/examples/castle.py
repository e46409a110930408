"""A castle with battlements, a gate and five towers. Writes castle.glb and castle.png.

    python examples/castle.py [output folder]
"""

import sys
from pathlib import Path

import numpy as np
import planecut as pc

COLORS = dict(street=[0.30, 0.29, 0.28], grass=[0.24, 0.42, 0.13], bark=[0.16, 0.09, 0.05], leaves=[0.12, 0.30, 0.07])
COLORS |= dict(plaster=[0.82, 0.74, 0.60], ochre=[0.72, 0.49, 0.24], chalk=[0.80, 0.79, 0.76], brick=[0.42, 0.14, 0.08])
COLORS |= dict(tiles=[0.42, 0.08, 0.04], clay=[0.30, 0.11, 0.06], slate=[0.11, 0.15, 0.21], stone=[0.45, 0.43, 0.40])
COLORS |= dict(glass=[0.07, 0.12, 0.18], wood=[0.20, 0.10, 0.04])


def of(material, solid):
    """The solid in a material; what is cut out shows that of what cuts."""
    return solid.with_material(material, color=COLORS[material])


def tower(radius, height):
    """A round tower with a conical roof and slits on all sides."""
    slit = of("glass", pc.box([radius - 0.3, -0.25, 0], [radius + 1, 0.25, 1.8]))
    heights = np.arange(3, height - 3, 4)
    slits = [slit.translate([0, 0, z]).rotate("z", 60 * k + 30 * z) for z in heights for k in range(6)]
    gallery = pc.cylinder(1.2, radius, radius + 0.8, segments=24).translate([0, 0, height - 1.2])
    roof = of("slate", pc.cylinder(2.2 * radius, radius + 1.1, 0, segments=24)).translate([0, 0, height])
    return pc.difference(of("stone", pc.cylinder(height, radius, segments=24) | gallery), slits) | roof


def castle(side=9.5):
    """Walls with battlements and a gate, and five towers; the walls are `side` from the middle."""
    gaps = [pc.box([k - 0.5, -side - 1, 5], [k + 0.5, -side + 1, 7]) for k in np.arange(-side + 2.5, side - 2, 2)]
    wall = of("stone", pc.difference(pc.box([-side, -side - 0.8, 0], [side, -side + 0.8, 6]), gaps))
    gate = pc.cylinder(4, 1.5, segments=24).rotate("x", 90).translate([0, -side + 2, 2.5])
    gate |= pc.box([-1.5, -side - 2, 0], [1.5, -side + 2, 2.5])
    corners = [tower(2.2, 11).translate([x, y, 0]) for x in (-side, side) for y in (-side, side)]
    walls = pc.union([wall.rotate("z", 90 * k) for k in range(4)])
    return pc.union([walls - of("wood", gate), tower(4.2, 23), *corners])


def main(folder=".", size=(1200, 900)):
    """Writes the castle and its picture; returns the solid."""
    solid = castle() | of("grass", pc.box([-14, -14, -1], [14, 14, 0]))
    solid.save(Path(folder) / "castle.glb")
    solid.save(Path(folder) / "castle.png", size=size, azimuth=-60, elevation=24)
    return solid


if __name__ == "__main__":
    main(*sys.argv[1:2])
