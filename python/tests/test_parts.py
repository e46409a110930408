"""Hulls, Minkowski sums, parts and sections of solids, and what cells become again."""

from __future__ import annotations

import re

import numpy as np
import planecut as pc
import pytest
from oracles import Tree, generator, mesh_area, mesh_volume, random_affine, voxel_tree


def some_solid(case: int) -> pc.Solid:
    rng = generator(case)
    return Tree(rng, int(rng.integers(3, 8))).solid() | pc.box([-0.5] * 3, [0.5] * 3)


def signed_area(loop: np.ndarray) -> float:
    following = np.roll(loop, -1, axis=0)
    return float((loop[:, 0] * following[:, 1] - following[:, 0] * loop[:, 1]).sum() / 2)


@pytest.mark.parametrize("case", range(6))
def test_the_hull_of_solids_is_that_of_their_corners(case):
    spatial = pytest.importorskip("scipy.spatial")
    solids = [some_solid(case), pc.sphere(0.3, 8).translate([2, 0, 0])]
    points = np.concatenate([solid.mesh().vertices for solid in solids])
    assert pc.hull(solids).volume == pytest.approx(spatial.ConvexHull(points).volume, rel=1e-6)


def test_the_sum_of_boxes_has_the_sum_of_their_sides():
    rng = generator()
    a, b = rng.uniform(0.5, 2, 3), rng.uniform(0.5, 2, 3)
    found = pc.minkowski(pc.box([0, 0, 0], a), pc.box([1, 1, 1], 1 + b))
    np.testing.assert_allclose(found.bounds, [[1, 1, 1], 1 + a + b], rtol=1e-14)
    assert found.volume == pytest.approx(np.prod(a + b), rel=1e-12)


@pytest.mark.parametrize("case", range(5))
def test_the_sum_of_convex_bodies_is_the_hull_of_the_sums_of_corners(case):
    spatial = pytest.importorskip("scipy.spatial")
    rng = generator(case)
    a, b = rng.normal(size=(9, 3)), rng.normal(size=(7, 3)) * 0.4
    sums = (a[:, None] + b[None]).reshape(-1, 3)
    assert pc.minkowski(pc.hull(a), pc.hull(b)).volume == pytest.approx(spatial.ConvexHull(sums).volume, rel=1e-9)


def test_the_sum_of_parts_is_the_union_of_the_sums():
    a = pc.box([0, 0, 0], [3, 1, 1]) | pc.box([0, 0, 0], [1, 3, 1])
    b = pc.box([0, 0, 0], [0.5, 0.5, 0.5])
    parts = [pc.minkowski(pc.box([0, 0, 0], top), b) for top in ([3, 1, 1], [1, 3, 1])]
    assert pc.minkowski(a, b).volume == pytest.approx(pc.union(parts).volume, rel=1e-12)


@pytest.mark.parametrize("case", range(20))
def test_components_are_the_connected_sets_of_voxels(case):
    ndimage = pytest.importorskip("scipy.ndimage")
    rng = generator(case)
    solid, voxels = voxel_tree(rng, int(rng.integers(3, 16)), 6)
    # across faces, not across edges and corners
    labels, count = ndimage.label(voxels)
    expected = sorted(np.bincount(labels.reshape(-1), minlength=count + 1)[1:].tolist())
    assert sorted(part.volume for part in solid.components()) == pytest.approx(expected, rel=1e-12)


def test_parts_that_touch_in_a_corner_or_an_edge_are_apart():
    a = pc.box([0, 0, 0], [1, 1, 1])
    for offset, count in (([1, 1, 1], 2), ([1, 1, 0], 2), ([1, 0, 0], 1), ([3, 0, 0], 2)):
        assert len((a | a.translate(offset)).components()) == count
    assert pc.union([]).components() == []


@pytest.mark.parametrize("case", range(8))
def test_sections_have_the_area_that_manifold3d_finds(case):
    pytest.importorskip("manifold3d")
    rng = generator(case)
    tree = Tree(rng, int(rng.integers(1, 7)))
    solid, body = tree.solid(), tree.manifold()
    for height in rng.uniform(-1, 1, 5):
        loops = solid.slice(float(height))
        assert all(loop.ndim == 2 and loop.shape[1] == 2 and loop.dtype == np.float64 for loop in loops)
        area = sum(signed_area(loop) for loop in loops)
        assert area == pytest.approx(body.slice(float(height)).area(), rel=1e-6, abs=1e-7)
        if area > 1e-3:
            assert pc.extrude(loops, 2.0).volume == pytest.approx(2 * area, rel=1e-9)


def test_outer_loops_run_counter_clockwise_and_holes_clockwise():
    tube = pc.cylinder(4, 2, segments=16) - pc.cylinder(4, 1, segments=16)
    outer, hole = sorted(tube.slice(2.0), key=lambda loop: -abs(signed_area(loop)))
    assert signed_area(outer) > 0 > signed_area(hole)
    # what there is just above the plane
    assert len(tube.slice(0.0)) == 2 and tube.slice(4.0) == [] and tube.slice(4.5) == []


