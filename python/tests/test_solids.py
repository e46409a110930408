"""Operators, transforms and measures of solids."""

from __future__ import annotations

import math

import numpy as np
import planecut as pc
import pytest
from oracles import Tree, box_points, first_hits, generator, is_closed, mesh_area, mesh_volume, random_affine, voxel_tree

CASES = range(24)


def polygon_area(loop: np.ndarray) -> float:
    following = np.roll(loop, -1, axis=0)
    return float(abs((loop[:, 0] * following[:, 1] - following[:, 0] * loop[:, 1]).sum()) / 2.0)


def first_moment(loop: np.ndarray) -> float:
    """The integral of x over a polygon."""
    following = np.roll(loop, -1, axis=0)
    cross = loop[:, 0] * following[:, 1] - following[:, 0] * loop[:, 1]
    return float(abs(((loop[:, 0] + following[:, 0]) * cross).sum()) / 6.0)


# ---- shapes against formulas


def test_a_box_has_the_measures_of_its_sides():
    rng = generator()
    low, size = rng.normal(size=3), rng.uniform(0.5, 3, size=3)
    box = pc.box(low, low + size)
    a, b, c = (low + size) - low
    assert box.volume == pytest.approx(a * b * c, rel=1e-14)
    assert box.area == pytest.approx(2 * (a * b + b * c + c * a), rel=1e-14)
    np.testing.assert_array_equal(box.bounds, [low, low + size])
    np.testing.assert_allclose(box.centroid, low + size / 2, rtol=1e-12)


@pytest.mark.parametrize("segments", [3, 4, 7, 48, 500])
@pytest.mark.parametrize("top", [None, 0.0, 0.7, 5.0])
def test_a_cylinder_is_a_frustum_over_a_regular_polygon(segments, top):
    height, radius = 3.25, 1.5
    solid = pc.cylinder(height, radius, top, segments)
    other = radius if top is None else top
    base = segments / 2 * math.sin(2 * math.pi / segments)
    expected = base * height * (radius**2 + radius * other + other**2) / 3
    assert solid.volume == pytest.approx(expected, rel=1e-12)
    # sides: trapezoids between apothems
    apothem = (radius - other) * math.cos(math.pi / segments)
    sides = segments * math.sin(math.pi / segments) * (radius + other) * math.hypot(height, apothem)
    assert solid.area == pytest.approx(base * (radius**2 + other**2) + sides, rel=1e-12)
    assert solid.bounds[0, 2] == 0.0 and solid.bounds[1, 2] == height


@pytest.mark.parametrize("segments", [8, 16, 32])
def test_a_sphere_has_its_corners_on_the_sphere_and_converges_quadratically(segments):
    radius = 2.5
    coarse, fine = pc.sphere(radius, segments), pc.sphere(radius, 2 * segments)
    np.testing.assert_allclose(np.linalg.norm(coarse.mesh().vertices, axis=1), radius, rtol=1e-14)
    exact = 4 / 3 * math.pi * radius**3
    assert coarse.volume < fine.volume < exact
    assert (exact - coarse.volume) / (exact - fine.volume) == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("segments", [3, 5, 64])
def test_a_torus_is_its_tube_revolved(segments):
    tube = 7
    solid = pc.torus(3.0, 1.0, segments, tube)
    area = tube / 2 * math.sin(2 * math.pi / tube)
    # the middle of a regular polygon is the circle's: Pappus, less what chords cut off
    assert solid.volume == pytest.approx(segments * math.sin(2 * math.pi / segments) * area * 3.0, rel=1e-12)
    assert len(solid.mesh().vertices) == tube * segments


@pytest.mark.parametrize("segments", [3, 12, 64])
def test_a_revolved_outline_has_the_volume_of_pappus_less_what_chords_cut_off(segments):
    outline = np.array([[1, 0], [3, 0], [2.5, 1], [3, 2], [1.5, 2.5]])
    solid = pc.revolve(outline, segments)
    expected = segments * math.sin(2 * math.pi / segments) * first_moment(outline)
    assert solid.volume == pytest.approx(expected, rel=1e-12)
    np.testing.assert_allclose(solid.centroid[:2], 0, atol=1e-12)


def test_a_quarter_turn_has_a_quarter_of_the_volume():
    outline = [[1, 0], [2, 0], [2, 1], [1, 1]]
    whole = pc.revolve(outline, 32)
    assert 4 * pc.revolve(outline, 32, 90).volume == pytest.approx(whole.volume, rel=1e-12)


