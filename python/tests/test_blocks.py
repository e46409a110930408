"""Models in blocks: the solid that is evaluated at once, from files and from solids that nobody holds, and the same bytes with every engine."""

from __future__ import annotations

import json
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import planecut as pc
import pytest
from oracles import assert_refused, generator, mesh_volume, raised
from workers import Killer, needs_dask, needs_ray, ray_worker

TETRAHEDRON = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
L_SHAPE = pc.box([0, 0, 0], [2, 1, 1]) | pc.box([0, 0, 0], [1, 2, 1])


def bored(count: int, size: float, segments: int = 8) -> Iterator[pc.Solid]:
    """Boxes and spheres, each less another one."""
    rng = generator(count)
    for k in range(count):
        low, extent = rng.uniform(0, size, 3), rng.uniform(0.3, 1.2, 3)
        ball = pc.sphere(0.5, segments).translate(low + rng.uniform(0, 1, 3) * extent)
        box = pc.box(low, low + extent)
        yield ball - box if k % 3 == 0 else box - ball


def pieces_of(plan: pc.blocks.Plan) -> dict[str, bytes]:
    """The files of all pieces."""
    return {block.piece_path.name: block.piece_path.read_bytes() for block in plan.blocks}


def assert_same_solid(pieces: pc.blocks.Pieces, solid: pc.Solid) -> None:
    assert pieces.volume == pytest.approx(solid.volume, rel=1e-12)
    assert pieces.area == pytest.approx(solid.area, rel=1e-12)
    np.testing.assert_allclose(pieces.centroid, solid.centroid, rtol=1e-11)
    np.testing.assert_array_equal(pieces.bounds, solid.bounds)


# ---- the solid


def test_the_solid_is_the_one_that_is_evaluated_at_once(tmp_path: Path) -> None:
    plan = pc.blocks.plan(bored(300, 6), tmp_path, brushes=60)
    pieces = plan.evaluate()
    assert len(pieces) == len(plan.blocks) > 8
    assert_same_solid(pieces, pc.union(bored(300, 6)))
    assert (plan.counts.brushes, plan.counts.empty, plan.counts.unbounded) == (600, 0, 0)
    assert plan.counts.brush_volume_sum > pieces.volume
    assert sum(block.brushes for block in plan.blocks) >= 600
    for block in plan.blocks:
        assert block.path.stat().st_size == block.bytes and (block.min < block.max).all()
    meshes = list(pieces)
    assert pieces.triangles == sum(len(mesh.triangles) for mesh in meshes)
    assert pieces.vertices == sum(len(mesh.vertices) for mesh in meshes)
    assert pieces.faces == sum(len(mesh.face_normals) for mesh in meshes)
    assert pieces.seam_edges > 0 and len(pieces.mesh(0).triangles) == len(meshes[0].triangles)
    # pieces are open on walls: together they enclose the solid
    assert sum(mesh_volume(mesh.vertices, mesh.triangles) for mesh in meshes) == pytest.approx(pieces.volume, rel=1e-9)


def test_the_volume_is_that_of_manifold3d(tmp_path: Path) -> None:
    manifold3d = pytest.importorskip("manifold3d", reason="manifold3d is not installed")
    pieces = pc.blocks.plan(bored(300, 6), tmp_path, brushes=100).evaluate()
    # solids that touch only where rounding decides are left to each package: there are none of these here
    theirs = manifold3d.Manifold.batch_boolean([solid.mesh().to_manifold() for solid in bored(300, 6)], manifold3d.OpType.Add)
    assert pieces.volume == pytest.approx(theirs.volume(), rel=1e-9)
    assert pieces.area == pytest.approx(theirs.surface_area(), rel=1e-9)


def test_one_solid_and_none(tmp_path: Path) -> None:
    one = pc.union(bored(40, 2)) - pc.box([0.5, 0.5, 0.5], [1.5, 1.5, 1.5])
    assert_same_solid(pc.blocks.plan(one, tmp_path / "one", brushes=10).evaluate(), one)
    none = pc.blocks.plan([], tmp_path / "none").evaluate()
    assert (len(none), none.volume, none.area, none.triangles, list(none)) == (0, 0.0, 0.0, 0, [])
    assert np.isnan(none.centroid).all() and np.isnan(none.bounds).all()


