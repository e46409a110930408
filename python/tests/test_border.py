"""What does not belong, and what would run for ever: refused in one line by an ordinary exception; no process ends."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import planecut as pc
import pytest
from oracles import assert_refused, box_points, raised

NAN, INF = float("nan"), float("inf")
HERE = Path(__file__).parent
BOX = pc.box([0, 0, 0], [1, 1, 1])
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
PLANES = np.array([[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]], dtype=float)


def doubled(levels: int) -> pc.Solid:
    """A solid of 2^levels boxes, made of few objects that share their parts."""
    solid = BOX
    for level in range(levels):
        solid = solid | solid.translate([2.0**level * 2, 0, 0])
    return solid


@pytest.mark.parametrize(
    "keywords",
    [
        {"material": "a", "materials": ["a"], "material_ids": [0, 0, 0, 0]},
        {"materials": ["a"]},
        {"material_ids": [0, 0, 0, 0]},
        {"materials": ["a"], "material_ids": [0, 0, 0]},
        {"materials": ["a"], "material_ids": [0, 0, 0, 1]},
        {"materials": ["a"], "material_ids": [0, 0, 0, -1]},
        {"materials": "a", "material_ids": [0, 0, 0, 0]},
        {"materials": [1], "material_ids": [0, 0, 0, 0]},
        {"material": 3},
    ],
    ids=repr,
)
def test_materials_that_do_not_fit_are_refused(keywords):
    assert_refused(lambda: pc.from_mesh(TETRAHEDRON, FACES, **keywords))
    assert_refused(lambda: pc.Mesh(TETRAHEDRON, FACES, **keywords))


@pytest.mark.parametrize(
    "work",
    [
        lambda: pc.from_mesh(TETRAHEDRON, FACES, winding="left"),
        lambda: pc.from_mesh(TETRAHEDRON, FACES, close=NAN),
        lambda: pc.from_mesh(TETRAHEDRON, FACES, close=-1),
        lambda: pc.from_mesh(TETRAHEDRON, FACES, merge_from_vert=[0, 1], merge_to_vert=[0]),
        lambda: pc.from_mesh(TETRAHEDRON, FACES, merge_from_vert=[9], merge_to_vert=[0]),
        lambda: pc.from_mesh(TETRAHEDRON),
        lambda: pc.from_mesh(None),
        lambda: pc.Mesh(TETRAHEDRON, FACES).check(NAN),
        lambda: pc.Mesh(TETRAHEDRON, FACES).check(-1),
        lambda: BOX.mesh(threads=0),
        lambda: BOX.mesh(threads=-1),
        lambda: BOX.mesh(threads=10**9),
        lambda: BOX.mesh(threads=1.5),
        lambda: BOX.mesh(progress=3),
        lambda: BOX.mesh(3),
        lambda: BOX.render((0, 10)),
        lambda: BOX.render((10**6, 10**6)),
        lambda: BOX.render((-1, 10)),
        lambda: BOX.render("ab"),
        lambda: BOX.render(style="pretty"),
        lambda: BOX.render(camera=None),
        lambda: BOX.render(azimuth=NAN),
        lambda: BOX.rotate("w", 3),
        lambda: BOX.rotate("x", INF),
        lambda: BOX.rotate("x", None),
        lambda: BOX | 3,
        lambda: 3 - BOX,
        lambda: BOX & None,
        lambda: BOX ^ np.zeros(3),
        lambda: BOX + BOX,
        lambda: pc.union(3),
        lambda: pc.union([3]),
        lambda: pc.union("abc"),
        lambda: pc.union(BOX),
        lambda: pc.difference(BOX, BOX),
        lambda: pc.difference([BOX], BOX),
        lambda: pc.Solid(),
        lambda: pc.Edit(),
        lambda: pc.Live(3),
        lambda: pc.Mesh(),
        lambda: pc.coarsen(3),
        lambda: pc.coarsen("abc"),
        lambda: pc.coarsen([BOX]),
        lambda: pc.coarsen(BOX, max_cells=0),
        lambda: pc.coarsen(BOX, max_cells=-1),
        lambda: pc.coarsen(BOX, max_excess=NAN),
        lambda: pc.coarsen(BOX, max_excess=-1),
        lambda: pc.coarsen(BOX, max_vertices=3),
        lambda: pc.coarsen(BOX, max_faces=1),
        lambda: pc.coarsen(BOX, clear_radius=-1),
        lambda: pc.coarsen(BOX, max_gap=NAN),
        lambda: pc.coarsen(BOX, min_thickness=-1),
        lambda: pc.coarsen(BOX, overlap_weight=INF),
        lambda: pc.coarsen(BOX, engine="quake"),
        lambda: pc.coarsen(BOX, surface="soft"),
        lambda: pc.coarsen(BOX, keep_clear=3),
        lambda: pc.extrude([[0, 0], [1, 0], [1, 1]], 1, twist=1e300),
        lambda: pc.extrude([[0, 0], [1, 0], [1, 1]], 1, scale="a"),
        lambda: pc.extrude([[0, 0], [1, 0], [1, 1]], 1, scale=NAN),
        lambda: pc.extrude([[0, 0], [1, 0], [1, 1]], 1, scale=-1),
        lambda: pc.extrude([[0, 0], [1, 1]], 1),
        lambda: pc.revolve([[-1, 0], [1, 0], [1, 1]]),
        lambda: pc.revolve([[0, 0], [1, 0], [1, 1]], angle=0),
        lambda: pc.revolve([[0, 0], [1, 0], [1, 1]], angle=361),
        lambda: pc.load(3),
        lambda: pc.load(None),
        lambda: pc.load(""),
        lambda: pc.load("a\0b.json"),
        lambda: pc.load("/nonexistent/x.json"),
        lambda: pc.load("x.exe"),
        lambda: pc.load("x.obj", width=3),
        lambda: pc.load("x.json", width="a"),
        lambda: BOX.save("/nonexistent/x.obj"),
        lambda: BOX.save("x.exe"),
        lambda: BOX.save("x.obj", nothing=1),
        lambda: BOX.save("x.obj", scale=NAN),
        lambda: BOX.save("x.obj", scale=object()),
        lambda: BOX.save("x.map", text=True),
        lambda: pc.Polytope().remove_plane(0),
        lambda: pc.Polytope().remove_plane(-1),
        lambda: pc.Polytope().remove_plane(10**30),
        lambda: pc.Polytope().move_plane(0, 1.0),
        lambda: pc.Polytope(PLANES).move_plane(0, NAN),
        lambda: pc.Polytope(PLANES).face_area(6),
        lambda: pc.Solid._unpickle(b""),
        lambda: pc.Solid._unpickle(b"abcdef"),
        lambda: pc.Mesh._unpickle(b"x"),
        lambda: pc.Polytope._unpickle(b"x"),
        lambda: pc.trimesh_engine([], "union"),
        lambda: pc.compat.run_coacd([], []),
    ],
)
def test_arguments_that_are_none_are_refused(work, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert_refused(work)
    assert list(tmp_path.iterdir()) == []


UNBOUNDED = ~BOX


@pytest.mark.parametrize(
    "ask",
    [
        lambda s: s.volume,
        lambda s: s.area,
        lambda s: s.centroid,
        lambda s: s.bounds,
        lambda s: s.mesh(),
        lambda s: s.cells(),
        lambda s: s.render(),
        lambda s: s.ray_cast([[0, 0, 0]], [[1, 0, 0]]),
        lambda s: s.save("x.obj"),
        lambda s: s.save("x.map"),
        pc.Live,
        pc.coarsen,
    ],
)
def test_an_unbounded_solid_has_no_boundary_to_ask_for(ask):
    for solid in (UNBOUNDED, pc.halfspaces([[1, 0, 0, 0]]), pc.halfspaces([])):
        if solid is UNBOUNDED or ask is not pc.Live:
            assert_refused(lambda solid=solid: ask(solid), pc.PlanecutError)


def test_an_unbounded_solid_contains_points_and_is_not_empty():
    assert not UNBOUNDED.is_empty
    np.testing.assert_array_equal(UNBOUNDED.contains([[0.5, 0.5, 0.5], [2, 2, 2]]), [False, True])
    assert pc.halfspaces([[1, 0, 0, 0]]).contains([[-1e20, 5, 5]]).all()


@pytest.mark.parametrize(
    "mistake",
    [
        lambda e: e.move_plane(0, 99, 1.0),
        lambda e: e.move_plane(9, 0, 1.0),
        lambda e: e.move_plane(-1, 0, 1.0),
        lambda e: e.move_plane(0, 0, NAN),
        lambda e: e.move_plane(0, 0, "a"),
        lambda e: e.add_plane(0, [0, 0, 0, 1]),
        lambda e: e.add_plane(0, [1, 0, 0]),
        lambda e: e.add_plane(5, [1, 0, 0, 0.5]),
        lambda e: e.remove_plane(0, 0),
        lambda e: e.remove_plane(0, 42),
        lambda e: e.add_brush(3),
        lambda e: e.add_brush(BOX, role="paint"),
        lambda e: e.add_brush(BOX | BOX.translate([5, 0, 0])),
        lambda e: e.add_brush(~BOX),
        lambda e: e.add_brush(pc.halfspaces([[1, 0, 0, 0]])),
        lambda e: e.remove_brush(3),
        lambda e: e.replace_brush(3, BOX),
        lambda e: e.transform_brush(0, np.zeros((4, 4))),
        lambda e: e.transform_brush(0, np.eye(3)),
        lambda e: e.transform_brush(0, np.diag([1e200, 1, 1, 1])),
        lambda e: e.set_role(0, "paint"),
        lambda e: e.set_role(7, "add"),
        lambda e: e.turn_plane(0, 0, [0, 0, 0, 1]),
        lambda e: e.turn_plane(0, 9, [1, 0, 0, 1]),
        lambda e: e.set_material(7, "steel"),
        lambda e: e.set_material(0, "steel", 9),
        lambda e: e.rename_brush(7, "lid"),
        lambda e: e.copy_brushes([7], np.eye(4)),
        lambda e: e.copy_brushes([0, 0], np.eye(4)),
        lambda e: e.mirror_brushes([0], [0, 0, 0, 1]),
        lambda e: e.array_brushes([0], np.eye(4), 10**7),
        lambda e: e.__enter__(),
    ],
)
def test_edits_that_are_none_are_refused_and_change_nothing(mistake):
    live = pc.Live(BOX)
    faces, mesh = live.faces.tolist(), live.mesh().vertices.tobytes()

    def edit():
        with live.edit() as e:
            e.move_plane(0, 0, 3.0)
            mistake(e)

    assert_refused(edit)
    assert live.volume == 1.0 and live.mesh().vertices.tobytes() == mesh
    assert len(live.faces) == len(faces)
    assert_refused(live.undo, pc.PlanecutError)
    assert_refused(live.redo, pc.PlanecutError)


# ---- what would run for ever, or end the process


@pytest.mark.parametrize(
    "ask",
    [
        lambda s: s.volume,
        lambda s: s.is_empty,
        lambda s: s.cells(),
        lambda s: s.contains([[0, 0, 0]]),
        lambda s: s.ray_cast([[0, 0, 0]], [[1, 0, 0]]),
        lambda s: s.__reduce__(),
        lambda s: pc.coarsen(s, 2),
        lambda s: pc.coarsen(BOX, 1, keep_clear=s),
        pc.Live,
    ],
)
def test_parts_that_are_shared_too_often_are_counted_and_refused(ask):
    solid = doubled(60)
    assert str(2**60) in repr(solid)
    assert_refused(lambda: ask(solid), pc.PlanecutError)
    for _ in range(100):
        solid = solid | solid
    assert_refused(lambda: ask(solid), pc.PlanecutError)


def test_parts_that_are_shared_are_each_counted():
    assert doubled(6).volume == 2.0**6


def run_apart(code, seconds=60):
    """Runs code in a process of its own, and gives what it prints; the process must end by itself with status 0."""
    done = subprocess.run([sys.executable, "-c", "import planecut as pc\n" + code], capture_output=True, text=True, timeout=seconds, cwd=HERE)
    assert done.returncode == 0, (done.returncode, done.stderr[-2000:])
    return done.stdout.strip()


def test_chains_of_200000_operations_are_made_and_freed():
    code = """
