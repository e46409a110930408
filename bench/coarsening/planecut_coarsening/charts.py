"""Which lines stand in which plot."""

from pathlib import Path

from .decompositions import INPUTS, KNOWN
from .plot import Line, plot
from .setting import Row
from .whole_mesh import MESHES

_COLORS = {"planecut": "#1b6ca8", "greedy": "#d9822b", "CoACD": "#d9822b", "V-HACD": "#5a9a6e"}
_KNOWN = {"greedy, whole union": "#b03a48", "greedy, another": "#8a8f98"}


def write_charts(folder: Path, decompositions: list[Row], whole: list[Row]) -> dict[str, Path]:
    """The files, by the name of the input."""
    folder.mkdir(parents=True, exist_ok=True)
    charts = {}
    for name in INPUTS:
        rows = [row for row in decompositions if row.input == name]
        lines = [*_lines(rows, "planecut"), *_lines(rows, "greedy")]
        if name == "lego":
            lines += [Line(known, _KNOWN[known], list(points.items()), loose=True) for known, points in KNOWN.items()]
        title = f"{name}: {max(row.measure.cells for row in rows)} hulls made fewer"
        charts[name] = _written(folder / f"coarsen-{name.lower()}.svg", title, lines)
    for name in MESHES:
        rows = [row for row in whole if row.input == name]
        if not rows:
            continue
        lines = [line for entrant in ("planecut", "CoACD", "V-HACD") for line in _lines(rows, entrant)]
        path = folder / f"coarsen-{name.lower()}-mesh.svg"
        charts[f"{name}, a mesh"] = _written(path, f"{name}, a closed mesh, in few hulls", lines)
    return charts


def _lines(rows: list[Row], entrant: str) -> list[Line]:
    """Union and sum; nothing without results."""
    measures = [row.measure for row in rows if row.entrant == entrant]
    if not measures:
        return []
    color = _COLORS[entrant]
    unions = [(found.cells, found.union_excess) for found in measures]
    sums = [(found.cells, found.sum_excess) for found in measures]
    return [Line(f"{entrant}, union", color, unions), Line(f"{entrant}, sum", color, sums, dashed=True)]


def _written(path: Path, title: str, lines: list[Line]) -> Path:
    path.write_text(plot(title, lines), encoding="utf-8")
    return path
