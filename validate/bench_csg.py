"""Times planecut beside manifold3d on OpenSCAD trees, in turns (`validate/run --bench-csg PATH…`).

manifold3d evaluates the tree in this process: making primitives and all operations are on the clock, reading the text and
loading fonts are not. planecut is a process of its own: its time is what its report says for everything from the text to
the triangles; `wall` is the whole process as a user meets it, mesh file written. Both have all cores, and the best of some
rounds counts.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path

from planecut_validate.csg_file import evaluator, parsed
from planecut_validate.known import known

WORKSPACE = Path(__file__).resolve().parents[1]
_STAGES = ("import", "evaluate", "weld", "triangulate")
_ROW = "{:<44} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7} {:>9} {:>8}  {}"
_HEAD = ("tree", "planecut", "wall", "manifold", "making", "boolean", "ratio", "openscad", "× that", "")


@dataclass
class Times:
    """Milliseconds of one tree, each the best of all rounds; nothing where a side has no answer.

    For programs that ask for more, all rounds of both, and their volumes.
    """

    name: str
    planecut: float | None = None
    wall: float | None = None
    making: float | None = None
    boolean: float | None = None
    openscad: float | None = None
    stages: str = ""
    note: str = ""
    planecut_rounds: list[float] = field(default_factory=list)
    manifold_rounds: list[float] = field(default_factory=list)
    planecut_volume: float | None = None
    manifold_volume: float | None = None

    @property
    def manifold(self) -> float | None:
        return None if self.making is None else self.making + self.boolean

    @property
    def ratio(self) -> float | None:
        """planecut's time over manifold3d's."""
        return self.planecut / self.manifold if self.planecut is not None and self.manifold else None


def main() -> int:
    arguments = _arguments()
    if not os.access(arguments.planecut, os.X_OK):
        print(f"error: {arguments.planecut}: no such program; build it with `cargo build --release` or use --planecut")
        return 2
    paths = [file for path in arguments.paths for file in ([path] if path.is_file() else sorted(path.rglob("*.csg")))]
    print(f"{len(paths)} trees, best of {arguments.rounds} rounds in turns, milliseconds, {len(os.sched_getaffinity(0))} cores, "
          f"manifold3d {version('manifold3d')}")  # fmt: skip
    print(_ROW.format(*_HEAD))
    every = []
    for path in paths:
        every.append(_bench(path, str(arguments.planecut), arguments.rounds))
        print(_row(every[-1]), flush=True)
        # after each tree, so that a run that is ended has something to show
        if arguments.json:
            arguments.json.write_text(json.dumps([vars(t) for t in every], indent=1) + "\n", encoding="utf-8")
    _print_totals(every)
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="validate/run --bench-csg", description="Times planecut beside manifold3d.")
    parser.add_argument("paths", nargs="+", type=Path, metavar="PATH")
    parser.add_argument("--planecut", type=Path, default=WORKSPACE / "target/release/planecut")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json", type=Path, help="write all figures there as well")
    return parser.parse_args()


def _bench(path: Path, binary: str, rounds: int) -> Times:
    times = Times("/".join(path.parts[-2:]))
    entry = known(path)
    times.openscad = None if entry is None or entry.openscad_seconds is None else 1e3 * entry.openscad_seconds
    try:
        top = parsed(path)
        _evaluate(Times(""), top, path)
    except (ValueError, ArithmeticError) as error:
        times.note, top = f"manifold3d: {error}", None
    with tempfile.TemporaryDirectory(prefix="planecut-bench-") as folder:
        for _ in range(rounds):
            if top is not None:
                _evaluate(times, top, path)
            if not _run_planecut(times, path, binary, Path(folder)):
                break
    return times


def _evaluate(times: Times, top: list, path: Path) -> None:
    begin = time.perf_counter()
    held = evaluator(path).solid(top)
    made = time.perf_counter()
    if held is not None:
        held.solid.num_tri()
    end = time.perf_counter()
    times.manifold_rounds.append(1e3 * (end - begin))
    times.manifold_volume = 0.0 if held is None else held.solid.volume()
    if times.manifold is None or end - begin < 1e-3 * times.manifold:
        times.making, times.boolean = 1e3 * (made - begin), 1e3 * (end - made)


def _run_planecut(times: Times, path: Path, binary: str, folder: Path) -> bool:
    report = folder / "report.json"
    command = [binary, "build", str(path), "-o", str(folder / "out.glb"), "--report", str(report), "--quiet"]
    begin = time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    except subprocess.TimeoutExpired:
        times.note = "planecut: no end within 300 s"
        return False
    wall = 1e3 * (time.perf_counter() - begin)
    if done.returncode not in (0, 3):
        times.note = f"planecut: {(done.stderr.strip().splitlines() or ['no message'])[-1][-120:]}"
        return False
    told = json.loads(report.read_text(encoding="utf-8"))
    spent = told["time_ms"]
    own = sum(spent.get(stage, 0.0) for stage in _STAGES)
    times.planecut_rounds.append(own)
    times.planecut_volume = told["solid"]["volume"]
    if times.planecut is None or own < times.planecut:
        times.planecut = own
        times.stages = ", ".join(f"{stage} {spent.get(stage, 0.0):.1f}" for stage in _STAGES)
    times.wall = wall if times.wall is None else min(wall, times.wall)
    return True


def _row(times: Times) -> str:
    faster = times.openscad / times.wall if times.openscad and times.wall else None
    figures = (times.planecut, times.wall, times.manifold, times.making, times.boolean)
    shown = ["" if f is None else f"{f:.2f}" for f in figures]
    shown.append("" if times.ratio is None else f"{times.ratio:.2f}")
    shown.append("" if times.openscad is None else f"{times.openscad:.0f}")
    shown.append("" if faster is None else f"{faster:.0f}")
    mark = "" if times.ratio is None or times.ratio <= 1.0 else "SLOWER THAN TWICE" if times.ratio > 2.0 else "slower"
    told = (mark, times.note, f"({times.stages})" if mark else "")
    return _ROW.format(times.name[-44:], *shown, " ".join(filter(None, told)))


def _print_totals(every: list[Times]) -> None:
    both = [t for t in every if t.ratio is not None]
    own, other = (sum(getattr(t, name) for t in both) for name in ("planecut", "manifold"))
    if both:
        print(f"{len(both)} trees by both: planecut {own:.0f} ms, manifold3d {other:.0f} ms, {own / other:.2f} of it in sum; "
              f"median ratio {sorted(t.ratio for t in both)[len(both) // 2]:.2f}")  # fmt: skip
    for factor in (1.0, 2.0):
        slow = sorted((t for t in both if t.ratio > factor), key=lambda t: -t.ratio)
        names = ", ".join(f"{t.name} {t.ratio:.1f} ({t.planecut:.1f} ms)" for t in slow)
        print(f"slower than {factor:.0f} × manifold3d: {len(slow)}" + (f": {names}" if slow else ""))
    timed = [t for t in every if t.openscad and t.wall]
    if timed:
        theirs, wall, own = sum(t.openscad for t in timed), sum(t.wall for t in timed), sum(t.planecut for t in timed)
        print(f"OpenSCAD on {len(timed)} trees: {theirs:.0f} ms; planecut {wall:.0f} ms wall ({theirs / wall:.0f} ×), "
              f"{own:.0f} ms by its report ({theirs / own:.0f} ×)")  # fmt: skip
    missing = [t.name for t in every if t.planecut is None]
    if missing:
        print(f"no result of planecut: {len(missing)}: {', '.join(missing)}")


if __name__ == "__main__":
    sys.exit(main())