def test_materials_are_those_of_all_solids(tmp_path: Path) -> None:
    solids = [pc.box([k, 0, 0], [k + 0.5, 1, 1], material=f"m{k % 3}") for k in range(30)]
    solids.append(pc.box([40, 0, 0], [41, 1, 1]).with_material("m0", color=[1, 0, 0]))
    plan = pc.blocks.plan(solids, tmp_path, brushes=5)
    pieces = plan.evaluate()
    assert plan.materials == pieces.materials == ["m0", "m1", "m2", "m0"]
    for mesh in pieces:
        named = np.array(mesh.materials)[mesh.material_ids]
        middles = mesh.vertices[mesh.triangles].mean(axis=1)[:, 0].astype(int)
        assert all(name == ("m0" if k >= 40 else f"m{k % 3}") for name, k in zip(named, middles, strict=True))
    np.testing.assert_array_equal(pieces.mesh(len(pieces) - 1).material_colors[-1], [1, 0, 0])


def test_solids_are_taken_one_by_one_and_not_kept(tmp_path: Path) -> None:
    kept: list[int] = []

    def solids() -> Iterator[pc.Solid]:
        own = object()
        for solid in (pc.box([k, 0, 0], [k + 0.5, 1, 1]) for k in range(2000)):
            yield solid
            # nobody but this function has it, as what it has made for itself
            kept.append(sys.getrefcount(solid) - sys.getrefcount(own))

    plan = pc.blocks.plan(solids(), tmp_path, brushes=500)
    assert kept == [0] * 2000
    assert plan.evaluate().volume == pytest.approx(1000)


def test_plans_and_pieces_are_found_again(tmp_path: Path) -> None:
    made = pc.blocks.plan(bored(40, 3), tmp_path / "plan", brushes=20)
    assert made.folder == tmp_path / "plan"
    pieces = made.evaluate()
    for plan in (pc.blocks.open(made.folder), pickle.loads(pickle.dumps(made))):
        assert [block.place for block in plan.blocks] == [block.place for block in made.blocks]
    assert pickle.loads(pickle.dumps(pieces)).volume == pieces.volume
    assert "blocks" in repr(made) and "triangles" in repr(pieces) and "brushes" in repr(made.counts) and "brushes" in repr(made.blocks[0])


# ---- files


def test_files_are_read_as_by_load(tmp_path: Path) -> None:
    model = {"array": {"of": {"box": {"min": [0, 0, 0], "max": ["=w", 1, 1]}}, "count": [8, 8, 2], "step": [2, 2, 2]}}
    (tmp_path / "a.json").write_text(json.dumps({"planecut": 1, "parameters": {"w": 1}, "model": model}))
    pc.union(bored(20, 3)).save(tmp_path / "a.csg")
    pc.union(pc.box([4 * k, 0, 0], [4 * k + 3, 8, 8]) for k in range(50)).save(tmp_path / "a.map")
    for name, parameters in (("a.json", {"w": 1.5}), ("a.csg", {}), ("a.map", {})):
        pieces = pc.blocks.plan(tmp_path / name, tmp_path / "blocks", brushes=16, **parameters).evaluate()
        assert len(pieces) > 1
        assert_same_solid(pieces, pc.load(tmp_path / name, **parameters))
    with pytest.raises(pc.PlanecutError, match="expected a model file"):
        pc.blocks.plan(tmp_path / "a.map", tmp_path / "blocks", w=1)
    with pytest.raises(pc.PlanecutError, match="parameters: found some for solids"):
        pc.blocks.plan([L_SHAPE], tmp_path / "blocks", w=1)


BRUSH = """{{
( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) stone 0 0 0 1 1
( 8 0 0 ) ( 8 0 1 ) ( 8 1 0 ) stone 0 0 0 1 1
( 0 0 0 ) ( 0 0 1 ) ( 1 0 0 ) stone 0 0 0 1 1
( 0 8 0 ) ( 1 8 0 ) ( 0 8 1 ) stone 0 0 0 1 1
( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) stone 0 0 0 1 1
{last}}}
"""


