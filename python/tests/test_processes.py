"""Pickles, copies, threads and processes."""

from __future__ import annotations

import concurrent.futures
import copy
import multiprocessing
import pickle
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import planecut as pc
import pytest
from oracles import Tree, generator


def some_solid() -> pc.Solid:
    return Tree(generator(), 7).solid() | pc.box([-1, -1, -1], [1, 1, 1], material="clay")


def large_solid(count: int = 60) -> pc.Solid:
    """One that is evaluated by a job, not at once."""
    rng = generator(1)
    return pc.union([pc.sphere(1, 12).translate(rng.uniform(0, 4, 3)) for _ in range(count)])


def some_live() -> pc.Live:
    live = pc.Live(pc.box([0, 0, 0], [4, 4, 4]) - pc.box([1, 1, 1], [2, 2, 5]))
    with live.edit() as e:
        e.add_brush(pc.sphere(1, 8).translate([4, 4, 4]))
    return live


def assert_same(a: pc.Mesh, b: pc.Mesh) -> None:
    for name in ("vertices", "triangles", "face_ids", "material_ids"):
        assert getattr(a, name).tobytes() == getattr(b, name).tobytes(), name
    assert a.materials == b.materials


# ---- pickles and copies


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_solids_meshes_polytopes_and_live_models_pickle(protocol):
    def again(value):
        return pickle.loads(pickle.dumps(value, protocol))

    solid, live = some_solid(), some_live()
    assert_same(again(solid).mesh(), solid.mesh())
    assert_same(again(solid.mesh()), solid.mesh())
    assert_same(again(live).mesh(), live.mesh())
    assert again(live).volume == live.volume
    body = pc.Polytope([[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]])
    body.remove_plane(body.add_plane([1, 1, 1, 1]))
    number = body.add_plane([1, 1, 0, 1])
    other = again(body)
    np.testing.assert_array_equal(other.plane_ids, body.plane_ids)
    # it is rebuilt from the same planes, so that corners may come in another order
    assert sorted(other.vertices.tolist()) == sorted(body.vertices.tolist())
    other.remove_plane(number)
    assert other.volume == 8.0 > body.volume


def test_a_pickle_that_is_cut_short_is_refused():
    for value in (some_solid(), some_solid().mesh(), some_solid().cells()[0], pc.coarsen(some_solid(), 2)):
        function, (data,) = value.__reduce__()
        for length in range(0, len(data) - 1, 97):
            with pytest.raises(pc.PlanecutError):
                function(data[:length])


