"""`validate/run [options] PATH…`: checks models, prints a table, exits with 1 where anything differs."""

import argparse
import json
import math
import os
import sys
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

from .checks import Result, check
from .model import FORMATS

WORKSPACE = Path(__file__).resolve().parents[2]


def main() -> int:
    arguments = _arguments()
    binary = str(arguments.planecut)
    if not os.access(binary, os.X_OK):
        return _unusable(f"{binary}: no such program; build it with `cargo build --release` or name one with --planecut")
    models: list[Path] = []
    for path in arguments.paths:
        found = _models(path)
        if not found:
            return _unusable(f"{path}: no model found, expected {', '.join(FORMATS)}")
        models += found
    print(f"{len(models)} models, {arguments.lines} lines each, seed {arguments.seed}, manifold3d {version('manifold3d')}")
    width = min(44, max(len(_short(str(m))) for m in models))
    print(_ROW.format(*_HEAD, w=width))
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


def _unusable(message: str) -> int:
    print(f"error: {message}", file=sys.stderr)
    return 2


def _models(path: Path) -> list[Path]:
    """The file itself, or all models below the folder."""
    files = sorted(path.rglob("*")) if path.is_dir() else [path]
    return [file for file in files if file.is_file() and file.suffix.lower() in FORMATS]


_ROW = "{:<{w}} {:>7} {:>16} {:>8} {:>8} {:>8} {:>9} {:>6} {:>7} {:>5}  {}"
_HEAD = ("model", "brushes", "volume", "solid", "mesh", "all", "triangles", "lines", "redrawn", "s", "status")


def _short(name: str) -> str:
    return "/".join(Path(name).parts[-2:])


def _print_row(result: Result, width: int) -> None:
    """Columns `solid`, `mesh`, `all`: relative volume difference of report and OBJ, and the largest of all differences."""
    difference = result.differences
    exact = [value for name, value in difference.items() if name != "GLB volume"]
    print(
        _ROW.format(
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
            "; ".join([result.status, *result.notes]),
            w=width,
        ),
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
        "manifold3d": version("manifold3d"),
        "lines": arguments.lines,
        "seed": arguments.seed,
        "agree": not any(r.failures for r in results),
        "models": rows,
    }
    arguments.report.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