def test_errors_name_the_file_and_the_line(tmp_path: Path) -> None:
    path = tmp_path / "open.map"
    brushes = BRUSH.format(last="( 0 0 8 ) ( 0 1 8 ) ( 1 0 8 ) stone 0 0 0 1 1\n") + BRUSH.format(last="")
    path.write_text('{\n"classname" "worldspawn"\n' + brushes + "}\n")
    with pytest.raises(pc.PlanecutError, match="found a brush that reaches infinity.*allow_loss=True") as found:
        pc.blocks.plan(path, tmp_path / "plan")
    assert (found.value.path, found.value.line) == (str(path), 11)
    with pytest.raises(pc.PlanecutError):
        pc.blocks.open(tmp_path / "plan")
    with pytest.warns(UserWarning, match="open.map:11: left out 1 brushes"):
        plan = pc.blocks.plan(path, tmp_path / "plan", allow_loss=True)
    assert plan.counts.unbounded == 1 and plan.evaluate().volume == 512
    path.write_text('{\n"classname" "worldspawn"\n{\n( 0 0 0 ) ( 0 1 0 ) stone\n')
    with pytest.raises(pc.PlanecutError) as found:
        pc.blocks.plan(path, tmp_path / "plan")
    assert (found.value.path, found.value.line) == (str(path), 4)
    (tmp_path / "bad.json").write_text('{"planecut": 1, "model": {"box": {"min": [0, 0, 0]}}}')
    with pytest.raises(pc.PlanecutError) as found:
        pc.blocks.plan(tmp_path / "bad.json", tmp_path / "plan")
    assert found.value.json_path is not None
    for name in ("nosuch.json", "nosuch.map", "nosuch.csg", "a.txt"):
        with pytest.raises(pc.PlanecutError) as found:
            pc.blocks.plan(tmp_path / name, tmp_path / "plan")
        assert found.value.path == str(tmp_path / name), name
    (tmp_path / "mesh.json").mkdir()
    assert_refused(lambda: pc.blocks.plan(tmp_path / "mesh.json", tmp_path / "plan"))


def test_what_is_not_evaluated_in_blocks_is_refused(tmp_path: Path) -> None:
    box = pc.box([0, 0, 0], [1, 1, 1])
    cross = pc.from_mesh(L_SHAPE.mesh())
    cases: list[tuple[Callable[[], Any], str]] = [
        (lambda: [box, pc.halfspaces([[1, 0, 0, 1]])], "found a brush that reaches infinity, number 1"),
        (lambda: [box, ~box], "the solid is not bounded"),
        (lambda: [box, box, cross], "found a closed mesh, number 2"),
        (lambda: [box, 3], "source: found int in it, expected a file or solids"),
        (lambda: 3, "source: found int, expected a file or solids"),
        (lambda: None, "source: found NoneType, expected a file or solids"),
    ]
    for source, message in cases:
        error = raised(lambda source=source: pc.blocks.plan(source(), tmp_path))  # type: ignore[misc]
        assert type(error) is pc.PlanecutError and message in str(error), error
    L_SHAPE.save(tmp_path / "l.stl")
    with pytest.raises(pc.PlanecutError, match="l.stl: found a closed mesh"):
        pc.blocks.plan(tmp_path / "l.stl", tmp_path / "plan")
    # a mesh that is a convex body is one
    assert pc.blocks.plan([pc.from_mesh(*TETRAHEDRON)], tmp_path).evaluate().volume == pytest.approx(1 / 6)
    assert_refused(lambda: pc.blocks.plan([box], tmp_path, brushes=0))
    assert_refused(lambda: pc.blocks.plan([box], tmp_path / "l.stl"))
    assert_refused(lambda: pc.blocks.open(tmp_path / "none"))

    def broken() -> Iterator[pc.Solid]:
        yield box
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        pc.blocks.plan(broken(), tmp_path)


# ---- evaluation