b = pc.box([0, 0, 0], [1, 1, 1])
for step in (
    lambda s: s.translate([1e-3, 0, 0]),
    lambda s: s.with_material("a"),
    lambda s: ~s,
    lambda s: s | b,
    lambda s: s - b.translate([5, 5, 5]),
    lambda s: (s | b) & b,
    lambda s: ~s.translate([1, 0, 0]),
    lambda s: pc.union([s]),
):
    s = b
    for _ in range(200_000): s = step(s)
    t = s
    del s, t
print("done")
"""
    assert run_apart(code) == "done"


def test_long_chains_are_evaluated():
    code = """
import pickle
b = pc.box([0, 0, 0], [1, 1, 1])
s = b
for _ in range(200_000): s = ~s.translate([0.0, 0, 0])
print(s.volume, s.contains([[0.5, 0.5, 0.5]])[0], pickle.loads(pickle.dumps(s)).volume, pc.Live(s).volume)
s = b
for _ in range(1_500): s = (s - b.translate([3, 0, 0])) | b
print(s.volume, s.contains([[0.5, 0.5, 0.5]])[0], pickle.loads(pickle.dumps(s)).volume)
"""
    assert run_apart(code).splitlines() == ["1.0 True 1.0 1.0", "1.0 True 1.0"]


def test_deep_lists_and_lists_of_themselves_are_refused():
    code = """