def test_a_pickle_with_bytes_that_changed_ends_no_process():
    code = """
import random, planecut as pc
solid = pc.box([0, 0, 0], [1, 1, 1], "a") - pc.hull([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]])
body = pc.Polytope([[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1], [1, 1, 1, 2]])
asks = {pc.Solid: lambda s: (s.mesh(), s.cells()), pc.Mesh: lambda m: (m.check(), m.volume, m.material_ids, m.vertices.sum()), pc.Polytope: lambda p: (p.volume, p.vertices, p.faces)}
random.seed(5)
kinds = {}
for value in (solid, solid.mesh(), body):
    function, (data,) = value.__reduce__()
    for _ in range(700):
        changed = bytearray(data)
        for _ in range(random.choice([1, 1, 2, 8])):
            changed[random.randrange(len(data))] = random.randrange(256)
        try: asks[type(value)](function(bytes(changed)))
        except BaseException as error: kinds.setdefault(type(error).__name__, (type(value).__name__, str(error)))
print({name: kinds[name] for name in kinds if name != "PlanecutError"})
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=100, cwd=Path(__file__).parent)
    assert (done.returncode, done.stdout.strip()) == (0, "{}"), done.stderr[-1000:]


def test_a_pickle_with_the_number_of_no_material_is_refused():
    function, (data,) = pc.box([0, 0, 0], [1, 1, 1], "clay").__reduce__()
    errors = []
    for place, old in enumerate(data):
        if old == 0:  # among the zeros are the numbers of materials
            try:
                function(data[:place] + b"\x07" + data[place + 1 :]).mesh()
            except (pc.PlanecutError, pc.InternalError) as error:
                errors.append(type(error))
    assert errors and pc.InternalError not in errors


def test_copies_of_what_never_changes_are_the_same_object():
    solid = some_solid()
    for value in (solid, solid.mesh()):
        assert copy.copy(value) is value and copy.deepcopy([value])[0] is value


def test_copies_of_what_changes_are_objects_of_their_own():
    body = pc.Polytope([[1, 0, 0, 1]])
    for other in (copy.copy(body), copy.deepcopy(body), body.copy()):
        other.add_plane([0, 1, 0, 1])
        assert (len(other.planes), len(body.planes)) == (2, 1)
    live = some_live()
    before = live.volume
    for other in (copy.copy(live), copy.deepcopy(live)):
        with other.edit() as e:
            e.remove_brush(1)
        assert other.volume != before == live.volume


def test_cells_and_changes_pickle():
    hulls, change = pc.coarsen(some_solid(), 2), some_live().change
    again = pickle.loads(pickle.dumps(hulls))
    assert len(again) == len(hulls)
    for name in ("excess", "sum_excess", "encloses", "volume_in", "volume_out", "enclosed", "thickness", "clear_tolerance"):
        assert getattr(again, name) == getattr(hulls, name), name
    for a, b in zip([*again, pickle.loads(pickle.dumps(hulls[0]))], [*hulls, hulls[0]], strict=True):
        for name in ("planes", "vertices", "triangles"):
            assert getattr(a, name).tobytes() == getattr(b, name).tobytes(), name
        assert (a.volume, a.material) == (b.volume, b.material)
    other = pickle.loads(pickle.dumps(change))
    assert change.added and (other.added, other.removed, other.brushes) == (change.added, change.removed, change.brushes)


def test_faces_pickle_and_edits_that_are_open_do_not():
    live = some_live()
    face = live.face(int(live.faces[0]))
    again = pickle.loads(pickle.dumps(face))
    for name in ("vertices", "triangles", "normal"):
        assert getattr(again, name).tobytes() == getattr(face, name).tobytes(), name
    assert (again.brush, again.plane, again.material) == (face.brush, face.plane, face.material)
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(live.edit())


# ---- processes

INHERITED: dict[str, object] = {}


def in_child(solid: pc.Solid | None, live: pc.Live | None, queue) -> None:
    """Uses what was sent, or what a fork left here."""
    solid = solid or INHERITED["solid"]
    live = live or INHERITED["live"]
    before = live.volume
    with live.edit() as e:
        e.move_plane(0, 0, 9.0)
    grown = live.volume
    live.undo()
    mesh = solid.mesh()
    fresh = large_solid().volume
    hulls = len(pc.coarsen(solid, 2))
    held = int(solid.contains(np.zeros((3, 3))).sum())
    queue.put((before, grown, live.volume, mesh.vertices.tobytes(), fresh, hulls, held, live.mesh().volume))


def answers(start: str, target, *args):
    context = multiprocessing.get_context(start)
    queue = context.Queue()
    process = context.Process(target=target, args=(*args, queue))
    process.start()
    try:
        result = queue.get(timeout=40)
        process.join(20)
        assert process.exitcode == 0
        return result
    finally:
        if process.is_alive():
            process.kill()


def assert_child_agrees(result, solid, live):
    before, grown, after, vertices, fresh, hulls, held, _ = result
    assert before == live.volume == after < grown
    assert vertices == solid.mesh().vertices.tobytes()
    assert fresh == large_solid().volume
    assert hulls == len(pc.coarsen(solid, 2)) and held == solid.contains(np.zeros((3, 3))).sum()


@pytest.mark.parametrize("start", ["spawn", "forkserver"])
def test_solids_and_live_models_are_sent_to_new_processes(start):
    if start not in multiprocessing.get_all_start_methods():
        pytest.skip("not on this system")
    solid, live = some_solid(), some_live()
    assert_child_agrees(answers(start, in_child, solid, live), solid, live)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork on this system")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("is_known", [False, True])
def test_what_was_made_before_a_fork_is_used_after_it(is_known):
    solid, live = some_solid(), some_live()
    if is_known:  # all pools of threads have been at work in the parent
        assert large_solid().volume > 0 and solid.volume > 0 and live.mesh().volume > 0
        assert solid.contains(np.zeros((5000, 3))).shape == (5000,)
    INHERITED.update(solid=solid, live=live)
    try:
        assert_child_agrees(answers("fork", in_child, None, None), solid, live)
    finally:
        INHERITED.clear()
    assert large_solid().volume > 0, "the parent goes on"


def fork_again(queue) -> None:
    queue.put(answers("fork", volume_of_large))


def volume_of_large(queue) -> None:
    queue.put((large_solid().volume, some_live().volume, some_solid().volume))


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork on this system")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_child_of_a_child_works_too():
    expected = (large_solid().volume, some_live().volume, some_solid().volume)
    assert answers("fork", fork_again) == expected


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="no fork on this system")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_fork_while_another_thread_works_ends_well():
    stop = threading.Event()

    def work():
        while not stop.is_set():
            assert some_solid().volume > 0 and large_solid(20).volume > 0

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    try:
        for _ in range(5):
            assert answers("fork", volume_of_large)[0] == pytest.approx(large_solid().volume)
    finally:
        stop.set()
        for thread in threads:
            thread.join()


def volume_of(solid: pc.Solid) -> float:
    return solid.volume


def test_pools_of_processes_map_over_solids():
    solids = [Tree(generator(number), 4).solid() for number in range(6)]
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(volume_of, solids)) == [solid.volume for solid in solids]


# ---- threads


def test_threads_share_one_solid():
    expected = large_solid().mesh()
    solid = large_solid()
    points = generator().uniform(0, 4, (2000, 3))
    held = large_solid().contains(points)
    barrier = threading.Barrier(8)

    def ask(number: int):
        barrier.wait()
        if number % 2:
            return solid.contains(points)
        return solid.mesh()

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        results = list(pool.map(ask, range(8)))
    for number, result in enumerate(results):
        if number % 2:
            np.testing.assert_array_equal(result, held)
        else:
            assert_same(result, expected)


def test_threads_share_one_live_model_and_edits_do_not_mix():
    live = pc.Live(pc.box([0, 0, 0], [1, 1, 1]))
    refused, done = [], []
    barrier = threading.Barrier(4)

    def edit(number: int):
        barrier.wait()
        for turn in range(40):
            try:
                with live.edit() as e:
                    brush = e.add_brush(pc.box([3 * number, 2, 0], [3 * number + 1, 3, 1]))
                    e.move_plane(brush, 0, 3.0 * number + 2)
                done.append((number, turn))
            except pc.PlanecutError as error:
                assert "edit that is not complete" in str(error)
                refused.append(number)
            assert live.volume >= 1.0 and live.mesh().is_watertight and len(live.faces) >= 6

    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for future in [pool.submit(edit, number) for number in range(4)]:
            future.result()
    print(f"{len(done)} edits were made, {len(refused)} refused")
    assert len(done) + len(refused) == 160 and done
    assert len(live.brushes) == 1 + len(done)
    boxes = len({number for number, _ in done})
    assert live.volume == 1.0 + 2.0 * boxes
    for _ in done:
        live.undo()
    assert live.volume == 1.0


def test_threads_share_one_polytope():
    cube = [[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]]
    body = pc.Polytope(cube)

    def cut(number: int):
        for _ in range(200):
            plane = body.add_plane([1, 1, 1, 2 - number / 10])
            assert body.volume < 8.0
            body.remove_plane(plane)

    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        list(pool.map(cut, range(4)))
    assert body.volume == 8.0 and len(body.planes) == 6


def test_solids_are_freed_by_any_thread():
    solids = [large_solid(10) for _ in range(8)]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert all(volume > 0 for volume in pool.map(volume_of, solids))
        pool.submit(solids.clear).result()
    assert solids == []
