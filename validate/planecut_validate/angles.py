"""Sines and cosines of degrees, without rounding where the values are short."""

import math

_SHORT = {0.0: 0.0, 30.0: 0.5, 90.0: 1.0}


def sine(degrees: float) -> float:
    """The sine, exact for multiples of 30° where it is 0, ½ or 1."""
    turn = math.fmod(degrees, 360.0)
    if turn < 0:
        return -sine(-turn)
    if turn >= 180.0:
        return -sine(turn - 180.0) if turn > 180.0 else 0.0
    if turn > 90.0:
        turn = 180.0 - turn
    return _SHORT.get(turn, math.sin(math.radians(turn)))


def cosine(degrees: float) -> float:
    """The cosine, exact for multiples of 30° where it is 0, ½ or 1."""
    return sine(90.0 - abs(math.fmod(degrees, 360.0)))


def circle(radius: float, segments: int) -> list[tuple[float, float]]:
    """The corners of a circle, counter-clockwise from the x axis."""
    angles = [360.0 * i / segments for i in range(segments)]
    return [(radius * cosine(a), radius * sine(a)) for a in angles]
