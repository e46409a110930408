"""Reference models: what the input means, said by code that planecut has no part in."""

import random
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import manifold3d
import numpy as np

from .convex_body import ConvexBody, convex_body
from .map_file import read_map


@dataclass(frozen=True)
class Lines:
    """Points `origins` `(n, 3)` and unit `directions` `(n, 3)`."""

    origins: np.ndarray
    directions: np.ndarray

    def __len__(self) -> int:
        return len(self.origins)

    def __getitem__(self, which) -> "Lines":
        return Lines(self.origins[which], self.directions[which])


@dataclass
class Crossings:
    """Where lines enter (`sign` −1) and leave (`sign` +1) a solid, sorted by line, then by `t` along the line."""

    line: np.ndarray
    t: np.ndarray
    sign: np.ndarray


@dataclass
class Coverage:
    """Crossings with a solid, and per line whether they hang on less than floating point can tell.

    `unclear` lines come close to an edge or a corner, graze a face, or meet a gap that may be one or not.
    """

    crossings: Crossings
    unclear: np.ndarray


@dataclass
class ReferenceVolume:
    """The volume by manifold3d, and every answer it gave on the way, by name of the way."""

    volume: float
    answers: dict[str, float] = field(default_factory=dict)

    def spread(self) -> float:
        """The largest relative difference between two answers."""
        values = self.answers.values()
        return (max(values) - min(values)) / abs(self.volume)


class ReferenceModel(Protocol):
    """What the checks need from an input; a new file format brings a class like this and a line in `FORMATS`."""

    brushes: int
    """Bodies in the file."""
    notes: list[str]
    """What was left out, for the reader of the table."""
    low: np.ndarray
    high: np.ndarray
    """Corners of the bounding box; undefined where `is_empty`."""
    is_empty: bool
    brush_volume_sum: float

    def volume(self) -> ReferenceVolume:
        """The volume of the solid by manifold3d. Raises `ArithmeticError` where its answers do not settle on one."""

    def coverage(self, lines: Lines) -> Coverage:
        """Where the lines cross the solid, from the input's own definition, without any mesh."""


