"""Results as files: all figures as JSON, or a page with the table and a plot of the differences."""

import html
import json
import math
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

from .plot import differences_plot
from .result import SAME, Options, Result
from .table import largest, short


def write_report(path: Path, results: list[Result], options: Options) -> None:
    """Writes the report, as a page where the name ends in `.html`, else as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = _page(results, options) if path.suffix == ".html" else _figures(results, options)
    path.write_text(text, encoding="utf-8")


def _figures(results: list[Result], options: Options) -> str:
    rows = [asdict(r) for r in results]
    for row in rows:
        if math.isnan(row["reference_volume"]):
            row["reference_volume"] = None
    report = {
        "manifold3d": version("manifold3d"),
        "lines": options.lines,
        "seed": options.seed,
        "agree": not any(r.failures for r in results),
        "models": rows,
    }
    return json.dumps(report, indent=1) + "\n"


_STYLE = """
body { font: 14px/1.4 system-ui, sans-serif; margin: 2em auto; max-width: 75em; padding: 0 1em; color: #222; }
table { border-collapse: collapse; font-size: 13px; } td, th { padding: 2px 10px; text-align: right; border-bottom: 1px solid #ddd; }
td:first-child, th:first-child, td:last-child, th:last-child { text-align: left; } .fail { color: #b00020; font-weight: 600; }
"""
_COLUMNS = ("model", "bodies", "cells", "volume", "largest difference", "triangles", "lines that differ", "status")


def _page(results: list[Result], options: Options) -> str:
    failed = sum(bool(r.failures) for r in results)
    head = "".join(f"<th>{name}</th>" for name in _COLUMNS)
    told = f"{len(results) - failed} of {len(results)} agree, {options.lines} lines each, seed {options.seed}, "
    return (
        f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>planecut beside manifold3d</title>\n<style>{_STYLE}</style>\n'
        f"<h1>planecut beside manifold3d</h1>\n<p>{told}manifold3d {version('manifold3d')}. "
        f"Each dot is one relative difference of one model; what is 0 stands at the foot. The limit is {SAME:.0e}.</p>\n"
        f"{differences_plot(results)}\n<table><tr>{head}</tr>\n" + "\n".join(map(_row, results)) + "\n</table></html>\n"
    )


def _row(result: Result) -> str:
    every = largest(result)
    volume = "" if math.isnan(result.reference_volume) else f"{result.reference_volume:.6f}"
    cells = "" if result.cells is None else str(result.cells)
    wrong = str(result.lines.get("mismatches", ""))
    values = [short(result.model), str(result.brushes), cells, volume, "" if every is None else f"{every:.1e}"]
    values += [str(result.triangles), wrong, "; ".join([result.status, *result.failures, *result.notes])[:400]]
    mark = ' class="fail"' if result.failures else ""
    return f"<tr{mark}>" + "".join(f"<td>{html.escape(v)}</td>" for v in values) + "</tr>"
