"""Times of the Python package beside those of the library: package_times.py LIBRARY_TIMES LEVEL.map"""

import json
import statistics
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable

import numpy as np
import planecut as pc

_COUNT = 400


def main() -> None:
    """Prints a table: what, the library and the package in microseconds, the ratio."""
    program, level = sys.argv[1:]
    # by turns, so that a machine that is busy for a while is so for both
    library, package = [], []
    for _ in range(3):
        library.append(json.loads(subprocess.run([program, level], check=True, capture_output=True, text=True).stdout))
        package.append({"small_8": _small(8), "small_32": _small(32), "edit": _edit(level)})
    print(f"{'':<12}{'library µs':>12}{'package µs':>12}{'ratio':>8}{'package less 20 µs':>20}")
    for name in package[0]:
        ours, theirs = (min(run[name] for run in runs) for runs in (package, library))
        print(f"{name:<12}{theirs:>12.1f}{ours:>12.1f}{ours / theirs:>8.2f}{(ours - 20) / theirs:>20.2f}")
    print(f"two threads, each a model on one thread: {_two_threads():.2f} times as fast as one after the other")
    print(f"a tree of 10,000 nodes: {_tree():.1f} ms")
    triangles, handed = _views()
    print(f"the arrays of {triangles} triangles: {handed:.1f} µs")


def _median(times: list[float]) -> float:
    return statistics.median(times) * 1e6


def _timed(work: Callable[[], object]) -> float:
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def _small(segments: int) -> float:
    make = lambda: (pc.box([0, 0, 0], [4, 2, 1]) - pc.sphere(0.5, segments=segments)).volume  # noqa: E731
    return _median([_timed(make) for _ in range(_COUNT)])


def _edit(level: str) -> float:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        live = pc.Live(pc.load(level))
    times = []
    for brush in live.brushes[:_COUNT].tolist():
        plane, (x, y, z, offset) = next(iter(live.planes(brush).items()))
        for moved in (offset + float(np.linalg.norm((x, y, z))), offset):
            begin = time.perf_counter()
            with live.edit() as edit:
                edit.move_plane(brush, plane, moved)
            times.append(time.perf_counter() - begin)
    return _median(times)


def _grid(height: float) -> pc.Solid:
    places = [(0.9 * i, 0.9 * j, height) for i in range(8) for j in range(8)]
    return pc.union([pc.sphere(1, segments=24).translate(place) for place in places])


def _two_threads() -> float:
    ratios = []
    for turn in range(5):
        one_by_one, together = ([_grid(0.01 * turn + 0.1 * k) for k in range(2)] for _ in range(2))
        alone = _timed(lambda: [solid.mesh(threads=1) for solid in one_by_one])
        threads = [threading.Thread(target=solid.mesh, kwargs={"threads": 1}) for solid in together]
        both = _timed(lambda: [thread.start() for thread in threads] + [thread.join() for thread in threads])
        ratios.append(alone / both)
    return statistics.median(ratios)


def _tree() -> float:
    def build() -> None:
        block = solid = pc.box([0, 0, 0], [1, 1, 1])
        for _ in range(10_000):
            solid = solid | block

    return 1e3 * min(_timed(build) for _ in range(5))


def _views() -> tuple[int, float]:
    solid = pc.union([pc.sphere(1, segments=320).translate([3 * k, 0, 0]) for k in range(10)])
    triangles = len(solid.mesh().triangles)

    def views() -> None:
        mesh = solid.mesh()
        mesh.vertices, mesh.triangles  # noqa: B018

    return triangles, 1e6 * min(_timed(views) for _ in range(5))


main()
