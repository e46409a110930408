"""Long work: Ctrl-C ends it, progress is told, and the interpreter goes on meanwhile."""

from __future__ import annotations

import functools
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import planecut as pc
import pytest
from oracles import generator

BOUND = 1.0
"""Seconds after which Ctrl-C must have been seen at the latest; 0.2 are promised, and this machine may be busy."""


def heap(count: int) -> pc.Solid:
    """A heap of spheres, never evaluated before."""
    rng = generator(count)
    return pc.union([pc.sphere(1, 16).translate(rng.uniform(0, 1.2 * count ** (1 / 3), 3)) for _ in range(count)])


LONG = {
    "mesh": lambda progress=None: heap(3000).mesh(progress=progress),
    "cells": lambda progress=None: heap(250).cells(progress=progress),
    "coarsen a solid": lambda progress=None: pc.coarsen(heap(100), 8, progress=progress),
    "coarsen a mesh": lambda progress=None: pc.coarsen(MESHES[0], 8, progress=progress),
    "Live": lambda progress=None: pc.Live(heap(3000), progress=progress),
}
SILENT = {
    "volume": lambda: heap(3000).volume,
    "contains": lambda: heap(400).contains(generator().uniform(0, 9, (400_000, 3))),
    "ray_cast": lambda: heap(3000).ray_cast([[0, 0, 0]], [[1, 1, 1]]),
    "save": lambda: heap(3000).save(os.devnull + ".obj"),
    "render": lambda: heap(3000).render(),
    "check": lambda: [MESHES[0].check() for _ in range(200)],
}
MESHES: list[pc.Mesh] = []


@pytest.fixture(autouse=True, scope="module")
def meshes():
    MESHES.append(heap(100).mesh())
    yield
    MESHES.clear()


SHORTER = {
    "mesh": (600, lambda count, progress: heap(count).mesh(progress=progress)),
    "cells": (40, lambda count, progress: heap(count).cells(progress=progress)),
    "coarsen a solid": (14, lambda count, progress: pc.coarsen(heap(count), 4, progress=progress)),
    "coarsen a mesh": (14, lambda count, progress: pc.coarsen(heap(count).mesh(), 4, progress=progress)),
    "Live": (300, lambda count, progress: pc.Live(heap(count), progress=progress)),
}
"""Work on a number of spheres, and a number of them to begin with."""


@functools.cache
def count_for(name: str, seconds: float = 0.5) -> int:
    """A number of spheres with which the work takes this long at least, however fast the machine is: progress is told and signals are seen every 50 ms."""
    count, work = SHORTER[name]
    while True:
        begin = time.perf_counter()
        work(count, None)
        if time.perf_counter() - begin >= seconds:
            return count
        count *= 2


def interrupted_after(work, send=lambda: signal.raise_signal(signal.SIGINT), delay=0.25):
    """The seconds between a signal and the exception that it raises."""
    sent = []

    def later():
        sent.append(time.perf_counter())
        send()

    timer = threading.Timer(delay, later)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        work()
        # work that was done before the signal proves nothing
        timer.join()
        time.sleep(0.5)
        pytest.fail("the work was done before it could be interrupted")
    seen = time.perf_counter() - sent[0]
    timer.join()
    return seen


@pytest.mark.parametrize("name", [*LONG, *SILENT])
def test_ctrl_c_ends_long_work(name):
    seen = interrupted_after(lambda: (LONG.get(name) or SILENT[name])())
    print(f"{name}: KeyboardInterrupt after {1000 * seen:.0f} ms")
    assert seen < BOUND


@pytest.mark.skipif(not hasattr(os, "kill"), reason="no signals on this system")
def test_ctrl_c_from_outside_ends_a_script():
    code = """
import sys, time
sys.path.insert(0, "tests")
from test_interrupt import heap
solid = heap(3000)
print("ready", flush=True)
try: solid.mesh()
except KeyboardInterrupt: print("interrupted", solid.translate([1, 0, 0]) is not None, flush=True)
"""
    folder = Path(__file__).parent
    process = subprocess.Popen([sys.executable, "-c", code.replace('"tests"', repr(str(folder)))], stdout=subprocess.PIPE, text=True, cwd=folder)
    try:
        lines = iter(process.stdout.readline, "")
        assert any(line.startswith("ready") for line in lines)
        time.sleep(0.3)
        sent = time.perf_counter()
        process.send_signal(signal.SIGINT)
        assert any(line == "interrupted True\n" for line in lines)
        print(f"after {1000 * (time.perf_counter() - sent):.0f} ms")
        assert time.perf_counter() - sent < BOUND
        # the threads that worked stop soon
        assert process.wait(20) == 0
    finally:
        process.kill()


def test_a_handler_of_a_signal_may_raise_what_it_likes():
    class Enough(Exception):
        pass

    def handler(number, frame):
        raise Enough

    before = signal.signal(signal.SIGTERM, handler)
    timer = threading.Timer(0.2, signal.raise_signal, [signal.SIGTERM])
    try:
        timer.start()
        with pytest.raises(Enough):
            heap(3000).mesh()
    finally:
        timer.join()
        signal.signal(signal.SIGTERM, before)


