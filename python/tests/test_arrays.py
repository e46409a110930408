"""Arrays that come in: taken for what they are, whatever their layout, or refused in one line by an ordinary exception."""

from __future__ import annotations

import numpy as np
import planecut as pc
import pytest
from oracles import assert_refused, generator, raised

NAN, INF = float("nan"), float("inf")
BOX = pc.box([0, 0, 0], [1, 1, 1])
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
PLANES = np.array([[1, 0, 0, 1], [-1, 0, 0, 1], [0, 1, 0, 1], [0, -1, 0, 1], [0, 0, 1, 1], [0, 0, -1, 1]], dtype=float)


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


@pytest.mark.parametrize("name", variants(TETRAHEDRON))
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


@pytest.mark.parametrize("taker", TAKES_POINTS)
@pytest.mark.parametrize("name", BAD_POINTS)
def test_points_that_are_none_are_refused(taker, name):
    if (taker, name) == ("hull", "solid"):
        assert pc.hull(BOX).volume == 1.0
        return
    if name == "long double beyond double" and np.finfo(np.longdouble).max == np.finfo(float).max:
        pytest.skip("no wider type on this machine")
    value = BAD_POINTS[name]
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


def test_what_is_masked_is_refused():
    assert_refused(lambda: BOX.contains(np.ma.masked_array([[0.0, 0, 0]], mask=[[1, 0, 0]])))
