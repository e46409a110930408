"""Convex cells: each closed and convex, no two with a common interior, together the solid."""

from dataclasses import dataclass, field

import manifold3d
import numpy as np

from .line_oracle import Drawn, LineReport, compare_crossings, no_crossings
from .lines import TOUCHING, Crossings
from .mesh import Mesh
from .mesh_lines import TriangleTree

_FLAT = 1e-9
"""Distance, relative to the diagonal of all cells, that counts as none."""


@dataclass
class CellReport:
    """`volume`: the sum over the cells; `rounding`: how far coordinates that are rounded once can move it."""

    cells: int = 0
    volume: float = 0.0
    rounding: float = 0.0
    faults: list[str] = field(default_factory=list)


def examine(cells: list[Mesh]) -> CellReport:
    """Looks at the cells by themselves."""
    report = CellReport(len(cells))
    if not cells:
        return report
    low, high = (np.array([getattr(c.vertices, end)(0) for c in cells]) for end in ("min", "max"))
    tolerance = _FLAT * float(np.linalg.norm(high.max(0) - low.min(0)))
    report.volume = float(sum(c.volume() for c in cells))
    report.rounding = 2.0**-51 * max(np.abs(low).max(), np.abs(high).max()) * sum(c.area() for c in cells)
    planes = [_planes(cell) for cell in cells]
    for number, cell in enumerate(cells):
        if faults := cell.twin_faults():
            report.faults.append(f"cell {number}: " + ", ".join(f"{count} {name}" for name, count in faults.items()))
        elif cell.volume() <= 0.0:
            report.faults.append(f"cell {number}: volume {cell.volume()!r}")
        if (out := _outside(planes[number], cell.vertices).max(initial=-np.inf)) > tolerance:
            report.faults.append(f"cell {number}: not convex, a corner lies {out:.1e} outside a face")
    for i, j in _near_pairs(low, high, tolerance):
        if not _apart(cells[i], cells[j], planes[i], planes[j], tolerance):
            report.faults.append(f"cells {i} and {j} overlap")
    return report


def _planes(cell: Mesh) -> np.ndarray:
    """Unit rows `[n, d]` of the faces; of slivers none, their normals say nothing."""
    corners = cell.vertices[cell.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    longest = np.square(corners - np.roll(corners, 1, axis=1)).sum(2).max(1)
    sound = area > 1e-6 * longest
    normals = normals[sound] / area[sound, None]
    return np.column_stack([normals, np.einsum("ij,ij->i", normals, corners[sound, 0])])


def _outside(planes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How far each point lies outside each plane, `(planes, points)`."""
    return planes[:, :3] @ points.T - planes[:, 3:]


def _near_pairs(low: np.ndarray, high: np.ndarray, tolerance: float) -> list[tuple[int, int]]:
    """Pairs of cells whose boxes have a common interior."""
    order = np.argsort(low[:, 0])
    starts = low[order, 0]
    pairs = []
    for position, i in enumerate(order):
        last = np.searchsorted(starts, high[i, 0] - tolerance)
        others = order[position + 1 : last]
        meet = (low[others] < high[i] - tolerance).all(1) & (high[others] > low[i] + tolerance).all(1)
        pairs += [(int(i), int(j)) for j in others[meet]]
    return pairs


def _apart(a: Mesh, b: Mesh, planes_a: np.ndarray, planes_b: np.ndarray, tolerance: float) -> bool:
    """Whether a face of one has the two on different sides; else by the volume that manifold3d finds in common."""
    for own, planes, other in ((a, planes_a, b), (b, planes_b, a)):
        behind = _outside(planes, own.vertices).max(1, initial=-np.inf) <= tolerance
        if (behind & (_outside(planes, other.vertices).min(1, initial=np.inf) >= -tolerance)).any():
            return True
    first, second = (manifold3d.Manifold.hull_points(np.ascontiguousarray(m.vertices)) for m in (a, b))
    return (first ^ second).volume() <= tolerance * min(a.area(), b.area())


def compare_lines(drawn: Drawn, cells: list[Mesh]) -> tuple[LineReport, int]:
    """The union of the cells against the model along the lines, and on how many lines two cells overlap."""
    if not cells:
        return compare_crossings(drawn, no_crossings()), 0
    bases = np.cumsum([0] + [len(c.vertices) for c in cells[:-1]])
    triangles = np.concatenate([c.triangles + base for c, base in zip(cells, bases)])
    found = TriangleTree(Mesh(np.concatenate([c.vertices for c in cells]), triangles)).crossings(drawn.lines)
    union, doubled = _united(found, TOUCHING * drawn.size)
    return compare_crossings(drawn, union), int((~drawn.coverage.unclear[doubled]).sum())


def _united(found: Crossings, gap: float) -> tuple[Crossings, np.ndarray]:
    """The ends of the union, touching ones left out, and the lines along which the depth is not 0 or 1."""
    first = np.ones(len(found.t), dtype=bool)
    first[1:] = (found.line[1:] != found.line[:-1]) | (found.t[1:] - found.t[:-1] > gap)
    starts = np.nonzero(first)[0]
    if not len(starts):
        return found, np.zeros(0, dtype=np.int64)
    step = -np.add.reduceat(found.sign, starts)
    depth = np.cumsum(step)
    line, t = found.line[starts], found.t[starts]
    changes = (depth > 0) != (depth - step > 0)
    doubled = np.unique(line[(depth < 0) | (depth > 1)])
    return Crossings(line[changes], t[changes], np.where(depth[changes] > 0, -1, 1)), doubled
