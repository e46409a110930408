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
    """`volume`: the sum over the cells; `rounding`: how far coordinates that are rounded once can move it.

    `slivers`: cells with no more of a volume than rounding explains.
    """

    cells: int = 0
    volume: float = 0.0
    rounding: float = 0.0
    slivers: int = 0
    faults: list[str] = field(default_factory=list)


def examine(cells: list[Mesh]) -> CellReport:
    """Looks at the cells by themselves."""
    report = CellReport(len(cells))
    if not cells:
        return report
    whole = joined(cells)
    if faults := whole.twin_faults():
        report.faults.append("cells: " + ", ".join(f"{count} {name}" for name, count in faults.items()))
    if (pieces := whole.components()) != len(cells):
        report.faults.append(f"{len(cells)} cells are {pieces} surfaces")
    low, high = (np.array([getattr(c.vertices, end)(0) for c in cells]) for end in ("min", "max"))
    size = float(np.linalg.norm(high.max(0) - low.min(0)))
    volumes = [c.volume() for c in cells]
    report.volume = float(sum(volumes))
    report.rounding = 2.0**-51 * np.abs(whole.vertices).max() * whole.area()
    # by which rounded corners move it, and how far off the sum over triangles is; a needle has no area, but a length
    rounding = [2.0**-49 * (np.abs(c.vertices).max() * c.area() + np.ptp(c.vertices, axis=0).max() ** 3) for c in cells]
    report.slivers = sum(abs(v) <= r for v, r in zip(volumes, rounding))
    report.faults += [f"cell {i}: volume {v!r}" for i, (v, r) in enumerate(zip(volumes, rounding)) if v < -r]
    planes = [_planes(cell, _FLAT * size) for cell in cells]
    for number, cell in enumerate(cells):
        if (out := _outside(planes[number], cell.vertices).max(initial=-np.inf)) > _FLAT * size:
            report.faults.append(f"cell {number}: not convex, a corner lies {out:.1e} outside a face")
    report.faults += [f"cells {i} and {j} overlap" for i, j in _overlaps(cells, planes, low, high, _FLAT * size)]
    return report


def joined(cells: list[Mesh]) -> Mesh:
    """All cells as one mesh that shares no vertex."""
    bases = np.cumsum([0] + [len(c.vertices) for c in cells[:-1]])
    triangles = np.concatenate([c.triangles + base for c, base in zip(cells, bases)])
    return Mesh(np.concatenate([c.vertices for c in cells]), triangles)


def _planes(cell: Mesh, tolerance: float) -> np.ndarray:
    """Unit rows `[n, d]` of the faces; none of triangles so thin that rounding turns them by more than the tolerance."""
    corners = cell.vertices[cell.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    height = area / np.sqrt(np.square(corners - np.roll(corners, 1, axis=1)).sum(2).max(1) + 1e-300)
    extent = float(np.linalg.norm(np.ptp(cell.vertices, axis=0)))
    sound = height * tolerance > 4.0 * 2.0**-52 * np.abs(cell.vertices).max() * extent
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


def _overlaps(cells: list[Mesh], planes: list, low: np.ndarray, high: np.ndarray, tolerance: float) -> list:
    """Pairs of cells with a common interior: no face has the two on different sides, and manifold3d finds a volume."""
    pairs = set(_near_pairs(low, high, tolerance))
    # First by the faces of the one, then by those of the other.
    for turned in (False, True):
        beside: dict[int, list[int]] = {}
        for i, j in pairs:
            beside.setdefault(j if turned else i, []).append(i if turned else j)
        for i, others in beside.items():
            behind = planes[i][_outside(planes[i], cells[i].vertices).max(1, initial=-np.inf) <= tolerance]
            apart = _all_before(behind, [cells[j].vertices for j in others], tolerance)
            pairs -= {(j, i) if turned else (i, j) for j, is_apart in zip(others, apart) if is_apart}
    return sorted(pair for pair in pairs if _common(cells[pair[0]], cells[pair[1]], tolerance))


def _all_before(planes: np.ndarray, bodies: list[np.ndarray], tolerance: float) -> np.ndarray:
    """Per body, whether all of its points lie outside of one of the planes."""
    if not len(planes):
        return np.zeros(len(bodies), dtype=bool)
    starts = np.cumsum([0] + [len(b) for b in bodies[:-1]])
    nearest = np.minimum.reduceat(_outside(planes, np.concatenate(bodies)), starts, axis=1)
    return (nearest >= -tolerance).any(0)


def _common(a: Mesh, b: Mesh, tolerance: float) -> bool:
    """Whether manifold3d finds more of a volume in both than a sheet as thin as the tolerance has."""
    first, second = (manifold3d.Manifold.hull_points(np.ascontiguousarray(m.vertices)) for m in (a, b))
    return (first ^ second).volume() > tolerance * min(a.area(), b.area())


def compare_lines(drawn: Drawn, cells: list[Mesh]) -> tuple[LineReport, int]:
    """The union of the cells against the model along the lines, and on how many lines two cells overlap."""
    if not cells:
        return compare_crossings(drawn, no_crossings()), 0
    found = TriangleTree(joined(cells)).crossings(drawn.lines)
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
