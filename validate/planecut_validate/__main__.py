"""`validate/run [options] PATH…`: checks models, prints a table, exits with 1 where anything differs."""

import argparse
import json
import math
import os
import sys
from dataclasses import asdict
from pathlib import Path

import manifold3d
import numpy

from .checks import Result, check
from .model import FORMATS

WORKSPACE = Path(__file__).resolve().parents[2]


def main() -> int:
    arguments = _arguments()
    binary = str(arguments.planecut)
    if not os.access(binary, os.X_OK):
        print(f"error: {binary}: no such program; build it with `cargo build --release` or name one with --planecut")
        return 2
    models = _models(arguments.paths)
    if not models:
        print(f"error: {', '.join(map(str, arguments.paths))}: no model found, expected {', '.join(FORMATS)} files")
        return 2
    print(f"{len(models)} models, {arguments.lines} lines each, seed {arguments.seed}, numpy {numpy.__version__}")
    width = min(44, max(len(_short(str(m))) for m in models))
    print(_HEAD.format("model", "brushes", "volume", "solid", "mesh", "all", "triangles", "lines", "redrawn", "s", w=width))
    results = []
    for path in models:
        result = check(path, binary, arguments.lines, arguments.seed)
        results.append(result)
        _print_row(result, width)
    failed = sum(bool(r.failures) for r in results)
    print(f"{len(results) - failed} of {len(results)} models agree")
    if arguments.report:
        _write_report(arguments, results)
    return 1 if failed else 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="validate/run", description="Checks planecut's output against manifold3d.")
    parser.add_argument("paths", nargs="+", type=Path, metavar="PATH", help="a model, or a folder to search for models")
    parser.add_argument("--planecut", type=Path, default=WORKSPACE / "target/release/planecut", help="the program to check")
    parser.add_argument("--lines", type=int, default=20_000, help="random lines per model (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the lines (default %(default)s)")
    parser.add_argument("--report", type=Path, help="write all figures as JSON")
    return parser.parse_args()


def _models(paths: list[Path]) -> list[Path]:
    found: list[Path] = []
    for path in paths:
        inside = sorted(p for p in path.rglob("*") if p.suffix.lower() in FORMATS) if path.is_dir() else [path]
        found += inside
    return [p for p in found if p.is_file() and p.suffix.lower() in FORMATS]


_HEAD = "{:<{w}} {:>7} {:>16} {:>8} {:>8} {:>8} {:>9} {:>6} {:>7} {:>5}  status"


def _short(name: str) -> str:
    return "/".join(Path(name).parts[-2:])


def _print_row(result: Result, width: int) -> None:
    """Columns `solid`, `mesh`, `all`: relative volume difference of report and OBJ, and the largest of all differences."""
    difference = result.differences
    exact = [value for name, value in difference.items() if name != "GLB volume"]
    print(
        _HEAD.format(
            _short(result.model)[-width:],
            result.brushes,
            "" if math.isnan(result.reference_volume) else f"{result.reference_volume:.6f}"[:16],
            f"{difference['solid.volume']:.0e}" if "solid.volume" in difference else "",
            f"{difference['OBJ volume']:.0e}" if "OBJ volume" in difference else "",
            f"{max(exact):.0e}" if exact else "",
            result.triangles,
            result.lines.get("mismatches", ""),
            result.lines.get("redrawn", ""),
            f"{result.seconds:.1f}",
            w=width,
        ).replace("  status", f"  {result.status}"),
        f"({'; '.join(result.notes)})" if result.notes else "",
        flush=True,
    )
    for failure in result.failures:
        print(f"    {failure}", flush=True)


def _write_report(arguments: argparse.Namespace, results: list[Result]) -> None:
    rows = [asdict(r) for r in results]
    for row in rows:
        if math.isnan(row["reference_volume"]):
            row["reference_volume"] = None
    report = {
        "manifold3d": _version(manifold3d),
        "lines": arguments.lines,
        "seed": arguments.seed,
        "agree": not any(r.failures for r in results),
        "models": rows,
    }
    arguments.report.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


def _version(module) -> str:
    from importlib.metadata import version

    return version(module.__name__)


if __name__ == "__main__":
    sys.exit(main())
