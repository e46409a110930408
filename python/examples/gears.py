"""A family of involute spur gears, with bores and keyways, and pairs that mesh. Writes gears.glb and gears.png.

python examples/gears.py [output folder]
"""

import sys
from pathlib import Path

import numpy as np
import planecut as pc


def involute(base, radius):
    """The polar angle of the involute of a circle of radius `base` at a distance from the center."""
    pressure = np.arccos(np.clip(base / radius, -1, 1))
    return np.tan(pressure) - pressure


def outline(module, teeth, pressure_angle=20.0, backlash=0.0, steps=8):
    """The outline of a spur gear around the origin, shape (n, 2), with the middle of a tooth on the x axis.

    Module and backlash are lengths; the pressure angle is in degrees. Teeth reach one module above the pitch circle and
    1.25 modules below it.
    """
    pitch = module * teeth / 2
    base = pitch * np.cos(np.radians(pressure_angle))
    tip, root = pitch + module, pitch - 1.25 * module
    # half of the tooth's angle on the pitch circle, then at each radius of the flank
    half = np.pi / (2 * teeth) - backlash / (4 * pitch) + involute(base, pitch)
    radii = np.linspace(max(base, root), tip, steps)
    angles = half - involute(base, radii)
    if angles[-1] <= 0:
        raise ValueError(
            f"teeth: found {teeth}, whose flanks meet below the tip; expected more, or a smaller pressure angle"
        )
    if root < base:
        radii, angles = np.r_[root, radii], np.r_[half, angles]
    radii, angles = np.r_[radii, radii[::-1]], np.r_[-angles, angles[::-1]]
    turns = 2 * np.pi * np.arange(teeth)[:, None] / teeth + angles
    return np.stack([radii * np.cos(turns), radii * np.sin(turns)], axis=-1).reshape(-1, 2)


def bore_outline(radius, key_width, key_depth, segments=48):
    """A circle with a keyway on the side of positive x, shape (n, 2)."""
    start = np.arcsin(key_width / 2 / radius)
    angles = np.linspace(start, 2 * np.pi - start, segments)
    circle = radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    key = radius + key_depth
    return np.concatenate([circle, [[key, -key_width / 2], [key, key_width / 2]]])


def gear(module, teeth, width, bore=None, pressure_angle=20.0, backlash=0.0, material="steel"):
    """A gear along z from 0, and the area of its outline. `bore` is radius, key width and key depth."""
    loops = [outline(module, teeth, pressure_angle, backlash)]
    if bore is not None:
        loops.append(bore_outline(*bore))
    area = area_of(loops[0]) - sum(map(area_of, loops[1:]))
    return pc.extrude(loops, width, material=material), area


def area_of(loop):
    """The area within a loop, by the shoelace formula."""
    x, y = np.transpose(loop)
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def train(gears, module, angle=0.0):
    """Gears side by side, each driving the next, when the first is turned by an angle in degrees.

    `gears` are pairs: number of teeth and solid.
    """
    placed, x, turn = [], 0.0, angle
    for number, (teeth, solid) in enumerate(gears):
        if number > 0:
            before = gears[number - 1][0]
            x += module * (before + teeth) / 2
            # how far a tooth of the gear before is past the line of centers, in steps of its teeth: there this one,
            # which turns the other way, has a gap
            past = turn * before / 360.0
            turn = 180.0 + (0.5 - past) * 360.0 / teeth
        placed.append(solid.rotate("z", turn).translate([x, 0, 0]))
    return placed


def main(folder=".", module=2.0, family=(12, 18, 24, 40), width=10.0):
    """Writes a train of gears; returns the number of teeth, the solid and the area of the outline of each."""
    made = []
    for teeth, material in zip(family, ["steel", "brass", "copper", "iron"]):
        radius = module * teeth / 5
        solid, area = gear(
            module, teeth, width, (radius, radius / 2, radius / 5), backlash=0.05 * module, material=material
        )
        made.append((teeth, solid, area))
    together = pc.union(train([(teeth, solid) for teeth, solid, _ in made], module))
    together.save(Path(folder) / "gears.glb")
    together.save(Path(folder) / "gears.png", size=(1600, 640), azimuth=-75, elevation=50)
    return made


if __name__ == "__main__":
    family = main(*sys.argv[1:2])
    for teeth, solid, area in family:
        difference = abs(solid.volume / (area * 10) - 1)
        print(f"{teeth} teeth: volume {solid.volume:.6f}, that of outline and width differs by {difference:.1e} of it")
    turned = train([(teeth, solid) for teeth, solid, _ in family], 2.0, angle=4.0)
    print(
        "volume in which neighbours overlap, turned by 4 degrees:", [(a & b).volume for a, b in zip(turned, turned[1:])]
    )
