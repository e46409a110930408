"""Random lines through a model: a mesh is right along a line when it is crossed just where the model begins and ends.

The model's side comes from clipping the line against the half-spaces of the input, the mesh's side from the triangles
that were written. Which lines are unclear is decided by the model alone, never by the mesh that is on trial.
"""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from .lines import POSITION, TOUCHING, Coverage, Crossings, Lines
from .mesh import Mesh
from .mesh_lines import TriangleTree

_TRIES = 8
"""How often an unclear line is drawn again."""


class Covered(Protocol):
    """What lines are drawn through."""

    low: np.ndarray
    high: np.ndarray
    position: float
    """Largest distance of a crossing from its place, relative to the model's diagonal."""

    def coverage(self, lines: Lines) -> Coverage:
        """Where the lines cross it."""


@dataclass
class LineReport:
    """What the lines said.

    `mismatches`: lines whose crossings differ in number, sense or place; the first few are described in `examples`.
    `redrawn`: lines that were unclear and moved aside a little. `unclear`: those still unclear after the last try; they
    are compared with gaps up to `TOUCHING` closed on both sides. `deviation`: largest distance of a crossing from its
    place, relative to the diagonal.
    """

    lines: int
    crossings: int = 0
    mismatches: int = 0
    redrawn: int = 0
    unclear: int = 0
    deviation: float = 0.0
    examples: list[str] = field(default_factory=list)


@dataclass
class Drawn:
    """Lines through a model and what it says of them; `redrawn` of them were unclear at first.

    `position`: largest distance of a crossing from its place, relative to `size`.
    """

    lines: Lines
    coverage: Coverage
    size: float
    redrawn: int
    position: float = POSITION


def draw(model: Covered, lines: int, seed: int) -> Drawn:
    """Draws `lines` random lines; the same seed draws the same lines."""
    random = np.random.default_rng(seed)
    size = float(np.linalg.norm(model.high - model.low))
    drawn = _draw(model, lines, random)
    return _redraw(model, Drawn(drawn, model.coverage(drawn), size, 0, model.position), random)


def compare(drawn: Drawn, mesh: Mesh) -> LineReport:
    """Compares the mesh with the model along the lines."""
    found = TriangleTree(mesh).crossings(drawn.lines) if len(mesh.triangles) else no_crossings()
    return compare_crossings(drawn, found)


def compare_crossings(drawn: Drawn, found: Crossings) -> LineReport:
    """Compares what crosses the lines with the model."""
    coverage, count = drawn.coverage, len(drawn.lines)
    report = LineReport(count, len(found.t), redrawn=drawn.redrawn, unclear=int(coverage.unclear.sum()))
    wrong = coverage.endless.copy()
    _compare_clear(drawn, found, wrong, report)
    for line in np.nonzero(coverage.unclear)[0]:
        expected, seen = (_closed(c.of(line), TOUCHING * drawn.size) for c in (coverage.crossings, found))
        same = len(expected) == len(seen) and np.abs(expected - seen).max(initial=0.0) <= drawn.position * drawn.size
        wrong[line] = not same
    report.mismatches = int(wrong.sum())
    report.examples = [_describe(line, drawn.lines, coverage.crossings, found) for line in np.nonzero(wrong)[0][:3]]
    return report


def no_crossings() -> Crossings:
    """Those with nothing."""
    none = np.zeros(0, dtype=np.int64)
    return Crossings(none, np.zeros(0), none)


def _draw(model: Covered, count: int, random: np.random.Generator) -> Lines:
    """Lines through uniform points of the bounding box in uniform directions."""
    origins = model.low + random.random((count, 3)) * (model.high - model.low)
    return Lines(origins, _unit(random.normal(size=(count, 3))))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _redraw(model: Covered, drawn: Drawn, random: np.random.Generator) -> Drawn:
    """Moves unclear lines aside: near enough to look at the same edge or face, far enough to be sure."""
    lines, coverage = drawn.lines, drawn.coverage
    drawn.redrawn = int(coverage.unclear.sum())
    for attempt in range(_TRIES):
        which = np.nonzero(coverage.unclear)[0]
        if not len(which):
            break
        step = 1e-5 * 2**attempt
        origins = lines.origins[which] + step * drawn.size * random.normal(size=(len(which), 3))
        directions = _unit(lines.directions[which] + 100.0 * step * random.normal(size=(len(which), 3)))
        lines.origins[which], lines.directions[which] = origins, directions
        coverage = _replaced(coverage, which, model.coverage(lines[which]))
    return Drawn(lines, coverage, drawn.size, drawn.redrawn, drawn.position)


def _replaced(old: Coverage, which: np.ndarray, new: Coverage) -> Coverage:
    """The coverage with the lines `which` told again."""
    before, after = old.crossings, new.crossings
    keep = ~np.isin(before.line, which)
    line = np.concatenate([before.line[keep], which[after.line]])
    t = np.concatenate([before.t[keep], after.t])
    sign = np.concatenate([before.sign[keep], after.sign])
    order = np.lexsort((t, line))
    unclear, endless = old.unclear.copy(), old.endless.copy()
    unclear[which], endless[which] = new.unclear, new.endless
    return Coverage(Crossings(line[order], t[order], sign[order]), unclear, endless)


def _compare_clear(drawn: Drawn, found: Crossings, wrong: np.ndarray, report: LineReport) -> None:
    """Marks the clear lines whose crossings differ in number, sense or place."""
    coverage, size = drawn.coverage, drawn.size
    expected, lines = coverage.crossings, len(wrong)
    counts = [np.bincount(c.line, minlength=lines) for c in (expected, found)]
    clear = ~coverage.unclear
    wrong |= clear & (counts[0] != counts[1])
    comparable = clear & ~wrong
    left, right = (comparable[c.line] for c in (expected, found))
    line = expected.line[left]
    distance = np.abs(expected.t[left] - found.t[right]) / size if size else np.zeros(len(line))
    bad = (distance > drawn.position) | (expected.sign[left] != found.sign[right])
    wrong[line[bad]] = True
    report.deviation = float(distance.max(initial=0.0))


def _closed(crossings: Crossings, gap: float) -> np.ndarray:
    """The crossings of one line without the pairs that bound a gap or a sliver no longer than `gap`."""
    kept: list[tuple[float, int]] = []
    for t, sign in zip(crossings.t, crossings.sign):
        if kept and t - kept[-1][0] <= gap and sign != kept[-1][1]:
            kept.pop()
        else:
            kept.append((t, sign))
    return np.array([t for t, _ in kept])


def _describe(line: int, lines: Lines, expected: Crossings, found: Crossings) -> str:
    def places(crossings: Crossings) -> str:
        own = crossings.of(line)
        return " ".join(f"{'+' if s > 0 else '-'}{t:.6g}" for t, s in zip(own.t, own.sign))

    origin, direction = lines.origins[line].tolist(), lines.directions[line].tolist()
    return f"line {line} from {origin} along {direction}: expected [{places(expected)}], mesh [{places(found)}]"