def test_an_extruded_outline_with_a_hole_has_the_area_times_the_height():
    outer = np.array([[0, 0], [4, 0], [5, 3], [2, 2], [0, 4]])
    hole = np.array([[1, 1], [1, 1.5], [2, 1.5], [2, 1]])
    for loops in ([outer, hole], [outer[::-1], hole], (outer, hole[::-1])):
        assert pc.extrude(loops, 2.5).volume == pytest.approx(2.5 * (polygon_area(outer) - polygon_area(hole)), rel=1e-12)
    assert pc.extrude(outer, 2.5).volume == pytest.approx(2.5 * polygon_area(outer), rel=1e-12)
    assert pc.extrude(outer.tolist(), 2.5).volume == pc.extrude(outer, 2.5).volume


@pytest.mark.parametrize("scale", [0.0, 0.5, 2.0])
def test_an_extruded_outline_that_narrows_is_a_frustum(scale):
    loop = np.array([[-1, -1], [1, -1], [1.5, 1], [-1, 1]])
    expected = polygon_area(loop) * 3 * (1 + scale + scale**2) / 3
    assert pc.extrude(loop, 3, scale=scale).volume == pytest.approx(expected, rel=1e-12)


def test_a_twist_turns_the_top_clockwise_seen_from_above():
    top = pc.extrude([[1, -0.1], [2, -0.1], [2, 0.1], [1, 0.1]], 1, twist=90).mesh().vertices
    top = top[top[:, 2] == 1.0]
    assert (top[:, 1] < 0).all() and np.abs(top[:, 0]).max() == pytest.approx(0.1)


def test_a_hull_has_the_measures_that_scipy_gives():
    spatial = pytest.importorskip("scipy.spatial")
    for case in range(10):
        points = generator(case).normal(size=(4 + 5 * case, 3))
        expected, found = spatial.ConvexHull(points), pc.hull(points)
        assert found.volume == pytest.approx(expected.volume, rel=1e-12)
        assert found.area == pytest.approx(expected.area, rel=1e-12)
        assert len(found.mesh().vertices) == len(expected.vertices)


def test_half_spaces_bound_the_body_that_scipy_intersects():
    spatial = pytest.importorskip("scipy.spatial")
    bounded = 0
    for case in range(10):
        rng = generator(case)
        normals = rng.normal(size=(20, 3))
        if spatial.ConvexHull(normals).equations[:, 3].max() >= 0:
            continue  # the origin is not within the hull of the normals: unbounded
        bounded += 1
        planes = np.column_stack([normals, np.linalg.norm(normals, axis=1) * rng.uniform(0.5, 1, 20)])
        corners = spatial.HalfspaceIntersection(planes * [1, 1, 1, -1], np.zeros(3)).intersections
        assert pc.halfspaces(planes).volume == pytest.approx(spatial.ConvexHull(corners).volume, rel=1e-10)
    assert bounded > 0


# ---- trees against other kernels


@pytest.mark.parametrize("case", CASES)
def test_random_trees_agree_with_manifold3d(case):
    pytest.importorskip("manifold3d")
    rng = generator(case)
    tree = Tree(rng, int(rng.integers(2, 9)))
    solid, expected = tree.solid(), tree.manifold()
    assert solid.volume == pytest.approx(expected.volume(), rel=1e-9, abs=1e-9)
    assert solid.area == pytest.approx(expected.surface_area(), rel=1e-8, abs=1e-8)
    assert solid.is_empty == (expected.num_tri() == 0)
    if not solid.is_empty:
        box = np.array(expected.bounding_box()).reshape(2, 3)
        np.testing.assert_allclose(solid.bounds, box, atol=1e-9)
        mesh = solid.mesh()
        assert mesh.is_watertight and mesh.check() == []
        assert is_closed(mesh.triangles)
        assert mesh_volume(mesh.vertices, mesh.triangles) == pytest.approx(solid.volume, rel=1e-9, abs=1e-12)
        assert mesh_area(mesh.vertices, mesh.triangles) == pytest.approx(solid.area, rel=1e-9)


@pytest.mark.parametrize("case", CASES)
def test_random_trees_contain_the_points_that_half_spaces_say(case):
    pytest.importorskip("scipy")
    rng = generator(case)
    tree = Tree(rng, int(rng.integers(1, 9)))
    points = rng.uniform(-2, 2, size=(1500, 3))
    expected, clear = tree.contains(points)
    is_sure = clear > 1e-9
    found = tree.solid().contains(points)
    assert found.dtype == bool and found.shape == (len(points),)
    np.testing.assert_array_equal(found[is_sure], expected[is_sure])
    # the same by Monte Carlo: within six standard deviations
    share = found.mean()
    deviation = 64 * math.sqrt(max(share * (1 - share), 1 / len(points)) / len(points))
    box = pc.box([-2] * 3, [2] * 3)
    assert abs((tree.solid() & box).volume - 64 * share) < 6 * deviation