@pytest.mark.parametrize("case", range(5))
def test_one_body_is_the_same_solid(case):
    solid = some_solid(case)
    body = solid.as_one_body()
    assert body.volume == pytest.approx(solid.volume, rel=1e-9)
    points = generator(case).uniform(-2, 2, (500, 3))
    np.testing.assert_array_equal(body.contains(points), solid.contains(points))
    cut = pc.box([0, -9, -9], [9, 9, 9])
    assert (body - cut).volume == pytest.approx((solid - cut).volume, rel=1e-9)
    assert len(pc.Live(body).brushes) == 1


@pytest.mark.parametrize("case", range(4))
def test_cells_become_solids_again(case):
    solid = some_solid(case)
    cells = solid.cells()
    for cell in cells:
        assert cell.to_solid().volume == pytest.approx(cell.volume, rel=1e-9)
    again = pc.union([cell.to_solid() for cell in cells])
    assert (again ^ solid).volume == pytest.approx(0, abs=1e-12)
    hulls = pc.coarsen(solid, 3)
    assert hulls.to_solid().volume == pytest.approx(hulls.volume_out, rel=1e-9)
    assert (solid - hulls.to_solid()).volume == pytest.approx(0, abs=1e-12)


def test_few_cells_are_a_sequence():
    hulls = pc.coarsen(pc.box([0, 0, 0], [1, 1, 1]) | pc.box([3, 0, 0], [4, 1, 1]))
    assert len(hulls) == 2 and list(hulls) == list(hulls.cells)
    assert hulls[0] is hulls.cells[0] and hulls[-1] is hulls.cells[1] and hulls[:1] == hulls.cells[:1]
    with pytest.raises(IndexError):
        hulls[2]


@pytest.mark.parametrize("case", range(6))
def test_meshes_are_measured_and_moved(case):
    mesh, matrix = some_solid(case).mesh(), random_affine(generator(case))
    assert mesh.area == pytest.approx(mesh_area(mesh.vertices, mesh.triangles), rel=1e-12)
    np.testing.assert_array_equal(mesh.bounds, [mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])
    moved = mesh.transform(matrix)
    np.testing.assert_allclose(moved.vertices, mesh.vertices @ matrix[:, :3].T + matrix[:, 3], atol=1e-12)
    assert moved.volume == pytest.approx(mesh_volume(mesh.vertices, mesh.triangles) * abs(np.linalg.det(matrix[:, :3])), rel=1e-9)
    assert moved.is_watertight
    np.testing.assert_array_equal(moved.material_ids, mesh.material_ids)


def test_meshes_become_those_of_manifold3d():
    pytest.importorskip("manifold3d")
    solid = some_solid(0)
    assert solid.mesh().to_manifold().volume() == pytest.approx(solid.volume, rel=1e-9)


def test_colours_of_materials_are_kept():
    red = (1.0, 0.25, 0.0)
    solid = pc.box([0, 0, 0], [1, 1, 1]).with_material("paint", color=red) | pc.box([2, 0, 0], [3, 1, 1], "plain")
    mesh = solid.mesh()
    colors = dict(zip(mesh.materials, mesh.material_colors, strict=True))
    np.testing.assert_array_equal(colors["paint"], red)
    assert np.isnan(colors["plain"]).all()


def test_cells_and_meshes_are_drawn(tmp_path):
    solid = pc.box([0, 0, 0], [1, 1, 1]) | pc.box([3, 0, 0], [4, 1, 1])
    hulls = pc.coarsen(solid)
    for subject in (solid, solid.mesh(), hulls):
        picture = subject.render((80, 60))
        assert picture.shape == (60, 80, 4) and len(np.unique(picture.reshape(-1, 4), axis=0)) > 2
        assert subject._repr_png_().startswith(b"\x89PNG")
    assert (hulls.render((80, 60), spread=1.0) != hulls.render((80, 60))).any()
    solid.save(tmp_path / "x.png", size=(80, 60))
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("ending", ["urdf", "xml", "usda"])
def test_rigid_bodies_are_written_with_their_mass_and_all_cells(tmp_path, ending):
    hulls = pc.coarsen(pc.box([0, 0, 0], [1, 1, 1]) | pc.box([3, 0, 0], [4, 1, 1]))
    hulls.save(tmp_path / f"body.{ending}", density=500.0)
    text = (tmp_path / f"body.{ending}").read_text()
    mass = re.search(r'mass(?: value)?\s*=\s*"?([0-9.]+)', text)
    assert mass is not None and float(mass.group(1)) == pytest.approx(500.0 * hulls.volume_in)
    assert len(re.findall("cell [01]|cell_[01]", text)) >= len(hulls)
