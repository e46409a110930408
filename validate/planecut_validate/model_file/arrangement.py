"""Set operations on polygons: where edges cross is worked out in fractions, so that pieces fit together.

All edges of all operands are cut where they meet; a piece belongs to the result's outline where inside and outside lie on
different sides of it. The pieces are chained with the inside on their left.
"""

from collections.abc import Callable
from fractions import Fraction

import numpy as np

Point = tuple[Fraction, Fraction]

_SAME = 1e-11
"""Distance, relative to the whole, below which two given points are one."""


def combine(operands: list[list[np.ndarray]], inside: Callable[[np.ndarray], np.ndarray]) -> list[np.ndarray]:
    """Loops of the set of all points that `inside` accepts.

    `operands`: each a list of closed loops `(n, 2)`, even-odd. `inside`: of booleans `(points, operands)`, per point.
    """
    pieces = _pieces(operands)
    if not pieces:
        return []
    ends = np.array([[[float(c) for c in end] for end in piece] for piece in pieces])
    parities = np.zeros((len(pieces), len(operands)), dtype=bool)
    for row, owners in enumerate(pieces.values()):
        for owner in owners:
            parities[row, owner] ^= True
    left = _left_of(ends, parities)
    in_left, in_right = inside(left), inside(left ^ parities)
    directed = [
        piece if in_left[row] else piece[::-1] for row, piece in enumerate(pieces) if in_left[row] != in_right[row]
    ]
    return [
        np.array([[float(c) for c in p] for p in loop])
        for loop in map(_straightened, _chained(directed))
        if len(loop) > 2
    ]


def _pieces(operands: list[list[np.ndarray]]) -> dict[tuple[Point, Point], list[int]]:
    """Edges cut where they meet, from the smaller end to the larger, and the operands that each is an edge of."""
    edges, owners = _edges(operands)
    cuts: list[set[Point]] = [set(edge) for edge in edges]
    for i, j in _near_pairs(edges):
        for point in _common_points(edges[i], edges[j]):
            cuts[i].add(point)
            cuts[j].add(point)
    pieces: dict[tuple[Point, Point], list[int]] = {}
    for points, owner in zip(cuts, owners):
        ordered = sorted(points)
        for piece in zip(ordered, ordered[1:]):
            pieces.setdefault(piece, []).append(owner)
    return pieces


def _edges(operands: list[list[np.ndarray]]) -> tuple[list[tuple[Point, Point]], list[int]]:
    """The edges of all loops, points that only rounding tells apart made one."""
    every = np.concatenate([np.zeros((0, 2))] + [loop for loops in operands for loop in loops])
    if not len(every):
        return [], []
    tolerance = _SAME * float(np.abs(every).max(initial=0.0))
    order = np.lexsort((every[:, 1], every[:, 0]))
    snapped = every.copy()
    for position, index in enumerate(order):
        for earlier in order[position - 1 :: -1] if position else []:
            if every[index, 0] - every[earlier, 0] > tolerance:
                break
            if abs(every[index, 1] - every[earlier, 1]) <= tolerance:
                snapped[index] = snapped[earlier]
                break
    points = [(Fraction(x), Fraction(y)) for x, y in snapped.tolist()]
    edges, owners, at = [], [], 0
    for owner, loops in enumerate(operands):
        for loop in loops:
            ring = points[at : at + len(loop)]
            at += len(loop)
            both = [(a, b) for a, b in zip(ring, ring[1:] + ring[:1]) if a != b]
            edges += both
            owners += [owner] * len(both)
    return edges, owners


def _near_pairs(edges: list[tuple[Point, Point]]) -> list[tuple[int, int]]:
    """Pairs of edges whose boxes meet."""
    ends = np.array([[[float(c) for c in p] for p in edge] for edge in edges]).reshape(-1, 2, 2)
    margin = 1e-9 * (np.abs(ends).max(initial=0.0) + 1e-300)
    low, high = ends.min(1) - margin, ends.max(1) + margin
    pairs = []
    for i in range(len(edges)):
        meet = (low[i + 1 :] <= high[i]).all(1) & (high[i + 1 :] >= low[i]).all(1)
        pairs += [(i, int(j)) for j in np.nonzero(meet)[0] + i + 1]
    return pairs