@pytest.mark.parametrize("case", CASES)
def test_rays_meet_the_triangles_that_brute_force_finds(case):
    pytest.importorskip("manifold3d")
    rng = generator(case)
    tree = Tree(rng, int(rng.integers(1, 6)))
    mesh = tree.manifold().to_mesh64()
    vertices, triangles = np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts)
    origins, directions = rng.uniform(-3, 3, size=(200, 3)), rng.normal(size=(200, 3)) * rng.uniform(1e-3, 1e3, size=(200, 1))
    expected, _ = first_hits(vertices, triangles, origins, directions)
    found = tree.solid().ray_cast(origins, directions)
    assert found.dtype == np.float64
    is_same = np.isclose(found, expected, rtol=1e-7, atol=1e-8) | (np.isinf(found) & np.isinf(expected))
    # a ray may pass an edge on either side
    assert is_same.mean() >= 0.99


@pytest.mark.parametrize("case", range(40))
def test_trees_of_boxes_on_a_grid_fill_the_voxels_exactly(case):
    rng, size = generator(case), 6
    solid, voxels = voxel_tree(rng, int(rng.integers(2, 14)), size)
    assert solid.volume == voxels.sum()
    padded = np.pad(voxels, 1)
    assert solid.area == sum(int((np.diff(padded.astype(int), axis=axis) != 0).sum()) for axis in range(3))
    assert solid.is_empty == (not voxels.any())
    middles = np.argwhere(np.ones_like(voxels)) + 0.5
    np.testing.assert_array_equal(solid.contains(middles), voxels.reshape(-1))
    mesh = solid.mesh()
    assert mesh.check() == []
    if voxels.any():
        filled = np.argwhere(voxels)
        np.testing.assert_array_equal(solid.bounds, [filled.min(axis=0), filled.max(axis=0) + 1])
        np.testing.assert_allclose(solid.centroid, filled.mean(axis=0) + 0.5, rtol=1e-12)
    rays = np.argwhere(np.ones((size, size))) + 0.5
    origins = np.column_stack([np.full(len(rays), -1.0), rays])
    columns = voxels.reshape(size, -1)
    expected = np.where(columns.any(axis=0), columns.argmax(axis=0) + 1.0, np.inf)
    np.testing.assert_array_equal(solid.ray_cast(origins, [[2, 0, 0]]), expected)
    cells = solid.cells()
    assert sum(cell.volume for cell in cells) == pytest.approx(voxels.sum(), rel=1e-12)
    held = np.array([[(cell.planes[:, :3] @ point <= cell.planes[:, 3]).all() for cell in cells] for point in middles]).reshape(len(middles), -1)
    np.testing.assert_array_equal(held.sum(axis=1), voxels.reshape(-1).astype(int))


def test_the_boundary_belongs_to_a_solid():
    box, lid = pc.box([0, 0, 0], [1, 1, 1]), pc.box([0, 0, 1], [1, 1, 2])
    on = box_points([0, 0, 0], [1, 1, 1])
    assert box.contains(on).all()
    assert (box | lid).contains([[0.5, 0.5, 1.0]]).all()
    assert not (box - box).contains(on).any()
    assert (box - lid).contains([[0.5, 0.5, 1.0]]).all()
    above = np.nextafter(1.0, 2.0)
    assert not box.contains([[0.5, 0.5, above]]).any()


# ---- identities


@pytest.mark.parametrize("case", CASES)
def test_volumes_obey_inclusion_and_exclusion(case):
    rng = generator(case)
    a, b, c = (Tree(rng, int(rng.integers(1, 5))).solid() for _ in range(3))
    scale = a.volume + b.volume + c.volume
    both = (a & b).volume
    assert (a | b).volume + both == pytest.approx(a.volume + b.volume, rel=1e-12)
    assert (a ^ b).volume == pytest.approx((a | b).volume - both, abs=1e-12 * scale)
    assert (a - b).volume == pytest.approx(a.volume - both, abs=1e-12 * scale)
    three = a.volume + b.volume + c.volume - both - (b & c).volume - (a & c).volume + (a & b & c).volume
    assert pc.union([a, b, c]).volume == pytest.approx(three, rel=1e-11)
    assert pc.difference(a, [b, c]).volume == pytest.approx((a - (b | c)).volume, abs=1e-12 * scale)
    assert pc.intersection([a, b, c]).volume == pytest.approx((a & b & c).volume, abs=1e-12 * scale)
    assert (a & ~b).volume == pytest.approx((a - b).volume, abs=1e-12 * scale)
    assert (~(~a | ~b)).volume == pytest.approx(both, abs=1e-12 * scale)


