"""The Markdown page: the tables, in the text of `page.template.md`."""

import math
import os
from pathlib import Path

from . import machine
from .bullet_engine import BulletRays
from .decompositions import INPUTS, KNOWN
from .exact_merges import Merged
from .lowered import Lowered
from .mujoco_engine import MuJoCoCell
from .results import Results
from .setting import Row

_TEMPLATE = Path(__file__).resolve().parents[1] / "page.template.md"


def write_page(path: Path, results: Results, charts: dict[str, Path]) -> None:
    """Writes the page, with the pictures where they lie from there."""
    places = {name: os.path.relpath(chart, path.parent).replace(os.sep, "/") for name, chart in charts.items()}
    text = _TEMPLATE.read_text(encoding="utf-8")
    meshes = dict.fromkeys(row.input for row in results.whole)
    parts = {
        "run": f"{machine.processor()}, shared with other work; {machine.versions()}; {results.seconds:.0f} s",
        "decompositions": "\n\n".join(_decomposition(name, results.decompositions, places) for name in INPUTS),
        "whole": "\n\n".join(_whole(name, results.whole, places) for name in meshes),
        "exact": _exact(results.exact),
        "lowered": _lowered(results.lowered),
        "mujoco": _mujoco(results.mujoco),
        "bullet": _bullet(results.bullet),
        "difference": f"{_largest(results):.0e}",
    }
    for name, part in parts.items():
        text = text.replace("{{" + name + "}}", part)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _largest(results: Results) -> float:
    rows = [*results.decompositions, *results.whole]
    return max((abs(row.difference) for row in rows if row.difference is not None), default=math.nan)


def _decomposition(name: str, rows: list[Row], places: dict[str, str]) -> str:
    by_planecut = {row.asked: row for row in rows if row.input == name and row.entrant == "planecut"}
    by_greedy = {row.asked: row for row in rows if row.input == name and row.entrant == "greedy"}
    head = ["cells", "union %", "sum %", "s", "greedy: union %", "sum %"]
    known = KNOWN if name == "lego" else {}
    head += [f"{other}: union %" for other in known]
    table = []
    for asked, row in sorted(by_planecut.items(), reverse=True):
        greedy = by_greedy[asked].measure
        cells = [str(row.measure.cells), _percent(row.measure.union_excess), _percent(row.measure.sum_excess)]
        cells += [f"{row.seconds:.2f}", _percent(greedy.union_excess), _percent(greedy.sum_excess)]
        cells += [_percent(points[asked]) if asked in points else "" for points in known.values()]
        table.append(cells)
    outside = max((row.measure.farthest for row in by_planecut.values()), default=0.0)
    lost = sum(row.measure.outside for row in by_planecut.values())
    return (
        f"### {name}\n\n{_picture(name, places)}{_table(head, table)}\n\n"
        f"Corners of the input outside of all cells: {lost}; the farthest lies {outside:.0e} of the diameter outside."
    )


def _whole(name: str, rows: list[Row], places: dict[str, str]) -> str:
    head = ["asked", "by", "hulls", "corners", "union %", "sum %", "missing %", "outside", "farthest", "Hausdorff %", "s"]
    table = []
    for row in rows:
        if row.input != name:
            continue
        found = row.measure
        settings = row.settings + (f"; flat hulls: {found.flat}" if found.flat else "")
        table.append(
            [str(row.asked), row.entrant, str(found.cells), str(found.corners), _percent(found.union_excess)]
            + [_percent(found.sum_excess), _percent(found.missing), str(found.outside)]
            + [f"{found.farthest:.0e}", _percent(found.hausdorff or 0.0), f"{row.seconds:.2f}", settings]
        )
    table_of = _table([*head, "settings"], table, left=("by", "settings"))
    return f"### {name}, a mesh\n\n{_picture(f'{name}, a mesh', places)}{table_of}"


def _exact(rows: list[Merged]) -> str:
    head = ["model", "cells", "left", "merges", "excess", "by manifold3d", "ms"]
    table = [
        [row.model, str(row.cells_in), str(row.cells_out), str(row.exact_merges)]
        + [_power(row.excess), _power(row.found), f"{row.milliseconds:.0f}"]
        for row in rows
    ]
    return _table(head, table, left=("model",))


def _lowered(rows: list[Lowered]) -> str:
    head = ["points of", "faces", "to", "by", "added %", "outside", "s", "with hull, s"]
    table = []
    for row in rows:
        figures = ["no result", "", "", ""]
        if row.found is not None:
            figures = [f"{100.0 * row.added:.4g}", _power(row.outside), f"{row.seconds:.3f}"]
            figures.append(f"{row.seconds_with_hull:.3f}")
        table.append([row.input, str(row.faces), str(row.asked), row.entrant, *figures])
    return _table(head, table, left=("points of", "by"))


def _mujoco(cells: list[MuJoCoCell]) -> str:
    head = ["cell", "corners", "in MuJoCo's hull", "volume", "MuJoCo's differs by"]
    table = [
        [str(number), str(cell.corners), str(cell.corners_in_mujoco), f"{cell.volume:.6g}", _power(cell.difference)]
        for number, cell in enumerate(cells)
    ]
    return _table(head, table)


def _bullet(found: BulletRays) -> str:
    head = ["cells in the file", "convex shapes in Bullet", "rays", "of these stopped", "in the wrong place"]
    return _table(head, [[str(n) for n in (found.cells, found.shapes, found.rays, found.hits, found.amiss)]])


def _picture(name: str, places: dict[str, str]) -> str:
    return f"![{name}: volume added over the number of cells]({places[name]})\n\n" if name in places else ""


def _percent(part: float) -> str:
    """Three digits or so; what is less than 0.0005 % is noise of the measurement."""
    percent = 100.0 * part
    if abs(percent) < 5e-4:
        return "0"
    return f"{percent:.3f}" if abs(percent) < 0.1 else f"{percent:.1f}" if abs(percent) >= 10.0 else f"{percent:.2f}"


def _power(value: float) -> str:
    return "0" if value == 0.0 else f"{value:.0e}"


def _table(head: list[str], rows: list[list[str]], left: tuple[str, ...] = ()) -> str:
    rules = ["---" if name in left else "---:" for name in head]
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join(rules) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])