def _turn(a: Point, b: Point, c: Point) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _common_points(first: tuple[Point, Point], second: tuple[Point, Point]) -> list[Point]:
    """Where two edges meet: nowhere, in one point, or the ends of what they share."""
    a, b = first
    c, d = second
    at_c, at_d = _turn(a, b, c), _turn(a, b, d)
    if at_c == 0 and at_d == 0:
        return [p for p in (c, d) if _between(a, b, p)] + [p for p in (a, b) if _between(c, d, p)]
    at_a, at_b = _turn(c, d, a), _turn(c, d, b)
    if at_c * at_d > 0 or at_a * at_b > 0:
        return []
    # The ends themselves where an edge only begins on the other.
    for value, point in ((at_c, c), (at_d, d), (at_a, a), (at_b, b)):
        if value == 0:
            return [point]
    part = at_c / (at_c - at_d)
    return [(c[0] + part * (d[0] - c[0]), c[1] + part * (d[1] - c[1]))]


def _between(a: Point, b: Point, p: Point) -> bool:
    """Whether a point on the line through an edge lies on the edge."""
    return min(a, b) <= p <= max(a, b)


def _left_of(ends: np.ndarray, parities: np.ndarray) -> np.ndarray:
    """Per piece, in which operands the points just left of it lie, by counting crossings of a ray to the left."""
    count = len(ends)
    result = np.zeros(parities.shape, dtype=bool)
    size = float(np.ptp(ends.reshape(-1, 2), axis=0).max())
    random = np.random.default_rng(5)
    open_rows = np.arange(count)
    middles = ends.mean(1)
    along = ends[:, 1] - ends[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    for attempt in range(40):
        if not len(open_rows):
            break
        angle = np.radians(random.uniform(20.0, 160.0, len(open_rows)))
        u, m = along[open_rows], middles[open_rows]
        ray = np.column_stack(
            [u[:, 0] * np.cos(angle) - u[:, 1] * np.sin(angle), u[:, 0] * np.sin(angle) + u[:, 1] * np.cos(angle)]
        )
        a, b = (ends[None, :, k] - m[:, None] for k in (0, 1))
        side_a, side_b = (ray[:, None, 0] * p[..., 1] - ray[:, None, 1] * p[..., 0] for p in (a, b))
        ahead_a, ahead_b = (np.einsum("ik,ijk->ij", ray, p) for p in (a, b))
        crosses = (side_a > 0) != (side_b > 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = (ahead_a * side_b - ahead_b * side_a) / (side_b - side_a)
        itself = np.arange(count) == open_rows[:, None]
        counted = crosses & (ahead > 0) & ~itself
        # Near a corner or near the start: another direction will tell, unless the pieces themselves are that small.
        near = 1e-12 * size if attempt < 30 else 0.0
        doubt = (np.minimum(np.abs(side_a), np.abs(side_b)) <= near) & (np.maximum(ahead_a, ahead_b) > -near)
        doubt |= crosses & (np.abs(ahead) <= near)
        sure = ~(doubt & ~itself).any(1)
        result[open_rows[sure]] = (counted[sure].astype(int) @ parities.astype(int)) % 2 == 1
        open_rows = open_rows[~sure]
    return result


def _chained(directed: list[tuple[Point, Point]]) -> list[list[Point]]:
    """Closed loops of directed pieces; where loops meet in a point, each turns as far to the left as it can."""
    following: dict[Point, list[Point]] = {}
    for start, end in directed:
        following.setdefault(start, []).append(end)
    loops = []
    for start, end in directed:
        if end not in following.get(start, []):
            continue
        following[start].remove(end)
        loop = [start]
        while end != start:
            begin, loop = loop[-1], [*loop, end]
            choices = following[end]
            best = min(choices, key=lambda p: _clockwise(begin, end, p)) if len(choices) > 1 else choices[0]
            choices.remove(best)
            end = best
        loops.append(loop)
    return loops


def _clockwise(begin: Point, corner: Point, end: Point) -> float:
    """The angle from the way back to the way on, clockwise: the smallest keeps the turn tight around the inside."""
    back = np.arctan2(float(begin[1] - corner[1]), float(begin[0] - corner[0]))
    on = np.arctan2(float(end[1] - corner[1]), float(end[0] - corner[0]))
    return float((back - on) % (2.0 * np.pi))


def _straightened(loop: list[Point]) -> list[Point]:
    """The loop without corners that lie on the line through their neighbours."""
    scale = max(abs(c) for p in loop for c in p) ** 2
    kept = loop
    while True:
        count = len(kept)
        flat = [
            abs(_turn(kept[i - 1], kept[i], kept[(i + 1) % count])) <= scale * Fraction(1, 10**15) for i in range(count)
        ]
        if count < 3 or not any(flat):
            return kept
        first = flat.index(True)
        kept = kept[:first] + kept[first + 1 :]