def test_only_what_is_missing_or_damaged_is_made(tmp_path: Path) -> None:
    plan = pc.blocks.plan(bored(200, 5), tmp_path, brushes=40)
    plan.evaluate()
    made = pieces_of(plan)
    times = {path: path.stat().st_mtime_ns for path in (block.piece_path for block in plan.blocks)}
    gone, cut, other, changed = (block.piece_path for block in plan.blocks[:4])
    gone.unlink()
    cut.write_bytes(cut.read_bytes()[:-5])
    other.write_bytes(changed.read_bytes())
    content = bytearray(changed.read_bytes())
    content[-100] ^= 1
    changed.write_bytes(content)
    times.update((path, 0) for path in (gone, cut, other, changed))
    assert [number for number in range(len(plan.blocks)) if plan._missing(number) is not None] == [0, 1, 2, 3]
    told: list[tuple[int, int]] = []
    pc.blocks.open(tmp_path).evaluate(progress=lambda done, total: told.append((done, total)))
    assert pieces_of(plan) == made
    after = {path: path.stat().st_mtime_ns for path in times}
    assert {path for path in times if after[path] != times[path]} == {gone, cut, other, changed}
    assert told[-1] == (len(plan.blocks),) * 2
    # the same model again, and another one
    assert pieces_of(pc.blocks.plan(bored(200, 5), tmp_path, brushes=40)) == made
    assert_same_solid(pc.blocks.plan(bored(100, 5), tmp_path, brushes=40).evaluate(), pc.union(bored(100, 5)))


def test_a_block_is_evaluated_from_its_bytes_alone(tmp_path: Path) -> None:
    plan = pc.blocks.plan(bored(100, 4), tmp_path, brushes=40)
    plan.evaluate(workers=1)
    for block in plan.blocks:
        data = block.path.read_bytes()
        assert pc.blocks.evaluate_block(data) == pc.blocks.evaluate_block(data, threads=1) == block.piece_path.read_bytes()
    for bad in (b"", b"pcblock", data[:-1], data + b"x", block.piece_path.read_bytes()):
        with pytest.raises(pc.PlanecutError, match="found other bytes, expected a block of planecut"):
            pc.blocks.evaluate_block(bad)
    block.path.write_bytes(data[:-1])
    with pytest.raises(pc.PlanecutError, match="found a damaged file") as found:
        plan.evaluate()
    assert found.value.path == str(block.path)
    with pytest.raises(pc.PlanecutError, match="expected the piece of this block"):
        plan._store(0, plan.blocks[1].piece_path.read_bytes())
    assert_refused(lambda: plan._missing(len(plan.blocks)))


def test_what_engines_do_not_know_is_refused(tmp_path: Path) -> None:
    plan = pc.blocks.plan(bored(10, 2), tmp_path)
    with pytest.raises(pc.PlanecutError, match="found 'spark', expected 'local', 'ray' or 'dask'"):
        plan.evaluate(engine="spark")  # type: ignore[arg-type]
    assert_refused(lambda: plan.evaluate(workers=0))
    assert_refused(lambda: plan.evaluate(address="localhost:1"))
    assert_refused(lambda: plan.evaluate(progress=3))  # type: ignore[arg-type]
    pieces = plan.evaluate()
    assert_refused(lambda: pieces.mesh(len(pieces)))


def test_progress_counts_blocks(tmp_path: Path) -> None:
    plan = pc.blocks.plan(bored(600, 8, 16), tmp_path, brushes=40)
    told: list[tuple[int, int]] = []

    def progress(done: int, total: int) -> None:
        told.append((done, total))
        assert threading.current_thread() is threading.main_thread()

    plan.evaluate(progress=progress)
    count = len(plan.blocks)
    assert told == sorted(set(told)) and {total for _, total in told} == {count} and told[-1][0] == count and len(told) > 1

    class Enough(Exception):
        pass

    def stop(done: int, total: int) -> None:
        raise Enough

    with pytest.raises(Enough):
        plan.evaluate(progress=stop)


