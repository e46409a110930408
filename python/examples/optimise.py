"""Where does the liquid in a tilted tank stand? Newton's method with the volume below a plane, and its derivative.

The derivative of the volume by the plane's offset is the area of the liquid's surface: the face that the plane carries.

python examples/optimise.py
"""

import numpy as np
import planecut as pc
from scipy.optimize import minimize_scalar, root_scalar

TANK = [[1, 0, 0, 1.0], [-1, 0, 0, 0.0], [0, 1, 0, 0.6], [0, -1, 0, 0.0], [0, 0, 1, 0.8], [0, 0, -1, 0.0]]
"""A box of 1.0 by 0.6 by 0.8 metres; any convex body will do."""


class Liquid:
    """What lies in a tank below a plane that can be moved along its normal."""

    def __init__(self, tank, up):
        """A tank of planes of shape (k, 4), and the direction that is up."""
        self.body = pc.Polytope(tank)
        up = np.asarray(up, dtype=float)
        up /= np.linalg.norm(up)
        heights = self.body.vertices @ up
        self.low, self.high = heights.min(), heights.max()
        self.surface = self.body.add_plane([*up, self.high])

    def at(self, offset):
        """The volume when the surface has an offset, and its derivative by the offset."""
        self.body.move_plane(self.surface, offset)
        return self.body.volume, self.body.face_area(self.surface)

    def level(self, volume):
        """The offset of the surface of a volume, by Newton's method."""

        def error(offset):
            now, area = self.at(offset)
            return now - volume, area

        # the volume grows all the way between both ends; where Newton's step leaves them, bisect
        guess = self.low + (self.high - self.low) * 0.5
        found = root_scalar(error, x0=guess, fprime=True, method="newton", xtol=1e-15)
        if found.converged and self.low <= found.root <= self.high:
            return found.root
        return root_scalar(
            lambda offset: error(offset)[0], bracket=(self.low, self.high), method="brentq", xtol=1e-15
        ).root


def tilted(degrees):
    """The direction that is up for a tank turned about the y axis."""
    angle = np.radians(degrees)
    return np.array([np.sin(angle), 0.0, np.cos(angle)])


def largest_surface(volume, tank=TANK):
    """The angle, up to 60 degrees, at which the surface of a volume of liquid is largest; returns degrees and the area.

    One solver works within another.
    """

    def area(degrees):
        liquid = Liquid(tank, tilted(degrees))
        return -liquid.at(liquid.level(volume))[1]

    found = minimize_scalar(area, bounds=(0.0, 60.0), method="bounded", options={"xatol": 1e-9})
    return found.x, -found.fun


def main(volume=0.24):
    """Returns the offsets of the surface by angle, and the angle at which the surface is largest, with its area."""
    offsets = {degrees: Liquid(TANK, tilted(degrees)).level(volume) for degrees in (0, 10, 20, 30, 45)}
    return offsets, largest_surface(volume)


if __name__ == "__main__":
    offsets, (degrees, area) = main()
    for angle, offset in offsets.items():
        print(f"tilted by {angle} degrees: the surface of 240 litres is {offset:.12f} m from the origin")
    print(f"the surface is largest, {area:.9f} square metres, at {degrees:.6f} degrees")