def test_a_signal_that_raises_nothing_ends_nothing():
    seen = []
    before = signal.signal(signal.SIGTERM, lambda number, frame: seen.append(time.perf_counter()))
    count = count_for("mesh")
    timer = threading.Timer(0.1, signal.raise_signal, [signal.SIGTERM])
    try:
        timer.start()
        mesh = heap(count).mesh()
    finally:
        timer.join()
        signal.signal(signal.SIGTERM, before)
    assert len(seen) == 1 and mesh.is_watertight


def test_what_was_interrupted_can_be_asked_again():
    count = count_for("mesh")
    solid, expected = heap(count), heap(count).mesh()
    timer = threading.Timer(0.1, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        solid.mesh()
    timer.join()
    mesh = solid.mesh()
    assert mesh.vertices.tobytes() == expected.vertices.tobytes()
    assert mesh.triangles.tobytes() == expected.triangles.tobytes()


def processor_time_after(work, seconds=3.0):
    """How many seconds after an interrupt the process still works; `seconds` if it does not stop."""
    interrupted_after(work)
    begin = quiet = time.perf_counter()
    last = time.process_time()
    while (now := time.perf_counter()) - begin < seconds and now - quiet < 0.5:
        time.sleep(0.05)
        used = time.process_time()
        if used - last > 0.015:
            quiet = time.perf_counter()
        last = used
    return quiet - begin


@pytest.mark.parametrize("name", ["mesh", "cells", "coarsen a solid", "coarsen a mesh"])
def test_nothing_goes_on_after_ctrl_c(name):
    after = processor_time_after(LONG[name])
    print(f"{name}: at work for {1000 * after:.0f} ms after the interrupt")
    assert after < BOUND


# ---- progress


@functools.cache
def told_by(name):
    """The calls of a function for progress, with the thread that made each."""
    calls = []
    _, work = SHORTER[name]
    work(count_for(name), lambda done, total: calls.append((done, total, threading.get_ident())))
    print(name, [call[:2] for call in calls])
    return calls


@pytest.mark.parametrize("name", SHORTER)
def test_progress_ends_with_all_that_is_to_be_done(name):
    calls = told_by(name)
    assert calls and calls[-1][0] == calls[-1][1] > 0
    assert all(isinstance(number, int) for call in calls for number in call)
    assert all(0 <= done <= total for done, total, _ in calls)
    assert {thread for _, _, thread in calls} == {threading.get_ident()}, "it is called by the thread that waits"
    assert all(a[:2] != b[:2] for a, b in zip(calls, calls[1:])), "there is news in each call"


@pytest.mark.parametrize("name", ["mesh", "cells", "coarsen a solid", "coarsen a mesh"])
def test_progress_is_told_on_the_way_and_never_falls(name):
    calls = told_by(name)
    shares = [done / total for done, total, _ in calls]
    assert len(set(shares)) > 2, "work of half a second is told about more often than at its end"
    assert shares == sorted(shares)


@pytest.mark.parametrize("error", [RuntimeError("enough"), KeyboardInterrupt(), SystemExit(3), StopIteration()], ids=repr)
def test_what_progress_raises_comes_out(error):
    def progress(done, total):
        raise error

    solid = pc.box([0, 0, 0], [1, 1, 1]) - pc.sphere(0.5)
    for work in (solid.mesh, solid.cells, lambda progress: pc.coarsen(solid, 2, progress=progress), lambda progress: pc.Live(solid, progress=progress)):
        with pytest.raises(type(error)) as found:
            work(progress=progress)
        assert found.value is error
    assert solid.mesh().is_watertight


def test_progress_that_takes_other_arguments_is_a_type_error():
    with pytest.raises(TypeError):
        heap(10).mesh(progress=lambda: None)


def test_progress_may_ask_the_same_solid():
    solid = heap(30)
    seen = []
    solid.mesh(progress=lambda done, total: seen.append(solid.volume))
    assert seen and set(seen) == {solid.volume}


# ---- the interpreter's lock


@pytest.mark.parametrize("name", ["mesh", "cells", "coarsen a solid", "coarsen a mesh", "Live"])
def test_other_threads_go_on_during_long_work(name):
    count, (_, work) = count_for(name), SHORTER[name]
    stop = threading.Event()
    ticks = []

    def tick():
        while not stop.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    try:
        while not ticks:
            time.sleep(0.001)
        begin = time.perf_counter()
        work(count, None)
        end = time.perf_counter()
    finally:
        stop.set()
        thread.join()
    during = [begin, *(tick for tick in ticks if begin <= tick <= end), end]
    gap = max(b - a for a, b in zip(during, during[1:]))
    print(f"{name}: {len(during)} ticks in {end - begin:.2f} s, the longest gap {1000 * gap:.0f} ms")
    assert len(during) > 20 and gap < max(0.5 * (end - begin), 0.1)