def test_ctrl_c_ends_it_and_it_goes_on_where_it_was(tmp_path: Path) -> None:
    plan = pc.blocks.plan(bored(2000, 12, 16), tmp_path, brushes=50)
    sent: list[float] = []

    def interrupt() -> None:
        while not any(block.piece_path.exists() for block in plan.blocks):
            time.sleep(0.01)
        sent.append(time.perf_counter())
        signal.raise_signal(signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        plan.evaluate()
        thread.join()
        time.sleep(0.5)
        pytest.fail("the work was done before it could be interrupted")
    assert time.perf_counter() - sent[0] < 1
    thread.join()
    time.sleep(1)
    there = [block.piece_path for block in plan.blocks if block.piece_path.exists()]
    assert 0 < len(there) < len(plan.blocks), "blocks that were begun are ended, and no others begin"
    time.sleep(0.5)
    assert there == [block.piece_path for block in plan.blocks if block.piece_path.exists()]
    times = {path: path.stat().st_mtime_ns for path in there}
    plan.evaluate()
    assert times == {path: path.stat().st_mtime_ns for path in there}


def test_ctrl_c_ends_the_reading_of_solids(tmp_path: Path) -> None:
    box = pc.box([0, 0, 0], [1, 1, 1])

    def endless() -> Iterator[pc.Solid]:
        while True:
            yield box

    for source in (endless, lambda: iter(lambda: box, None)):
        timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            pc.blocks.plan(source(), tmp_path)
        timer.join()


# ---- files of all pieces


def test_pieces_are_saved_as_one_closed_mesh(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    # boxes apart on a grid: nothing touches itself, whatever the precision of a format
    grid = (pc.box([x, y, z], [x + 0.75, y + 0.5, z + 0.75]) for x in range(12) for y in range(12) for z in range(3))
    bars = (pc.box([0, y, 0.25], [11.5, y + 0.25, 0.5]) for y in range(12))
    solids = [*grid, *bars]
    pieces = pc.blocks.plan(solids, tmp_path / "plan", brushes=30).evaluate()
    whole = pc.union(solids)
    for ending in ("obj", "ply", "stl", "glb", "gltf"):
        path = tmp_path / f"out.{ending}"
        pieces.save(path, scale=2.0)
        # it refuses what is not closed
        again = pc.load(path)
        assert again.volume == pytest.approx(8 * whole.volume, rel=1e-6), ending
        assert again.mesh().is_watertight and again.mesh().check() == []
    joined = trimesh.load(tmp_path / "out.ply", process=False)
    assert joined.is_watertight and len(joined.faces) == pieces.triangles and len(joined.vertices) < pieces.vertices
    pieces.save(tmp_path / "text.stl", text=True)
    assert (tmp_path / "text.stl").read_bytes().startswith(b"solid")
    for name, options in (("out.3mf", {}), ("out.png", {}), ("out", {}), ("no/out.obj", {}), ("out.obj", {"scale": 0}), ("out.obj", {"colour": 1})):
        before = set(tmp_path.iterdir())
        assert_refused(lambda name=name, options=options: pieces.save(tmp_path / name, **options))  # type: ignore[misc]
        assert set(tmp_path.iterdir()) == before


def test_pieces_are_saved_as_tiles(tmp_path: Path) -> None:
    pieces = pc.blocks.plan(bored(300, 6), tmp_path / "plan", brushes=60).evaluate()
    pieces.tiles(tmp_path / "tiles", triangles=2000, scale=0.5)
    tileset = json.loads((tmp_path / "tiles" / "tileset.json").read_text())
    assert tileset["asset"]["version"] == "1.1"
    leaves: list[dict[str, Any]] = []

    def walk(tile: dict[str, Any]) -> None:
        if "children" not in tile:
            leaves.append(tile)
        assert (tmp_path / "tiles" / tile["content"]["uri"]).is_file()
        for child in tile.get("children", []):
            assert child["geometricError"] <= tile["geometricError"]
            walk(child)

    walk(tileset["root"])
    assert len(leaves) == sum(len(mesh.triangles) > 0 for mesh in pieces) and all(leaf["geometricError"] == 0 for leaf in leaves)
    # its own is replaced, what others made is not
    pieces.tiles(tmp_path / "tiles")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    with pytest.raises(pc.PlanecutError, match="which is no tile set of planecut"):
        pieces.tiles(tmp_path / "mine")
    assert_refused(lambda: pieces.tiles(tmp_path / "other", colour=1))
    with pytest.raises(pc.PlanecutError, match="found no triangle"):
        pc.blocks.plan([], tmp_path / "none").evaluate().tiles(tmp_path / "other")
    assert not (tmp_path / "other").exists()


# ---- engines

SIZE = (2500, 14.0, 16)
"""Many blocks, of some tens of milliseconds each."""


@pytest.fixture(scope="module")
def local(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The pieces that one thread makes."""
    plan = pc.blocks.plan(bored(*SIZE), tmp_path_factory.mktemp("local"), brushes=50)
    plan.evaluate(workers=1)
    return pieces_of(plan)


def test_two_threads_give_the_same(tmp_path: Path, local: dict[str, bytes]) -> None:
    plan = pc.blocks.plan(bored(*SIZE), tmp_path, brushes=50)
    assert len(local) > 50
    plan.evaluate(workers=2)
    assert pieces_of(plan) == local


@needs_dask
def test_dask_gives_the_same_though_a_worker_is_killed(tmp_path: Path, local: dict[str, bytes]) -> None:
    import distributed

    plan = pc.blocks.plan(bored(*SIZE), tmp_path, brushes=50)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        told: list[tuple[int, int]] = []
        killer = Killer(lambda: len(told) >= len(local) // 3, lambda: next(iter(client.run(os.getpid).values())))
        pieces = plan.evaluate("dask", progress=lambda done, total: told.append((done, total)))
        killer.assert_killed()
        assert told == [(done, len(local)) for done in range(1, len(local) + 1)]
        assert len(pieces) == len(local) and pieces_of(plan) == local
        # started again, only what is missing is done; a task that fails raises what it raised
        plan.blocks[3].piece_path.unlink()
        plan.evaluate("dask", workers=1, address=cluster.scheduler_address)
        assert pieces_of(plan) == local
        assert_errors_come_back(plan, "dask")


@needs_ray
def test_ray_gives_the_same_though_a_worker_is_killed(tmp_path: Path, local: dict[str, bytes]) -> None:
    import ray

    plan = pc.blocks.plan(bored(*SIZE), tmp_path, brushes=50)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        told: list[tuple[int, int]] = []
        killer = Killer(lambda: len(told) >= len(local) // 3, lambda: ray_worker("evaluate_one"))
        pieces = plan.evaluate("ray", progress=lambda done, total: told.append((done, total)))
        killer.assert_killed()
        assert told == [(done, len(local)) for done in range(1, len(local) + 1)]
        assert len(pieces) == len(local) and pieces_of(plan) == local
        plan.blocks[3].piece_path.unlink()
        plan.evaluate("ray", workers=1)
        assert pieces_of(plan) == local
        assert_errors_come_back(plan, "ray")
    finally:
        ray.shutdown()


def assert_errors_come_back(plan: pc.blocks.Plan, engine: Any) -> None:
    """A block that is damaged is the package's exception, whichever process finds it."""
    block = plan.blocks[5]
    block.path.write_bytes(block.path.read_bytes()[:-1])
    with pytest.raises(pc.PlanecutError, match="found other bytes, expected a block of planecut") as found:
        plan.evaluate(engine)
    assert type(found.value) is pc.PlanecutError


class Task:
    """A block that is evaluated when its piece is asked for."""

    def __init__(self, block: bytes) -> None:
        self.block = block


class Counted:
    """An engine in this process that counts the tasks that it has at a time."""

    def __init__(self) -> None:
        self.most = 0
        self.cancelled: list[Task] = []

    def cores(self) -> int:
        return 3

    def begin(self, block: bytes) -> Task:
        return Task(block)

    def wait(self, tasks: list[Task]) -> list[Task]:
        self.most = max(self.most, len(tasks))
        return tasks[:1]

    def piece(self, task: Task) -> bytes:
        return pc.blocks.evaluate_block(task.block)

    def cancel(self, tasks: list[Task]) -> None:
        self.cancelled += tasks


def test_few_tasks_are_under_way_at_a_time(tmp_path: Path) -> None:
    from planecut.blocks._engines import _carry_out

    plan = pc.blocks.plan(bored(200, 6), tmp_path, brushes=20)
    engine = Counted()
    _carry_out(plan, engine, None, None)
    assert engine.most == 6 and engine.cancelled == []
    made = pieces_of(plan)
    for path in (block.piece_path for block in plan.blocks):
        path.unlink()

    def stop(done: int, total: int) -> None:
        if done == 4:
            raise KeyboardInterrupt

    engine = Counted()
    with pytest.raises(KeyboardInterrupt):
        _carry_out(plan, engine, 2, stop)
    assert engine.most == 2 and len(engine.cancelled) == 1
    assert sum(block.piece_path.exists() for block in plan.blocks) == 4
    plan.evaluate()
    assert pieces_of(plan) == made
