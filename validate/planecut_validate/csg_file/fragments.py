"""How many pieces OpenSCAD 2021.01 makes of circles and twists, from `$fn`, `$fa`, `$fs`."""

import math
from dataclasses import dataclass

import numpy as np

from ..angles import cosine, sine
from .text import Node
from .values import number

_FINE = 0.00000095367431640625
"""Radii below this are one point's."""
_SMALLEST = 0.01
"""Least `$fa` and `$fs`."""


@dataclass(frozen=True)
class Resolution:
    """The three special variables of a node."""

    fn: float
    fa: float
    fs: float

    @classmethod
    def of(cls, node: Node) -> "Resolution":
        """Those of the node, and OpenSCAD's where it names none."""
        fn, fa, fs = (number(node.get(name), default) for name, default in (("$fn", 0.0), ("$fa", 12.0), ("$fs", 2.0)))
        return cls(fn, max(fa, _SMALLEST), max(fs, _SMALLEST))

    def fragments(self, radius: float) -> int:
        """Corners of a whole circle."""
        if radius < _FINE or math.isinf(self.fn) or math.isnan(self.fn):
            return 3
        if self.fn > 0.0:
            return int(max(self.fn, 3.0))
        return math.ceil(max(min(360.0 / self.fa, radius * 2.0 * math.pi / self.fs), 5.0))

    def slices(self, loops: list[np.ndarray], height: float, twist: float, scale: tuple[float, float]) -> int:
        """Layers of an extrusion that names none."""
        points = np.concatenate(loops)
        if twist != 0.0:
            return self._twisted(float(np.square(points).sum(1).max()), height, abs(twist), scale)
        if scale[0] == scale[1]:
            return 1
        shift = math.sqrt(np.square(points - points * scale).sum(1).max())
        if shift < _FINE or not math.isfinite(self.fn):
            return 1
        if self.fn > 0.0:
            return max(int(self.fn), 1)
        return max(math.ceil(math.hypot(shift, height) / self.fs), 1)

    def _twisted(self, square: float, height: float, twist: float, scale: tuple[float, float]) -> int:
        least = max(math.ceil(twist / 120.0), 1)
        radius = math.sqrt(square)
        if radius < _FINE or not math.isfinite(self.fn):
            return least
        if self.fn > 0.0:
            return max(math.ceil(twist / 360.0 * self.fn), least)
        turn = math.radians(twist)
        if scale[0] == scale[1] != 1.0:
            length = math.hypot(_spiral(radius, turn, scale[0]), height)
        else:
            # A vertex goes along a helix; with two scales OpenSCAD takes the plain one as well.
            length = turn * math.sqrt(square + (height / turn) ** 2)
        return max(min(math.ceil(twist / self.fa), math.ceil(length / self.fs)), least)


def _spiral(radius: float, turn: float, scale: float) -> float:
    """Length of the part of an Archimedean spiral that a vertex follows."""
    end = turn * scale / (scale - 1.0) if scale > 1.0 else turn / (1.0 - scale)
    growth = radius / end

    def length(angle: float) -> float:
        return 0.5 * growth * (angle * math.sqrt(1.0 + angle * angle) + math.asinh(angle))

    return length(end) - length(end - turn)


def unit_circle(count: int) -> np.ndarray:
    """Corners `(count, 2)` counter-clockwise from the x axis, short values exact."""
    angles = np.arange(count) * 360.0 / count
    points = np.column_stack([np.cos(np.radians(angles)), np.sin(np.radians(angles))])
    for index in np.nonzero((angles % 30.0 == 0.0) | (angles % 45.0 == 0.0))[0]:
        points[index] = cosine(angles[index]), sine(angles[index])
    return points
