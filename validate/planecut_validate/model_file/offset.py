"""Outlines grown or shrunk: a strip along each edge and a join at each corner, added or taken away."""

import math

import numpy as np

from .arrangement import combine

_MITER_LIMIT = 4.0
"""Distance of a mitered corner from the one it goes around, in distances of the offset, beyond which it is bevelled."""


def offset(loops: list[np.ndarray], by: float, join: str, segments: int) -> list[np.ndarray]:
    """Loops with the inside on their left, moved outwards by `by`, inwards where it is negative."""
    if by == 0.0 or not loops:
        return loops
    pieces = [piece for loop in loops for piece in _pieces(loop, by, join, segments)]
    if by > 0:
        return combine([loops, *([p] for p in pieces)], lambda within: within.any(1))
    return combine([loops, *([p] for p in pieces)], lambda within: within[:, 0] & ~within[:, 1:].any(1))


def _pieces(loop: np.ndarray, by: float, join: str, segments: int) -> list[np.ndarray]:
    """The strip of each edge on the side to which it moves, and what fills the gap between two strips."""
    following = np.roll(loop, -1, axis=0)
    along = following - loop
    along /= np.linalg.norm(along, axis=1)[:, None]
    moves = by * np.column_stack([along[:, 1], -along[:, 0]])
    pieces = []
    for k in range(len(loop)):
        a, b, move = loop[k], following[k], moves[k]
        pieces.append(np.array([a, b, b + move, a + move]))
        before, u, v = moves[k - 1], along[k - 1], along[k]
        # The strips part where the loop turns away from the side they are on.
        if by * (u[0] * v[1] - u[1] * v[0]) > 0:
            pieces.append(np.array([a, a + before, *_join(a, before, move, by, join, segments), a + move]))
    return pieces


def _join(
    corner: np.ndarray, before: np.ndarray, after: np.ndarray, by: float, join: str, segments: int
) -> list[np.ndarray]:
    """The points between the ends of two strips."""
    turn = math.atan2(before[0] * after[1] - before[1] * after[0], float(before @ after))
    if join == "bevel":
        return []
    if join == "miter":
        middle = before + after
        length = by * by / float(middle @ middle) * 2.0
        tip = middle * length
        return [corner + tip] if np.linalg.norm(tip) <= _MITER_LIMIT * abs(by) else []
    steps = max(1, math.ceil(abs(turn) / (2.0 * math.pi) * segments - 1e-9))
    angles = [turn * i / steps for i in range(1, steps)]
    return [
        corner + [math.cos(a) * before[0] - math.sin(a) * before[1], math.sin(a) * before[0] + math.cos(a) * before[1]]
        for a in angles
    ]