class BrushUnion:
    """The union of convex bodies."""

    def __init__(self, bodies: list[ConvexBody], brushes: int):
        self.brushes = brushes
        self.notes: list[str] = []
        unbounded = sum(len(b.vertices) > 0 and not b.bounded for b in bodies)
        bodies = [b for b in bodies if b.bounded]
        hulls = [manifold3d.Manifold.hull_points(b.vertices) for b in bodies]
        solid = [i for i, hull in enumerate(hulls) if hull.num_tri() > 0 and hull.volume() > 0.0]
        self.bodies = [bodies[i] for i in solid]
        self.hulls = [hulls[i] for i in solid]
        if unbounded:
            self.notes.append(f"{unbounded} unbounded")
        if (empty := brushes - unbounded - len(solid)) > 0:
            self.notes.append(f"{empty} empty")
        self.is_empty = not solid
        self.brush_volume_sum = float(sum(hull.volume() for hull in self.hulls))
        if solid:
            points = np.concatenate([b.vertices for b in self.bodies])
            self.low, self.high = points.min(0), points.max(0)
            self._planes = np.concatenate([b.planes for b in self.bodies])
            counts = [len(b.planes) for b in self.bodies]
            self._first_plane = np.concatenate([[0], np.cumsum(counts)[:-1]])
            self._body_of_plane = np.repeat(np.arange(len(counts)), counts)

    def volume(self) -> ReferenceVolume:
        """Two ways to one number: the batch union, and the sum over bodies of what earlier ones leave of each.

        The batch union now and then depends on the order of its operands (by 1e-5 of the volume on real maps), so where
        the two differ it is asked again in other orders until one of its answers meets the sum of parts.
        """
        parts = self._volume_by_parts()
        answers = {"parts": parts, "batch": _union(self.hulls)}
        for seed in range(_ORDERS):
            agreeing = [v for name, v in answers.items() if name != "parts" and abs(v - parts) <= _AGREED * parts]
            if agreeing:
                return ReferenceVolume(agreeing[-1], answers)
            shuffled = list(self.hulls)
            random.Random(seed).shuffle(shuffled)
            answers[f"batch, order {seed}"] = _union(shuffled)
        raise ArithmeticError(f"manifold3d gives {answers}")

    def _volume_by_parts(self) -> float:
        low, high = (np.array([hull.bounding_box() for hull in self.hulls])[:, part] for part in (slice(3), slice(3, 6)))
        total = 0.0
        for i, hull in enumerate(self.hulls):
            earlier = np.nonzero(((low[:i] <= high[i]) & (high[:i] >= low[i])).all(1))[0]
            operands = [hull] + [self.hulls[j] for j in earlier]
            total += manifold3d.Manifold.batch_boolean(operands, manifold3d.OpType.Subtract).volume()
        return total

    def coverage(self, lines: Lines, chunk: int = 256) -> Coverage:
        parts = [self._coverage(lines[at : at + chunk], at) for at in range(0, len(lines), chunk)]
        crossings = Crossings(*(np.concatenate([getattr(p[0], name) for p in parts]) for name in ("line", "t", "sign")))
        return Coverage(crossings, np.concatenate([p[1] for p in parts]))

    def _coverage(self, lines: Lines, first_line: int) -> tuple[Crossings, np.ndarray]:
        size = np.linalg.norm(self.high - self.low)
        enter, leave, unclear = self._clip(lines, size)
        body, line = np.nonzero(leave > enter)
        order = np.lexsort((enter[body, line], line))
        body, line = body[order], line[order]
        crossings, near_touch = _merge(line, enter[body, line], leave[body, line], len(lines), size)
        crossings.line += first_line
        return crossings, unclear | near_touch

    def _clip(self, lines: Lines, size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Per body and line where the line enters and leaves (enters behind where it leaves: a miss); and unclear lines."""
        normals, offsets = self._planes[:, :3], self._planes[:, 3:]
        rate = normals @ lines.directions.T
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = (offsets - normals @ lines.origins.T) / rate
        enters = np.where(rate < 0, reach, -np.inf)
        leaves = np.where(rate > 0, reach, np.inf)
        enter = np.maximum.reduceat(enters, self._first_plane, axis=0)
        leave = np.minimum.reduceat(leaves, self._first_plane, axis=0)
        unclear = (np.abs(leave - enter) <= CLOSE * size).any(0)
        hit = leave > enter
        for ends, end in ((enters, enter), (leaves, leave)):
            # Two planes at one end: the line passes an edge there.
            with np.errstate(invalid="ignore"):
                at_end = np.abs(ends - end[self._body_of_plane]) <= CLOSE * size
            unclear |= (hit & (np.add.reduceat(at_end, self._first_plane, axis=0, dtype=np.int32) > 1)).any(0)
        plane, line = np.nonzero(np.abs(rate) < GRAZING)
        body = self._body_of_plane[plane]
        bounds = (enters[plane, line] == enter[body, line]) | (leaves[plane, line] == leave[body, line])
        unclear[line[bounds & hit[body, line]]] = True
        return enter, leave, unclear


def _union(hulls: list[manifold3d.Manifold]) -> float:
    return manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add).volume()


_ORDERS = 6
"""Orders of the operands to try before giving up."""
_AGREED = 1e-10
"""Relative difference up to which two answers of manifold3d are one."""

TOUCHING = 1e-9
"""Bodies closer than this along a line, relative to the model's diagonal, count as touching."""
SURELY_TOUCHING = 1e-12
"""What rounding alone explains. A gap between the two values makes a line unclear."""
CLOSE = 1e-7
"""Planes of a body that a line meets within this distance (relative to the diagonal): too near an edge or a corner."""
GRAZING = 1e-4
"""Cosine to the normal of a face below which the line is taken to graze it."""


def _merge(line, enter, leave, lines: int, size: float) -> tuple[Crossings, np.ndarray]:
    """Ends of the union of intervals sorted by line and entry, and per line whether a gap may be one or not."""
    counts = np.bincount(line, minlength=lines)
    column = np.arange(len(line)) - np.repeat(np.cumsum(counts) - counts, counts)
    width = max(1, int(counts.max(initial=0)))
    starts = np.full((lines, width), np.inf)
    ends = np.full((lines, width), -np.inf)
    starts[line, column], ends[line, column] = enter, leave
    reached = np.maximum.accumulate(ends, axis=1)
    filled = np.arange(width) < counts[:, None]
    with np.errstate(invalid="ignore"):
        gap = np.where(filled[:, 1:], starts[:, 1:] - reached[:, :-1], -np.inf)
    opens = filled.copy()
    opens[:, 1:] &= gap > TOUCHING * size
    closes = filled.copy()
    closes[:, :-1] &= opens[:, 1:] | ~filled[:, 1:]
    where = np.nonzero(opens)[0]
    ends_of = np.stack([starts[opens], reached[closes]], axis=1)
    signs = np.tile([-1, 1], len(where))
    doubtful = ((gap > SURELY_TOUCHING * size) & (gap <= TOUCHING * size)).any(1)
    return Crossings(np.repeat(where, 2), ends_of.ravel(), signs), doubtful


def _load_map(path: Path) -> BrushUnion:
    # Old editors wrote texture and path names in whatever code page they had; only ASCII matters here.
    brushes = read_map(path.read_text(encoding="latin-1"))
    return BrushUnion([convex_body(b.planes) for b in brushes], len(brushes))


FORMATS = {".map": _load_map}
"""File ending to loader."""


def load(path: Path) -> ReferenceModel:
    """The reference model of a file whose ending is in `FORMATS`. Raises `ValueError` where it is not a model."""
    return FORMATS[path.suffix.lower()](path)