def test_a_solid_less_itself_is_empty():
    for case in range(5):
        solid = Tree(generator(case), 4).solid()
        for nothing in (solid - solid, solid ^ solid, solid & ~solid, pc.union([])):
            assert nothing.is_empty and nothing.volume == 0.0 and nothing.area == 0.0
            assert np.isnan(nothing.centroid).all() and np.isnan(nothing.bounds).all()
            assert nothing.mesh().vertices.shape == (0, 3) and nothing.cells() == []
            assert np.isinf(nothing.ray_cast([[0, 0, 0]], [[1, 0, 0]])).all()
        assert (solid | solid).volume == solid.volume


@pytest.mark.parametrize("case", range(12))
def test_an_affine_map_multiplies_volumes_by_its_determinant(case):
    rng = generator(case)
    solid, matrix = Tree(rng, 3).solid(), random_affine(rng)
    moved = solid.transform(matrix)
    assert moved.volume == pytest.approx(solid.volume * abs(np.linalg.det(matrix[:, :3])), rel=1e-9)
    square = np.vstack([matrix, [0, 0, 0, 1]])
    assert solid.transform(square).volume == moved.volume
    np.testing.assert_allclose(moved.centroid, matrix[:, :3] @ solid.centroid + matrix[:, 3], atol=1e-9)
    back = np.linalg.inv(square)
    np.testing.assert_allclose(moved.transform(back).bounds, solid.bounds, atol=1e-9)


@pytest.mark.parametrize("axis, index", [("x", 0), ("y", 1), ("z", 2)])
def test_right_angles_are_exact_and_counter_clockwise(axis, index):
    low, high = np.array([1.0, 2.0, 3.0]), np.array([2.1, 4.3, 7.7])
    a, b = (index + 1) % 3, (index + 2) % 3
    turn = np.zeros((3, 3))
    turn[index, index], turn[b, a], turn[a, b] = 1, 1, -1
    corners = box_points(low, high) @ turn.T
    for by in (axis, np.eye(3)[index], 7 * np.eye(3)[index]):
        np.testing.assert_array_equal(pc.box(low, high).rotate(by, 90).bounds, [corners.min(axis=0), corners.max(axis=0)])
    np.testing.assert_array_equal(pc.box(low, high).rotate(axis, 360).bounds, [low, high])


def test_moves_scalings_and_mirrors_do_what_matrices_do():
    solid = pc.hull(generator().normal(size=(9, 3)))
    points = np.array(solid.mesh().vertices)
    normal = np.array([1.0, 2.0, -0.5])
    householder = np.eye(3) - 2 * np.outer(normal, normal) / (normal @ normal)
    cases = [
        (solid.translate([1, -2, 3]), points + [1, -2, 3]),
        (solid.scale(2.5), points * 2.5),
        (solid.scale([1, -2, 0.5]), points * [1, -2, 0.5]),
        (solid.mirror(normal), points @ householder.T),
        (solid.translate([1, 0, 0]).rotate("z", 90).scale(2), (points + [1, 0, 0]) @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) * 2),
    ]
    for moved, expected in cases:
        np.testing.assert_allclose(moved.bounds, [expected.min(axis=0), expected.max(axis=0)], atol=1e-12)
        assert moved.volume > 0 and moved.mesh().is_watertight


def test_the_number_of_threads_does_not_change_a_mesh():
    tree = Tree(generator(), 8)
    meshes = [tree.solid().mesh(threads=threads) for threads in (1, 2, 3)]
    for mesh in meshes[1:]:
        assert mesh.vertices.tobytes() == meshes[0].vertices.tobytes()
        assert mesh.triangles.tobytes() == meshes[0].triangles.tobytes()


def test_materials_stay_with_their_bodies():
    a, b = pc.box([0, 0, 0], [1, 1, 1], "clay"), pc.box([2, 0, 0], [3, 1, 1], material="steel")
    mesh = (a | b).mesh()
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    names = np.array(mesh.materials)[mesh.material_ids]
    np.testing.assert_array_equal(names, np.where(middles[:, 0] < 1.5, "clay", "steel"))
    assert set((a | b).with_material("wood").mesh().materials) == {"wood"}
    assert {cell.material for cell in (a | b).cells()} == {"clay", "steel"}


def test_a_picture_has_the_size_that_was_asked_for_and_shows_something():
    solid = pc.box([0, 0, 0], [1, 1, 1])
    for style in ("shaded", "technical", "xray", "wireframe"):
        picture = solid.render((64, 48), style)
        assert picture.shape == (48, 64, 4) and picture.dtype == np.uint8
        assert len(np.unique(picture.reshape(-1, 4), axis=0)) > 1
    assert (solid.render((64, 48), background="transparent")[0, 0] == 0).all()
    assert solid._repr_png_().startswith(b"\x89PNG\r\n\x1a\n")
    assert "<iframe" in solid.view()._repr_html_()
