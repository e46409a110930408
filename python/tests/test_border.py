"""What does not belong: every input is taken for what it is, or refused in one line by an ordinary exception."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import planecut as pc
import pytest
from oracles import box_points, generator, raised

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


def assert_refused(work, *kinds):
    """Work raises one of the ordinary exceptions, with a message of one line."""
    error = raised(work)
    assert type(error) in (kinds or (pc.PlanecutError, TypeError, OverflowError)), repr(error)
    message = str(error)
    assert message.strip() and "\n" not in message, repr(message)
    assert "panic" not in message.lower() and ".rs" not in message


class Duck:
    """What has an array, and is none."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.array, dtype=dtype)


class Broken:
    def __array__(self, dtype=None, copy=None):
        raise RuntimeError("no array today")


# ---- what is taken


def variants(array):
    """The same numbers in arrays of other layouts and types, by name."""
    array = np.asarray(array)
    wide = np.zeros((2 * len(array), 2 * array.shape[1]), array.dtype)
    wide[::2, ::2] = array
    frozen = array.copy()
    frozen.flags.writeable = False
    bytes_before = np.zeros(array.nbytes + 1, np.uint8)
    crooked = bytes_before[1:].view(array.dtype).reshape(array.shape)
    crooked[...] = array
    return {
        "sliced": wide[::2, ::2],
        "reversed": array[::-1][::-1],
        "transposed": np.ascontiguousarray(array.T).T,
        "Fortran": np.asfortranarray(array),
        "big-endian": array.astype(array.dtype.newbyteorder(">")),
        "not aligned": crooked,
        "read-only": frozen,
        "broadcast": np.broadcast_to(array, array.shape),
        "masked, nothing hidden": np.ma.masked_array(array),
        "matrix subclass": array.view(type("Sub", (np.ndarray,), {})),
        "list": array.tolist(),
        "tuples": tuple(map(tuple, array.tolist())),
        "list of arrays": list(array),
        "memoryview": memoryview(np.ascontiguousarray(array)),
        "duck": Duck(array),
    }


NOT_ALIGNED = pytest.param("not aligned", marks=pytest.mark.xfail(strict=True, reason="defect 7: arrays that are not aligned are refused"))


@pytest.mark.parametrize("name", [NOT_ALIGNED if name == "not aligned" else name for name in variants(TETRAHEDRON)])
def test_layouts_do_not_change_what_numbers_mean(name):
    points = generator().normal(size=(40, 3))
    other = variants(points)[name]
    np.testing.assert_array_equal(BOX.contains(other), BOX.contains(points))
    assert pc.hull(other).volume == pc.hull(points).volume
    assert pc.from_mesh(variants(TETRAHEDRON)[name], variants(FACES)[name]).volume == pc.hull(TETRAHEDRON).volume
    assert pc.halfspaces(variants(PLANES)[name]).volume == pc.Polytope(PLANES).volume
    matrix = np.hstack([np.diag([1.0, 2.0, 3.0]), [[1.0], [2.0], [3.0]]])
    np.testing.assert_array_equal(BOX.transform(variants(matrix)[name]).bounds, [matrix[:, 3], matrix[:, 3] + np.diag(matrix)])


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "g", ">f4", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">i8"])
def test_numbers_of_all_types_are_taken(dtype):
    points = np.array([[0, 0, 0], [8, 0, 0], [0, 4, 0], [0, 0, 2]]).astype(dtype)
    assert pc.hull(points).volume == pytest.approx(8 * 4 * 2 / 6)
    assert pc.box(points[0], points[1] + points[2] + points[3]).volume == 8 * 4 * 2
    if np.dtype(dtype).kind in "iu":
        assert pc.from_mesh(points, FACES.astype(dtype)).volume == pytest.approx(8 * 4 * 2 / 6)
    else:
        assert_refused(lambda: pc.from_mesh(points, FACES.astype(dtype)), pc.PlanecutError)


