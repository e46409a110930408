"""Set operations on polygons: where edges cross is worked out in fractions, so that pieces fit together.

All edges of all operands are cut where they meet; a piece belongs to the result's outline where inside and outside lie on
different sides of it. The pieces are chained with the inside on their left.
"""

import math
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
    left = _left_everywhere(list(pieces), ends, parities)
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
    """Pairs of edges that floating point cannot tell apart: all that meet are among them."""
    ends = np.array([[[float(c) for c in p] for p in edge] for edge in edges]).reshape(-1, 2, 2)
    scale = np.abs(ends).max(initial=0.0) + 1e-300
    low, high = ends.min(1) - 1e-9 * scale, ends.max(1) + 1e-9 * scale
    numbers: dict[Point, int] = {}
    corners = np.array([[numbers.setdefault(p, len(numbers)) for p in edge] for edge in edges]).reshape(-1, 2)
    pairs = []
    for i in range(len(edges)):
        meet = (low[i + 1 :] <= high[i]).all(1) & (high[i + 1 :] >= low[i]).all(1)
        others = np.nonzero(meet)[0] + i + 1
        pairs += [(i, int(j)) for j in others[_may_meet(ends, corners, i, others, 1e-12 * scale * scale)]]
    return pairs


def _may_meet(ends: np.ndarray, corners: np.ndarray, i: int, others: np.ndarray, doubt: float) -> np.ndarray:
    """Of edges whose boxes meet that of edge `i`: not those beside it, nor those that only share a corner with it."""
    a, b = ends[i]
    c, d = ends[others, 0], ends[others, 1]

    def turn(p, q, r):
        return (q - p)[..., 0] * (r - p)[..., 1] - (q - p)[..., 1] * (r - p)[..., 0]

    sides = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)]
    beside = np.zeros(len(others), dtype=bool)
    for first, second in (sides[:2], sides[2:]):
        beside |= ((first > doubt) & (second > doubt)) | ((first < -doubt) & (second < -doubt))
    shared = (corners[others][:, :, None] == corners[i]).any((1, 2))
    return ~beside & ~(shared & (np.abs(sides).max(0) > doubt))


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


def _left_everywhere(pieces: list[tuple[Point, Point]], ends: np.ndarray, parities: np.ndarray) -> np.ndarray:
    """Per piece, in which operands the points just left of it lie.

    One ray tells it for one piece of each connected part; around a corner, what lies left of a piece lies right of the next.
    """
    at: dict[Point, list[int]] = {}
    for number, piece in enumerate(pieces):
        for end in piece:
            at.setdefault(end, []).append(number)
    left = np.zeros(parities.shape, dtype=bool)
    known = np.zeros(len(pieces), dtype=bool)
    # Long pieces first: their middles are far from every corner.
    for start in np.argsort(-np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)):
        if known[start]:
            continue
        left[start], known[start] = _left_of(np.array([start]), ends, parities)[0], True
        corners = list(pieces[start])
        while corners:
            corner = corners.pop()
            if corner in at:
                reached = _told_around(_around(corner, at.pop(corner), pieces), left, known, parities)
                corners += [pieces[number][outgoing] for number, outgoing in reached]
    return left


def _around(corner: Point, numbers: list[int], pieces: list) -> list[tuple[int, bool]]:
    """The pieces at a corner, counter-clockwise, and whether each begins there."""
    arms = []
    for number in numbers:
        outgoing = pieces[number][0] == corner
        end = pieces[number][outgoing]
        direction = (end[0] - corner[0], end[1] - corner[1])
        arms.append((math.atan2(direction[1], direction[0]), direction, number, outgoing))
    arms.sort(key=lambda arm: arm[0])
    # Where floating point cannot tell two directions apart, their exact cross product does.
    for _ in range(len(arms)):
        for k in range(len(arms) - 1):
            (angle, u, *_rest), (other, v, *_rest) = arms[k], arms[k + 1]
            if other - angle < 1e-9 and u[0] * v[1] - u[1] * v[0] < 0:
                arms[k], arms[k + 1] = arms[k + 1], arms[k]
    return [(number, outgoing) for _, _, number, outgoing in arms]


def _told_around(arms: list[tuple[int, bool]], left: np.ndarray, known: np.ndarray, parities: np.ndarray) -> list:
    """Makes all pieces around a corner known, from one that is; returns the new ones."""
    first = next(k for k, (number, _) in enumerate(arms) if known[number])
    number, outgoing = arms[first]
    region = left[number] if outgoing else left[number] ^ parities[number]
    reached = []
    for number, outgoing in arms[first + 1 :] + arms[:first]:
        # The region is to the right of the next arm; behind it lies another.
        beyond = region ^ parities[number]
        if not known[number]:
            left[number], known[number] = beyond if outgoing else region, True
            reached.append((number, outgoing))
        region = beyond
    return reached


def _left_of(asked: np.ndarray, ends: np.ndarray, parities: np.ndarray) -> np.ndarray:
    """Per asked piece, in which operands the points just left of it lie, by counting crossings of a ray to the left."""
    count = len(ends)
    result = np.zeros((len(asked), parities.shape[1]), dtype=bool)
    size = float(np.ptp(ends.reshape(-1, 2), axis=0).max())
    random = np.random.default_rng(5)
    along = ends[:, 1] - ends[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    open_rows = np.arange(len(asked))
    for attempt in range(40):
        # In portions, because each ray looks at all pieces.
        for rows in np.array_split(open_rows, 1 + len(open_rows) * count // 2_000_000):
            # At last the pieces themselves may be so small that nothing is farther away than rounding.
            near = 1e-12 * size if attempt < 30 else 0.0
            rays = _rays(along[asked[rows]], random)
            sure, crossed = _crossed(asked[rows], rays, ends, near)
            result[rows[sure]] = (crossed[sure].astype(int) @ parities.astype(int)) % 2 == 1
            open_rows = np.setdiff1d(open_rows, rows[sure])
        if not len(open_rows):
            break
    return result


def _rays(along: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Directions somewhere to the left of those."""
    angle = np.radians(random.uniform(20.0, 160.0, len(along)))
    x, y = along[:, 0], along[:, 1]
    return np.column_stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)])


def _crossed(asked: np.ndarray, rays: np.ndarray, ends: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Which rays from the middles of pieces pass no corner closely, and which pieces each ray crosses."""
    middles = ends[asked].mean(1)
    a, b = (ends[None, :, k] - middles[:, None] for k in (0, 1))
    side_a, side_b = (rays[:, None, 0] * p[..., 1] - rays[:, None, 1] * p[..., 0] for p in (a, b))
    ahead_a, ahead_b = (np.einsum("ik,ijk->ij", rays, p) for p in (a, b))
    crosses = (side_a > 0) != (side_b > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = (ahead_a * side_b - ahead_b * side_a) / (side_b - side_a)
    itself = np.arange(len(ends)) == asked[:, None]
    doubt = (np.minimum(np.abs(side_a), np.abs(side_b)) <= near) & (np.maximum(ahead_a, ahead_b) > -near)
    doubt |= crosses & (np.abs(ahead) <= near)
    return ~(doubt & ~itself).any(1), crosses & (ahead > 0) & ~itself


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
