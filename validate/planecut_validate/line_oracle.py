"""Random lines through a model: a mesh is right along a line when it is crossed just where the model begins and ends.

The model's side comes from clipping the line against the half-spaces of the input, the mesh's side from the triangles
that were written. Which lines are unclear is decided by the model alone, never by the mesh that is on trial.
"""

from dataclasses import dataclass, field

import numpy as np

from .mesh import Mesh
from .mesh_lines import TriangleTree
from .model import TOUCHING, Coverage, Crossings, Lines, ReferenceModel

POSITION = 1e-6
"""Largest distance of a crossing from its place, relative to the model's diagonal."""
_TRIES = 8
"""How often an unclear line is drawn anew."""


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


def compare(model: ReferenceModel, mesh: Mesh, lines: int, seed: int) -> LineReport:
    """Compares `lines` random lines; the same seed draws the same lines."""
    random = np.random.default_rng(seed)
    size = float(np.linalg.norm(model.high - model.low))
    report = LineReport(lines)
    drawn = _draw(model, lines, random)
    coverage = model.coverage(drawn)
    drawn, coverage = _redraw(model, drawn, coverage, size, random, report)
    crossed = TriangleTree(mesh).crossings(drawn)
    report.crossings = len(crossed.t)
    report.unclear = int(coverage.unclear.sum())
    wrong = np.zeros(lines, dtype=bool)
    _compare_clear(coverage, crossed, size, wrong, report)
    for line in np.nonzero(coverage.unclear)[0]:
        expected, found = (_closed(c, line, TOUCHING * size) for c in (coverage.crossings, crossed))
        same = len(expected) == len(found) and np.abs(expected - found).max(initial=0.0) <= POSITION * size
        wrong[line] = not same
    report.mismatches = int(wrong.sum())
    report.examples = [_describe(line, drawn, coverage.crossings, crossed) for line in np.nonzero(wrong)[0][:3]]
    return report


def _draw(model: ReferenceModel, count: int, random: np.random.Generator) -> Lines:
    """Lines through uniform points of the bounding box in uniform directions."""
    origins = model.low + random.random((count, 3)) * (model.high - model.low)
    return Lines(origins, _unit(random.normal(size=(count, 3))))


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def _redraw(model, lines: Lines, coverage: Coverage, size: float, random, report) -> tuple[Lines, Coverage]:
    """Moves unclear lines aside: near enough to look at the same edge or face, far enough to be sure."""
    for attempt in range(_TRIES):
        which = np.nonzero(coverage.unclear)[0]
        if attempt == 0:
            report.redrawn = len(which)
        if not len(which):
            break
        step = 1e-5 * 2**attempt
        origins = lines.origins[which] + step * size * random.normal(size=(len(which), 3))
        directions = _unit(lines.directions[which] + 100.0 * step * random.normal(size=(len(which), 3)))
        lines.origins[which], lines.directions[which] = origins, directions
        again = model.coverage(lines[which])
        old = coverage.crossings
        keep = ~np.isin(old.line, which)
        line = np.concatenate([old.line[keep], which[again.crossings.line]])
        t = np.concatenate([old.t[keep], again.crossings.t])
        sign = np.concatenate([old.sign[keep], again.crossings.sign])
        order = np.lexsort((t, line))
        unclear = coverage.unclear.copy()
        unclear[which] = again.unclear
        coverage = Coverage(Crossings(line[order], t[order], sign[order]), unclear)
    return lines, coverage


def _compare_clear(coverage: Coverage, found: Crossings, size: float, wrong: np.ndarray, report: LineReport) -> None:
    """Marks the clear lines whose crossings differ in number, sense or place."""
    expected, lines = coverage.crossings, len(wrong)
    counts = [np.bincount(c.line, minlength=lines) for c in (expected, found)]
    clear = ~coverage.unclear
    wrong |= clear & (counts[0] != counts[1])
    comparable = clear & ~wrong
    left, right = (comparable[c.line] for c in (expected, found))
    line = expected.line[left]
    distance = np.abs(expected.t[left] - found.t[right]) / size
    bad = (distance > POSITION) | (expected.sign[left] != found.sign[right])
    wrong[line[bad]] = True
    report.deviation = float(distance.max(initial=0.0))


def _closed(crossings: Crossings, line: int, gap: float) -> np.ndarray:
    """The crossings of one line without the pairs that bound a gap or a sliver no longer than `gap`."""
    begin, end = np.searchsorted(crossings.line, [line, line + 1])
    kept: list[tuple[float, int]] = []
    for t, sign in zip(crossings.t[begin:end], crossings.sign[begin:end]):
        if kept and t - kept[-1][0] <= gap and sign != kept[-1][1]:
            kept.pop()
        else:
            kept.append((t, sign))
    return np.array([t for t, _ in kept])


def _describe(line: int, lines: Lines, expected: Crossings, found: Crossings) -> str:
    def places(crossings: Crossings) -> str:
        begin, end = np.searchsorted(crossings.line, [line, line + 1])
        return " ".join(f"{'+' if s > 0 else '-'}{t:.6g}" for t, s in zip(crossings.t[begin:end], crossings.sign[begin:end]))

    origin, direction = lines.origins[line].tolist(), lines.directions[line].tolist()
    return f"line {line} from {origin} along {direction}: expected [{places(expected)}], mesh [{places(found)}]"