deep = [0, 0, 0]
for _ in range(100_000): deep = [deep]
ring = []
ring.append(ring)
for value in (deep, ring):
    for work in (lambda: pc.hull(value), lambda: pc.box(value, [1, 1, 1]), lambda: pc.extrude(value, 1), lambda: pc.coarsen(value)):
        try: work()
        except (pc.PlanecutError, RecursionError) as error: print(type(error).__name__, str(error).count(chr(10)))
"""
    assert set(run_apart(code).splitlines()) == {"PlanecutError 0"}


def test_sequences_that_lie_about_their_length_are_refused():
    class Liar(list):
        def __len__(self):
            return 10**6

    outline = np.array([[0, 0], [1, 0], [0, 1]])
    assert pc.extrude([outline], 1).volume == 0.5
    assert_refused(lambda: pc.extrude(Liar([outline]), 1), IndexError)
    assert_refused(lambda: pc.coarsen(Liar([TETRAHEDRON])), IndexError)


def test_far_coordinates_are_taken_or_refused():
    for exponent in range(0, 300, 10):
        size = 10.0**exponent
        try:
            solid = pc.box([-size] * 3, [size] * 3)
            assert solid.volume == pytest.approx((2 * size) ** 3, rel=1e-12)
        except pc.PlanecutError as error:
            assert exponent > 20 and "\n" not in str(error)
    corners = box_points([0, 0, 0], [1e-20] * 3)
    assert pc.hull(corners).volume == pytest.approx(1e-60, rel=1e-9)


@pytest.mark.parametrize("work", [lambda: pc.from_trimesh(3), lambda: pc.from_trimesh(None), lambda: pc.compat.run_coacd(None)])
def test_objects_that_are_no_meshes_are_refused(work):
    assert_refused(work)


@pytest.mark.parametrize("keywords", [{"nothing": 1}, {"scale": NAN}, {"scale": "a"}], ids=repr)
def test_options_that_are_none_are_refused_by_their_names(keywords):
    error = raised(lambda: BOX.save("x.obj", **keywords))
    assert next(iter(keywords)) in str(error) and "column" not in str(error)


def test_a_generator_that_raises_lets_its_error_through():
    def solids():
        yield BOX
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        pc.union(solids())
    assert pc.union(BOX.translate([2 * k, 0, 0]) for k in range(3)).volume == 3.0