@pytest.mark.parametrize("empty", [[], (), np.zeros((0, 3)), np.zeros((0, 3), np.float32), np.zeros(0), np.zeros((0, 3), int)], ids=repr)
def test_empty_arrays_have_no_rows(empty):
    assert BOX.contains(empty).shape == (0,)
    assert BOX.ray_cast(empty, empty).shape == BOX.ray_cast(empty, [[1, 0, 0]]).shape == (0,)
    assert pc.Polytope(PLANES).contains(empty).shape == (0,)
    assert pc.from_mesh(empty, []).is_empty and pc.Mesh(empty, []).check() == []
    assert_refused(lambda: pc.hull(empty), pc.PlanecutError)


def test_nothing_is_a_solid_too():
    empty = pc.union([])
    assert empty.volume == 0.0 and (empty | BOX).volume == 1.0 and (BOX - empty).volume == 1.0 and (BOX & empty).is_empty
    assert pc.Live(empty).volume == 0.0
    assert pc.difference(BOX, []).volume == 1.0
    assert not pc.halfspaces([]).is_empty and (pc.halfspaces([]) & BOX).volume == 1.0
    assert_refused(lambda: pc.intersection([]), pc.PlanecutError)
    assert_refused(lambda: pc.coarsen(empty), pc.PlanecutError)
    assert_refused(lambda: pc.coarsen([]), pc.PlanecutError)


def test_numpy_numbers_are_numbers():
    assert pc.cylinder(np.float32(2), np.float64(1), None, np.int8(4)).volume == pytest.approx(4.0)
    assert BOX.scale(np.float32(2)).volume == 8.0 and BOX.scale(np.int64(2)).volume == 8.0
    assert len(pc.coarsen(BOX, max_cells=np.uint16(1), max_excess=np.float32(0)).cells) == 1
    live = pc.Live(BOX)
    assert live.role(live.brushes[0]) == "add" and live.face(live.faces[0]).brush == live.brushes[0]


# ---- what is refused

BAD_POINTS = {
    "NaN": [[0, 0, NAN]],
    "inf": [[0, INF, 0]],
    "-inf": [[0, -INF, 0]],
    "two columns": [[0, 0]],
    "four columns": [[0, 0, 0, 0]],
    "one point by itself": [0, 0, 0],
    "three dimensions": np.zeros((1, 3, 1)),
    "empty with two columns": np.zeros((0, 2)),
    "ragged": [[0, 0, 0], [0, 0]],
    "None": None,
    "None within": [[None, 0, 0]],
    "number": 3.0,
    "text": "abc",
    "texts": [["a", "b", "c"]],
    "bytes": b"abc",
    "complex": [[1j, 0, 0]],
    "bool": [[True, False, True]],
    "object": np.array([[0, 0, 0]], object),
    "times": np.zeros((1, 3), "datetime64[s]"),
    "records": np.zeros(3, [("x", float)]),
    "huge whole number": [[10**30, 0, 0]],
    "more than 2^53": np.array([[2**53 + 2, 0, 0]]),
    "more than 2^53, unsigned": np.array([[2**64 - 1, 0, 0]], np.uint64),
    "long double beyond double": np.array([["1e4000", 0, 0]], np.longdouble),
    "dict": {"x": 1},
    "set": {1, 2, 3},
    "function": len,
    "class": int,
    "broken duck": Broken(),
    "solid": BOX,
}
TAKES_POINTS = {
    "contains": BOX.contains,
    "origins": lambda value: BOX.ray_cast(value, [[1, 0, 0]]),
    "directions": lambda value: BOX.ray_cast([[0, 0, 0]], value),
    "Polytope.contains": pc.Polytope(PLANES).contains,
    "hull": pc.hull,
    "Mesh": lambda value: pc.Mesh(value, np.zeros((0, 3), int)),
    "coarsen": lambda value: pc.coarsen([value]),
}


