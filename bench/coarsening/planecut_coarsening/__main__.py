"""`bench/coarsen [options]`: measures, prints, writes what is asked for, exits with 1 where planecut broke its word."""

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path

from .bullet_engine import measure_bullet
from .charts import write_charts
from .decompositions import measure_decompositions
from .exact_merges import measure_exact_merges
from .lowered import measure_lowered
from .mujoco_engine import measure_mujoco
from .page import write_page
from .results import Results
from .setting import Setting
from .whole_mesh import measure_whole_meshes

_PROJECT = Path(__file__).resolve().parents[3]


def main() -> int:
    """The exit status: 1 where planecut broke its word, 2 where nothing can be measured."""
    arguments = _arguments()
    for program in (arguments.planecut, arguments.fewer_faces):
        if not os.access(program, os.X_OK):
            return _unusable(f"{program}: no such program")
    if not arguments.data.is_dir():
        return _unusable(f"{arguments.data}: no such folder; name the one with the data with --data")
    results = _measured(arguments)
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        arguments.json.write_text(results.json(), encoding="utf-8")
    charts = write_charts(arguments.plots, results.decompositions, results.whole) if arguments.plots else {}
    if arguments.markdown:
        write_page(arguments.markdown, results, charts)
    for failure in results.failures:
        print(f"FAIL {failure}")
    return 1 if results.failures else 0


def _measured(arguments: argparse.Namespace) -> Results:
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as scratch:
        setting = Setting(arguments.planecut, arguments.fewer_faces, arguments.data, arguments.quick, Path(scratch))
        return Results(
            decompositions=measure_decompositions(setting),
            whole=measure_whole_meshes(setting),
            exact=measure_exact_merges(setting),
            lowered=measure_lowered(setting),
            mujoco=measure_mujoco(setting),
            bullet=measure_bullet(setting),
            failures=setting.failures,
            seconds=time.perf_counter() - begin,
        )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench/coarsen", description="Measures planecut's cells beside others'.")
    add = parser.add_argument
    add("--quick", action="store_true", help="few numbers of cells, others with their own settings, no slow model")
    add("--data", type=Path, default=_PROJECT.parent / "shared/data", help="folder of the inputs (default %(default)s)")
    add("--planecut", type=Path, required=True, help="the program to measure (default: built by bench/coarsen)")
    add("--fewer-faces", type=Path, required=True, help="the example of that name (default: built by bench/coarsen)")
    add("--json", type=Path, help="writes all figures")
    add("--markdown", type=Path, help="writes the page")
    add("--plots", type=Path, metavar="FOLDER", help="writes the plots, and the page shows them")
    return parser.parse_args()


def _unusable(message: str) -> int:
    print(f"error: {message}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
