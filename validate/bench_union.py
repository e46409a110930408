"""Times manifold3d's batch union and whole runs of planecut on the same brushes, in turns (`validate/run --bench MAP`).

manifold3d is timed at its best: the hulls are made and evaluated beforehand, one union has already run, and only the
batch union with its evaluation is on the clock. planecut is timed as a user meets it: one process from the text of the
map to the finished GLB. The ways take turns, so that a busy moment of the machine does not fall on one of them alone.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

WORKSPACE = Path(__file__).resolve().parents[1]


@dataclass
class Way:
    """One way to the union: `seconds` per round, `peak` memory in bytes where it is one process per round."""

    name: str
    seconds: list[float] = field(default_factory=list)
    own: list[float] = field(default_factory=list)
    peak: int = 0

    def median(self) -> float:
        return statistics.median(self.seconds)

    def row(self, base: float) -> str:
        low, high = min(self.seconds) * 1e3, max(self.seconds) * 1e3
        own = f"{statistics.median(self.own):9.1f}" if self.own else " " * 9
        peak = f"{self.peak / 2**20:8.1f}" if self.peak else " " * 8
        return f"{self.name:<38} {self.median() * 1e3:9.1f} {low:9.1f} {high:9.1f} {own} {peak} {base / self.median():7.2f}"


def main() -> int:
    arguments = _arguments()
    if arguments.worker:
        return _worker(arguments.maps[0], arguments.worker)
    if not os.access(arguments.planecut, os.X_OK):
        print(f"error: {arguments.planecut}: no such program; build it with `cargo build --release` or use --planecut")
        return 2
    for path in arguments.maps:
        ways = _bench(path, str(arguments.planecut), arguments.rounds)
        print(f"{path.name}: {arguments.rounds} rounds in turns, {_cores()} cores")
        print(f"{'':<38} {'median ms':>9} {'min':>9} {'max':>9} {'report ms':>9} {'peak MiB':>8} {'× first':>7}")
        for way in ways:
            print(way.row(ways[0].median()))
    return 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="validate/run --bench", description="Times planecut beside manifold3d.")
    parser.add_argument("maps", nargs="+", type=Path, metavar="MAP")
    parser.add_argument("--planecut", type=Path, default=WORKSPACE / "target/release/planecut")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--worker", type=int, help=argparse.SUPPRESS)
    return parser.parse_args()


def _cores() -> int:
    return len(os.sched_getaffinity(0))


def _bench(path: Path, binary: str, rounds: int) -> list[Way]:
    """The ways, manifold3d on all cores first."""
    cores = _cores()
    counts = sorted({cores, 1}, reverse=True)
    unions = [(Way(f"manifold3d batch union, {_count(n)}"), _start_worker(path, n)) for n in counts]
    runs = [(Way(f"planecut map → glb, {_count(n)}"), n) for n in counts]
    with tempfile.TemporaryDirectory(prefix="planecut-bench-") as folder:
        for _ in range(rounds):
            for way, worker in unions:
                worker.stdin.write("union\n")
                worker.stdin.flush()
                way.seconds.append(float(worker.stdout.readline()))
            for way, threads in runs:
                _run_planecut(way, binary, path, threads, Path(folder))
    for _, worker in unions:
        worker.stdin.close()
        worker.wait()
    return [way for way, _ in unions + runs]


def _count(cores: int) -> str:
    return "1 core" if cores == 1 else f"{cores} cores"


def _start_worker(path: Path, cores: int) -> subprocess.Popen:
    command = [sys.executable, __file__, str(path), "--worker", str(cores)]
    worker = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    if worker.stdout.readline() != "ready\n":
        raise RuntimeError(f"no hulls from {path}")
    return worker


def _worker(path: Path, cores: int) -> int:
    """Makes the hulls, then answers each line of standard input with the seconds of one union."""
    # Before the import: the thread pool is made for the cores that the process may use then.
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:cores])
    import manifold3d

    from planecut_validate.model import load

    hulls = load(path).hulls
    faces = [hull.num_tri() for hull in hulls]
    assert all(faces)

    def union() -> float:
        begin = time.perf_counter()
        solid = manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add)
        solid.num_tri()
        return time.perf_counter() - begin

    union()
    print("ready", flush=True)
    for _ in sys.stdin:
        print(union(), flush=True)
    return 0


def _run_planecut(way: Way, binary: str, path: Path, threads: int, folder: Path) -> None:
    """One whole process, on as many cores as threads, as manifold3d has them."""
    report = folder / "report.json"
    command = [binary, "build", str(path), "-o", str(folder / "out.glb"), "--report", str(report), "--quiet"]
    command += ["--threads", str(threads)]
    everything = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(everything)[:threads])
    try:
        begin = time.perf_counter()
        process = os.posix_spawn(command[0], command, os.environ)
        _, status, usage = os.wait4(process, 0)
        way.seconds.append(time.perf_counter() - begin)
    finally:
        os.sched_setaffinity(0, everything)
    if os.waitstatus_to_exitcode(status) not in (0, 3):
        raise RuntimeError(f"{' '.join(command)}: exit status {os.waitstatus_to_exitcode(status)}")
    # Linux counts in KiB, macOS in bytes.
    way.peak = max(way.peak, usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024))
    total = json.loads(report.read_text()).get("time_ms", {}).get("total")
    if total is not None:
        way.own.append(total)


if __name__ == "__main__":
    sys.exit(main())