@pytest.mark.filterwarnings("error:overflow:RuntimeWarning")
@pytest.mark.parametrize("taker", TAKES_POINTS)
@pytest.mark.parametrize("name", BAD_POINTS)
def test_points_that_are_none_are_refused(taker, name):
    if name == "long double beyond double" and np.finfo(np.longdouble).max == np.finfo(float).max:
        pytest.skip("no wider type on this machine")
    value = BAD_POINTS[name]
    if taker == "coarsen" and name == "solid":
        pytest.skip("is told by test_sequences")
    if name == "long double beyond double":
        with np.errstate(over="ignore"):
            assert_refused(lambda: TAKES_POINTS[taker](value))
    else:
        assert_refused(lambda: TAKES_POINTS[taker](value))


TAKES_ROW = {
    "box.min": lambda value: pc.box(value, [9, 9, 9]),
    "box.max": lambda value: pc.box([-9, -9, -9], value),
    "translate": BOX.translate,
    "rotate": lambda value: BOX.rotate(value, 30),
    "scale": BOX.scale,
    "mirror": BOX.mirror,
    "transform": BOX.transform,
    "add_plane": pc.Polytope().add_plane,
    "halfspaces": pc.halfspaces,
    "Polytope": pc.Polytope,
    "pick origin": lambda value: pc.Live(BOX).pick(value, [1, 0, 0]),
    "pick direction": lambda value: pc.Live(BOX).pick([0, 0, 0], value),
    "extrude": lambda value: pc.extrude(value, 1),
    "revolve": pc.revolve,
}
BAD_ROWS = {
    "NaN": [NAN, 0, 0],
    "inf": [0, INF, 0],
    "two": [1, 2],
    "five": [1, 2, 3, 4, 5],
    "one row": [[[1, 2, 3]]],
    "text": "w",
    "None within": [None, 0, 0],
    "complex": [1j, 0, 0],
    "bool": [True, False, True],
    "object": np.array([1, 2, 3], object),
    "huge": [10**30, 0, 0],
    "dict": {},
    "broken duck": Broken(),
    "solid": BOX,
}


@pytest.mark.parametrize("taker", TAKES_ROW)
@pytest.mark.parametrize("name", BAD_ROWS)
def test_vectors_planes_and_matrices_that_are_none_are_refused(taker, name):
    assert_refused(lambda: TAKES_ROW[taker](BAD_ROWS[name]))


@pytest.mark.parametrize(
    "work",
    [
        lambda: pc.halfspaces([[0, 0, 0, 1]]),
        lambda: pc.Polytope([[0, 0, 0, 1]]),
        lambda: pc.Polytope().add_plane([0, 0, 0, -1]),
        lambda: BOX.mirror([0, 0, 0]),
        lambda: BOX.rotate([0, 0, 0], 10),
        lambda: BOX.ray_cast([[0, 0, 0]], [[0, 0, 0]]),
        lambda: pc.Live(BOX).pick([0, 0, 0], [0, 0, 0]),
        lambda: BOX.scale(0),
        lambda: BOX.scale([1, 0, 1]),
        lambda: BOX.transform(np.zeros((3, 4))),
        lambda: BOX.transform(np.ones((4, 4))),
        lambda: BOX.transform(np.eye(4)[:, :3]),
        lambda: pc.hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]),
        lambda: pc.hull(np.zeros((9, 3))),
        lambda: pc.box([0, 0, 0], [1, 0, 1]),
        lambda: pc.box([0, 0, 0], [1, -1, 1]),
    ],
)
def test_what_is_flat_or_zero_is_refused(work):
    assert_refused(work, pc.PlanecutError)


@pytest.mark.parametrize("value", [NAN, INF, -INF, 0.0, -1.0, 1e300, 1e-300, 10**400, None, "1", [1], 1j], ids=repr)
def test_sizes_that_are_none_are_refused(value):
    assert_refused(lambda: pc.sphere(value))
    assert_refused(lambda: pc.cylinder(value, 1))
    assert_refused(lambda: pc.torus(value, 0.5))
    assert_refused(lambda: pc.extrude([[0, 0], [1, 0], [0, 1]], value))
    if value not in (0.0, None):  # a cone may end in a point
        assert_refused(lambda: pc.cylinder(1, 1, value))


