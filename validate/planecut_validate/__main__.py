"""`validate/run [options] PATH…`: checks models, prints a table, exits with 1 where anything differs."""

import argparse
import os
import sys
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from importlib.metadata import version
from pathlib import Path

from . import table
from .batch import CSG, MODELS, check_many_identities, check_random
from .checks import check
from .model import FORMATS
from .report import write_report
from .result import Options, Result

WORKSPACE = Path(__file__).resolve().parents[2]
_MOST_OF_CSG = 24
"""Leaves of a random OpenSCAD tree: one of its leaves may be a thousand faces."""


def main() -> int:
    arguments = _arguments()
    options = Options(
        str(arguments.planecut), arguments.lines, arguments.seed, not arguments.no_cells, arguments.reference
    )
    if not os.access(options.binary, os.X_OK):
        return _unusable(
            f"{options.binary}: no such program; build it with `cargo build --release` or name one with --planecut"
        )
    models: list[Path] = []
    for path in arguments.paths:
        found = _models(path)
        if not found:
            return _unusable(f"{path}: no model found, expected {', '.join(FORMATS)}")
        models += found
    if not (models or arguments.random or arguments.random_csg or arguments.identities):
        return _unusable("nothing to check: no PATH, no --random, no --random-csg, no --identities")
    with ProcessPoolExecutor(max(1, arguments.jobs)) as pool:
        results = _check_all(models, arguments, options, pool)
    for path in arguments.report or [WORKSPACE / "out/validate.html"]:
        write_report(path, results, options)
    return 1 if any(r.failures for r in results) else 0


def _check_all(
    models: list[Path], arguments: argparse.Namespace, options: Options, pool: ProcessPoolExecutor
) -> list[Result]:
    """Runs what was asked for, and prints it as it goes."""
    results: list[Result] = []
    if models:
        print(
            f"{len(models)} models, {options.lines} lines each, seed {options.seed}, manifold3d {version('manifold3d')}"
        )
        # Large ones first would be faster, but the table should come in the order of the names.
        results += _told(pool.map(partial(check, options=options), models), [str(m) for m in models])
    if arguments.random:
        print(f"{arguments.random} random trees of up to {arguments.leaves} leaves, from seed {options.seed}")
        results += table.summed(check_random(MODELS, arguments.random, arguments.leaves, options, arguments.keep, pool))
    if arguments.random_csg:
        most = min(arguments.leaves, _MOST_OF_CSG)
        print(f"{arguments.random_csg} random OpenSCAD trees of up to {most} leaves, from seed {options.seed}")
        results += table.summed(check_random(CSG, arguments.random_csg, most, options, arguments.keep, pool))
    if arguments.identities:
        print(f"{arguments.identities} identities over random solids, from seed {options.seed}")
        results += table.summed(
            check_many_identities(arguments.identities, arguments.leaves, options, arguments.keep, pool)
        )
    return results


def _told(found: Iterable[Result], names: list[str]) -> list[Result]:
    results = list(table.rows(found, names))
    failed = sum(bool(r.failures) for r in results)
    print(f"{len(results) - failed} of {len(results)} models agree")
    return results


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="validate/run", description="Checks planecut's output against manifold3d.")
    add = parser.add_argument
    add("paths", nargs="*", type=Path, metavar="PATH", help="a model, or a folder to search for models")
    add("--planecut", type=Path, default=WORKSPACE / "target/release/planecut", help="the program to check")
    add("--lines", type=int, default=20_000, help="random lines per model (default %(default)s)")
    add("--seed", type=int, default=1, help="seed of the lines, and of the first random tree (default %(default)s)")
    add("--random", type=int, default=0, metavar="N", help="check N random trees")
    add("--random-csg", type=int, default=0, metavar="N", help="check N random OpenSCAD trees")
    add("--identities", type=int, default=0, metavar="N", help="check N identities of set algebra over random solids")
    add("--leaves", type=int, default=60, help="most leaves of a random tree (default %(default)s)")
    add(
        "--keep",
        type=Path,
        default=WORKSPACE / "out/failures",
        help="where failing random trees are written, made small",
    )
    add("--no-cells", action="store_true", help="check skins only")
    add("--reference", type=Path, help="known volumes of the models (default: reference.json beside or above them)")
    add("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="models at once (default: one per core)")
    add(
        "--report",
        type=Path,
        action="append",
        help="all figures as .json, or table and plot as .html (default out/validate.html)",
    )
    return parser.parse_args()


def _unusable(message: str) -> int:
    print(f"error: {message}", file=sys.stderr)
    return 2


def _models(path: Path) -> list[Path]:
    """The file itself, or all models below the folder: those of the formats, and of other JSON there none."""
    if not path.is_dir():
        return [path] if path.is_file() and path.suffix.lower() in FORMATS else []
    files = [file for file in sorted(path.rglob("*")) if file.is_file() and file.suffix.lower() in FORMATS]
    return [file for file in files if file.suffix.lower() != ".json" or b'"planecut"' in file.read_bytes()]


if __name__ == "__main__":
    sys.exit(main())
