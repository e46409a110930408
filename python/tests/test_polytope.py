"""The kernel: polytopes against fresh ones and against fractions."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np
import planecut as pc
import pytest
from oracles import generator, mesh_volume

CUBE = [[1, 0, 0, 4], [-1, 0, 0, 4], [0, 1, 0, 4], [0, -1, 0, 4], [0, 0, 1, 4], [0, 0, -1, 4]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rank(vectors) -> int:
    """The rank of vectors of fractions, by elimination."""
    rows, found = [list(map(Fraction, vector)) for vector in vectors], 0
    for column in range(3):
        pivot = next((k for k in range(found, len(rows)) if rows[k][column] != 0), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        for k in range(found + 1, len(rows)):
            factor = rows[k][column] / rows[found][column]
            rows[k] = [x - factor * y for x, y in zip(rows[k], rows[found])]
        found += 1
    return found


class Exact:
    """The body of planes with normals that span space, by all triples of planes."""

    def __init__(self, planes):
        self.planes = [tuple(Fraction(float(number)) for number in plane) for plane in planes]
        corners = set()
        for a, b, c in combinations(self.planes, 3):
            scale = dot(a, cross(b, c))
            if scale == 0:
                continue
            parts = [[a[3] * x for x in cross(b, c)], [b[3] * x for x in cross(c, a)], [c[3] * x for x in cross(a, b)]]
            corner = tuple(sum(column) / scale for column in zip(*parts))
            if self.holds(corner):
                corners.add(corner)
        self.corners = corners
        # the directions of edges that go to infinity
        ways = {way for a, b in combinations(self.planes, 2) for c in [cross(a, b)] for way in (c, tuple(-x for x in c))}
        self.rays = [way for way in ways if any(way) and all(dot(plane, way) <= 0 for plane in self.planes)]

    def holds(self, point) -> bool:
        return all(dot(plane, point) <= plane[3] for plane in self.planes)

    @property
    def is_empty(self) -> bool:
        """Whether it has no interior."""
        if not self.corners:
            return True
        first = next(iter(self.corners))
        return rank([[x - y for x, y in zip(corner, first)] for corner in self.corners] + self.rays) < 3

    @property
    def is_bounded(self) -> bool:
        return self.is_empty or not self.rays

    @property
    def faces(self) -> set[frozenset]:
        """The corners of each face of a bounded body."""
        on = (frozenset(c for c in self.corners if dot(plane, c) == plane[3]) for plane in self.planes)
        return {corners for corners in on if len(corners) > 2}


def rounded(corners):
    return sorted(tuple(float(number) + 0.0 for number in corner) for corner in corners)


def random_planes(rng, count):
    """Planes of small whole numbers, many through common points."""
    planes = []
    while len(planes) < count:
        normal = rng.integers(-3, 4, 3)
        if normal.any():
            planes.append([*normal.tolist(), int(rng.integers(-1, 7))])
    return planes


def assert_agrees(body: pc.Polytope, planes) -> Exact:
    expected = Exact(planes)
    assert body.is_empty == expected.is_empty
    assert body.is_bounded == expected.is_bounded
    if expected.is_empty:
        assert body.volume == 0.0 and body.area == 0.0 and len(body.vertices) == 0
        return expected
    assert rounded(body.vertices) == rounded(expected.corners)
    if not expected.is_bounded:
        assert body.volume == np.inf and body.area == np.inf
        return expected
    corners = body.vertices
    assert sorted(rounded(corners[face]) for face in body.faces) == sorted(rounded(face) for face in expected.faces)
    triangles = np.array([[face[0], face[k], face[k + 1]] for face in body.faces for k in range(1, len(face) - 1)])
    assert body.volume == pytest.approx(mesh_volume(corners, triangles), rel=1e-12)
    edges = [(a, b) for face in body.faces for a, b in zip(face, face[1:] + face[:1])]
    assert len(set(edges)) == len(edges) and {(b, a) for a, b in edges} == set(edges)
    assert len(corners) - len(edges) // 2 + len(body.faces) == 2
    return expected


@pytest.mark.parametrize("case", range(30))
def test_bodies_have_the_corners_that_fractions_give(case):
    rng = generator(case)
    within = CUBE if case % 2 else [[1, 0, 0, 4], [0, 1, 0, 4], [0, 0, 1, 4]]
    planes = within + random_planes(rng, int(rng.integers(1, 9)))
    body = pc.Polytope(planes)
    np.testing.assert_array_equal(body.planes, planes)
    np.testing.assert_array_equal(body.plane_ids, np.arange(len(planes)))
    expected = assert_agrees(body, planes)
    points = np.concatenate([rng.integers(-4, 5, (60, 3)).astype(float), rng.uniform(-4, 4, (40, 3)), body.vertices])
    exact = [expected.holds([Fraction(x) for x in point]) for point in points.tolist()]
    np.testing.assert_array_equal(body.contains(points), exact)


@pytest.mark.parametrize("case", range(12))
def test_planes_that_come_move_and_go_leave_what_a_fresh_body_is(case):
    rng = generator(case)
    body = pc.Polytope(CUBE)
    planes = dict(enumerate(CUBE))
    for step in range(40):
        what = rng.random()
        if what < 0.45 or len(planes) < 4:
            plane = random_planes(rng, 1)[0]
            number = body.add_plane(plane)
            assert number not in planes
            planes[number] = plane
        elif what < 0.75:
            number = int(rng.choice(list(planes)))
            planes[number] = [*planes[number][:3], float(rng.integers(-2, 8)) / 2]
            body.move_plane(number, planes[number][3])
        else:
            number = int(rng.choice(list(planes)))
            body.remove_plane(number)
            del planes[number]
        assert sorted(planes) == body.plane_ids.tolist()
        rows = [planes[number] for number in sorted(planes)]
        np.testing.assert_array_equal(body.planes, rows)
        fresh = pc.Polytope(rows)
        assert (fresh.is_empty, fresh.is_bounded) == (body.is_empty, body.is_bounded)
        assert rounded(fresh.vertices) == rounded(body.vertices)
        assert body.volume == pytest.approx(fresh.volume, rel=1e-12) and body.area == pytest.approx(fresh.area, rel=1e-12)
        if step % 8 == 0 and rank([row[:3] for row in rows]) == 3:
            assert_agrees(body, rows)


def test_faces_lie_on_their_planes_and_run_counter_clockwise():
    rng = generator()
    normals = rng.normal(size=(40, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    body = pc.Polytope(np.column_stack([normals, np.ones(40)]))
    assert body.is_bounded
    areas = []
    for face, plane in zip(body.faces, body.face_planes, strict=True):
        corners = body.vertices[face]
        np.testing.assert_allclose(corners @ normals[plane], 1.0, rtol=1e-12)
        fan = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0]) @ normals[plane] / 2
        assert (fan > 0).all()
        areas.append(fan.sum())
        assert body.face_area(plane) == pytest.approx(fan.sum(), rel=1e-10)
    assert body.area == pytest.approx(sum(areas), rel=1e-12)
    # of distance 1 from the origin each: cones over the faces
    assert body.volume == pytest.approx(sum(areas) / 3, rel=1e-12)


def test_the_area_of_a_face_is_how_the_volume_grows():
    body = pc.Polytope([[*plane[:3], 1] for plane in CUBE] + [[0.6, 0.8, 0, 1.1]])
    before, area, step = body.volume, body.face_area(6), 1e-6
    body.move_plane(6, 1.1 + step)
    assert (body.volume - before) / step == pytest.approx(area, rel=1e-4)
    assert body.face_area(body.add_plane([1, 0, 0, 100])) == 0.0
    assert pc.Polytope([[1, 0, 0, 1]]).face_area(0) == np.inf


def test_a_body_of_few_planes_is_unbounded():
    for count in range(4):
        body = pc.Polytope(CUBE[:count])
        assert not body.is_bounded and not body.is_empty and body.volume == np.inf and body.area == (np.inf)
    slab = pc.Polytope(CUBE[:2])
    assert slab.vertices.shape == (0, 3) and not slab.is_bounded
    assert pc.Polytope([[1, 0, 0, -1], [-1, 0, 0, -1]]).is_empty
    flat = pc.Polytope([[1, 0, 0, 1], [-1, 0, 0, -1]])
    # what has no interior is taken for empty, and holds nothing
    assert flat.is_empty and not flat.contains([[1, 7, 7]]).any()


def test_lengths_of_normals_do_not_matter():
    body = pc.Polytope(np.array(CUBE) * np.array([1, 2, 0.5, 1e10, 1e-10, 3])[:, None])
    assert body.volume == 8.0**3
    body.move_plane(1, 2 * 8.0)
    assert body.volume == 12.0 * 8 * 8


def test_numbers_of_planes_that_were_removed_are_refused():
    body = pc.Polytope(CUBE)
    body.remove_plane(2)
    for work in (lambda: body.remove_plane(2), lambda: body.move_plane(2, 1.0), lambda: body.face_area(2)):
        with pytest.raises(pc.PlanecutError, match="found 2"):
            work()
    assert body.add_plane(CUBE[2]) == 2 and body.volume == 8.0**3
