"""Set operations on intervals along lines: a solid's tree, evaluated on every line at once.

The ends of all leaves on a line fall into *places*: groups of ends that are closer than what counts as touching. Places
are numbered along the lines, one line after the other, so that a set on all lines is one sorted array of the places where
inside turns to outside or back, and every operation is a count along that array.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .lines import SURELY_TOUCHING, TOUCHING


@dataclass
class Ends:
    """Where lines enter (`sign` −1) and leave (`sign` +1) one body; `begins`: lines that come from within it.

    `unclear`: lines for which this hangs on less than floating point can tell.
    """

    line: np.ndarray
    t: np.ndarray
    sign: np.ndarray
    begins: np.ndarray
    unclear: np.ndarray


@dataclass
class IntervalSet:
    """`places`: ascending, where inside changes; `signs`: +1 into, −1 out of the set; `begins`: per line, inside at −∞."""

    places: np.ndarray
    signs: np.ndarray
    begins: np.ndarray


class Places:
    """The places of many bodies' ends on `lines` lines. `size`: the model's diagonal."""

    def __init__(self, bodies: list[Ends], lines: int, size: float):
        line = np.concatenate([np.zeros(0, dtype=np.int64)] + [b.line for b in bodies])
        t = np.concatenate([np.zeros(0)] + [b.t for b in bodies])
        order = np.lexsort((t, line))
        line, t = line[order], t[order]
        gap = np.where(line[1:] == line[:-1], t[1:] - t[:-1], np.inf)
        place = np.zeros(len(line), dtype=np.int64)
        place[1:] = np.cumsum(gap > TOUCHING * size)
        self.doubtful = np.zeros(lines, dtype=bool)
        self.doubtful[line[1:][(gap > SURELY_TOUCHING * size) & (gap <= TOUCHING * size)]] = True
        first = np.concatenate([np.ones(min(1, len(place)), dtype=bool), place[1:] != place[:-1]])
        self.line, self.t = line[first], t[first]
        self.first = np.searchsorted(self.line, np.arange(lines))
        back = np.empty_like(place)
        back[order] = place
        counts = np.cumsum([0] + [len(b.line) for b in bodies])
        self.sets = [self._set(body, back[a:b]) for body, a, b in zip(bodies, counts[:-1], counts[1:])]

    def _set(self, body: Ends, places: np.ndarray) -> IntervalSet:
        begins = np.zeros(len(self.first), dtype=bool)
        begins[body.begins] = True
        order = np.argsort(places, kind="stable")
        whole = IntervalSet(places[order], -body.sign[order], begins)
        return self.combine([whole], [1], lambda count: count > 0)

    def combine(self, sets: list[IntervalSet], weights: list[int], inside: Callable) -> IntervalSet:
        """The set of all that `inside` accepts, of the sum of the weights of the sets that hold it."""
        base = np.zeros(len(self.first), dtype=np.int64)
        for part, weight in zip(sets, weights):
            base += weight * part.begins
        places = np.concatenate([np.zeros(0, dtype=np.int64)] + [s.places for s in sets])
        steps = np.concatenate([np.zeros(0, dtype=np.int64)] + [w * s.signs for s, w in zip(sets, weights)])
        begins = np.broadcast_to(inside(base), base.shape)
        if not len(places):
            return IntervalSet(places, steps, begins)
        order = np.argsort(places, kind="stable")
        places, steps = places[order], steps[order]
        first = np.nonzero(np.concatenate([[True], places[1:] != places[:-1]]))[0]
        places, steps = places[first], np.add.reduceat(steps, first)
        total = np.concatenate([[0], np.cumsum(steps)])
        line = self.line[places]
        before_line = total[np.searchsorted(places, self.first)]
        after = base[line] + total[1:] - before_line[line]
        now, was = inside(after), inside(after - steps)
        changes = now != was
        return IntervalSet(places[changes], np.where(now[changes], 1, -1), begins)


def apply(places: Places, operation: str, operands: list[IntervalSet]) -> IntervalSet:
    """`union`, `intersection`, `difference`, `xor` or `complement` of sets."""
    count = len(operands)
    ones = [1] * count
    if operation == "union":
        return places.combine(operands, ones, lambda total: total > 0)
    if operation == "intersection":
        return places.combine(operands, ones, lambda total: total == count)
    if operation == "xor":
        return places.combine(operands, ones, lambda total: total % 2 == 1)
    if operation == "difference":
        return places.combine(operands, ([count] + ones)[:count], lambda total: total == max(count, 1))
    if operation == "complement":
        return places.combine(operands, ones, lambda total: total == 0)
    raise ValueError(f"no operation {operation!r}")