@pytest.mark.parametrize("value", [10**9, 10**12, 10**40, -1, 0, 2, 2.5, NAN, None, "3", [3]], ids=repr)
def test_numbers_of_segments_that_are_none_are_refused(value):
    for work in (
        lambda: pc.sphere(1, value),
        lambda: pc.cylinder(1, 1, None, value),
        lambda: pc.torus(2, 1, value),
        lambda: pc.torus(2, 1, 8, value),
        lambda: pc.revolve([[0, 0], [1, 0], [1, 1]], value),
    ):
        assert_refused(work)
    if value not in (2, None):
        assert_refused(lambda: pc.extrude([[0, 0], [1, 0], [1, 1]], 1, slices=value))


BAD_TRIANGLES = {
    "below 0": [[0, 1, -1]],
    "too large": [[0, 1, 4]],
    "far too large": np.array([[0, 1, 2**63]], np.uint64),
    "wraps to 0 in 32 bits": np.array([[2**32, 1, 2]], np.int64),
    "huge": [[0, 1, 10**30]],
    "floats": [[0.0, 1.0, 2.0]],
    "bool": [[True, False, True]],
    "quads": [[0, 1, 2, 3]],
    "one by itself": [0, 1, 2],
    "text": "abc",
    "ragged": [[0, 1, 2], [0, 1]],
    "None within": [[0, 1, None]],
    "object": np.array([[0, 1, 2]], object),
}


@pytest.mark.parametrize("name", BAD_TRIANGLES)
def test_triangles_that_are_none_are_refused(name):
    value = BAD_TRIANGLES[name]
    assert_refused(lambda: pc.Mesh(TETRAHEDRON, value), pc.PlanecutError)
    assert_refused(lambda: pc.from_mesh(TETRAHEDRON, value), pc.PlanecutError)
    assert_refused(lambda: pc.coarsen([(TETRAHEDRON, value)]), pc.PlanecutError)


def test_an_open_mesh_is_refused_and_the_place_is_said():
    error = raised(lambda: pc.from_mesh(TETRAHEDRON + 7, FACES[:3]))
    assert isinstance(error, pc.PlanecutError) and isinstance(error, ValueError)
    assert "3 open edges" in str(error) and "7" in str(error)


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


@pytest.mark.parametrize(
    "step",
    ["s.translate([1e-3, 0, 0])", "s.with_material('a')", "~s", "s | b", "s - b.translate([5, 5, 5])", "(s | b) & b", "~(s.translate([1, 0, 0]))", "pc.union([s])"],
)
def test_chains_of_200000_operations_are_made_and_freed(step):
    code = f"b = pc.box([0, 0, 0], [1, 1, 1])\ns = b\nfor _ in range(200_000): s = {step}\nt = s\ndel s, t\nprint('done')"
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


@pytest.mark.xfail(strict=True, reason="defect 3: the mask is dropped")
def test_what_is_masked_is_refused():
    assert_refused(lambda: BOX.contains(np.ma.masked_array([[0.0, 0, 0]], mask=[[1, 0, 0]])))


@pytest.mark.xfail(strict=True, reason="defect 2: AttributeError")
@pytest.mark.parametrize("work", [lambda: pc.from_trimesh(3), lambda: pc.from_trimesh(None), lambda: pc.compat.run_coacd(None)])
def test_objects_that_are_no_meshes_are_refused(work):
    assert_refused(work)


@pytest.mark.xfail(strict=True, reason="defect 4: the message is that of a reader of JSON")
@pytest.mark.parametrize("keywords", [{"scale": NAN}, {"nothing": 1}, {"scale": "a"}], ids=repr)
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
