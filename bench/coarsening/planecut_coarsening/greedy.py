"""Plain greedy merging, to compare with: always the pair whose hull adds the least to the two volumes."""

from itertools import count

import numpy as np
from scipy.spatial import ConvexHull

from .bodies import Body


def greedy_merges(bodies: list[Body], counts: set[int]) -> dict[int, list[Body]]:
    """What is left at each of the numbers of hulls, on the way to the least of them."""
    alive = dict(enumerate(map(_hull, (body.corners for body in bodies))))
    costs = np.full((2 * len(bodies), 2 * len(bodies)), np.inf)
    for number in alive:
        _weigh(costs, alive, number)
    kept = {}
    for number in count(len(bodies)):
        if len(alive) in counts:
            kept[len(alive)] = [body for body, _ in alive.values()]
        if len(alive) <= min(counts):
            break
        first, second = map(int, np.unravel_index(costs.argmin(), costs.shape))
        merged = _merged(alive.pop(first)[0], alive.pop(second)[0])
        costs[[first, second], :] = costs[:, [first, second]] = np.inf
        alive[number] = merged
        _weigh(costs, alive, number)
    return kept


def _weigh(costs: np.ndarray, alive: dict[int, tuple[Body, float]], number: int) -> None:
    """Fills in what it costs to merge one body with each older one."""
    body, volume = alive[number]
    for other, (another, its_volume) in alive.items():
        if other < number:
            costs[other, number] = _merged(body, another)[1] - volume - its_volume


def _merged(body: Body, another: Body) -> tuple[Body, float]:
    return _hull(np.concatenate([body.corners, another.corners]))


def _hull(points: np.ndarray) -> tuple[Body, float]:
    """The hull's corners, without its triangles, and its volume."""
    hull = ConvexHull(points)
    return Body(points[hull.vertices], np.zeros((0, 3), dtype=np.int64)), hull.volume
