"""Few convex cells around solids, meshes and hulls."""

from __future__ import annotations

import warnings

import numpy as np
import planecut as pc
import pytest
from oracles import Tree, data, generator, mesh_volume

STAIRS = pc.union([pc.box([k, 0, 0], [k + 1, 1, k + 1]) for k in range(4)])


def some_solid(case: int) -> pc.Solid:
    rng = generator(case)
    return Tree(rng, int(rng.integers(3, 7))).solid() | pc.box([-0.5] * 3, [0.5] * 3)


def samples(solid: pc.Solid, rng) -> np.ndarray:
    """Vertices of a solid and points of its inside."""
    low, high = solid.bounds
    points = rng.uniform(low, high, (3000, 3))
    return np.concatenate([points[solid.contains(points)], solid.mesh().vertices])


def are_held(cells, points: np.ndarray, margin: float) -> np.ndarray:
    """Whether each point is in the hull of the vertices of some cell."""
    spatial = pytest.importorskip("scipy.spatial")
    held = np.zeros(len(points), bool)
    for cell in cells:
        planes = spatial.ConvexHull(cell.vertices).equations
        held |= (points @ planes[:, :3].T + planes[:, 3] <= margin).all(axis=1)
    return held


def union_volume(cells) -> float:
    """The volume of the union of what the planes of cells bound."""
    manifold3d = pytest.importorskip("manifold3d")
    bodies = [manifold3d.Manifold.hull_points(np.array(pc.Polytope(cell.planes).vertices)) for cell in cells]
    return manifold3d.Manifold.batch_boolean(bodies, manifold3d.OpType.Add).volume()


def outside(cell: pc.Cell) -> float:
    """How far the vertices of a cell are outside of its planes, at most."""
    normals = cell.planes[:, :3]
    return float(((cell.vertices @ normals.T - cell.planes[:, 3]) / np.linalg.norm(normals, axis=1)).max())


@pytest.mark.parametrize("case", range(6))
@pytest.mark.parametrize("most", [1, 4])
def test_cells_hold_the_solid_and_the_excess_is_what_they_add(case, most):
    solid = some_solid(case)
    hulls = pc.coarsen(solid, most)
    assert hulls.encloses and 1 <= len(hulls) == len(hulls.cells) <= most
    points = samples(solid, generator(case))
    size = float(np.ptp(solid.bounds, axis=0).max())
    assert are_held(hulls.cells, points, 1e-12 * size).all()
    assert hulls.volume_in == pytest.approx(solid.volume, rel=1e-9)
    assert hulls.volume_out == pytest.approx(union_volume(hulls.cells), rel=1e-8)
    assert hulls.excess == pytest.approx(union_volume(hulls.cells) / solid.volume - 1, abs=1e-7)
    assert hulls.sum_excess == pytest.approx(sum(cell.volume for cell in hulls.cells) / solid.volume - 1, abs=1e-7)
    assert hulls.enclosed == "solid" and hulls.thickness is None


@pytest.mark.parametrize("case", range(3))
def test_cells_are_convex_and_their_arrays_agree(case):
    spatial = pytest.importorskip("scipy.spatial")
    # vertices of cells that enclose are moved outward, by less than anybody sees
    few = [(cell, 1e-5) for cell in pc.coarsen(some_solid(case), 3).cells]
    for cell, margin in few + [(cell, 1e-9) for cell in some_solid(case).cells()]:
        assert outside(cell) < margin
        hull = spatial.ConvexHull(cell.vertices)
        assert cell.volume == pytest.approx(hull.volume, rel=100 * margin, abs=1e-9)
        assert mesh_volume(cell.vertices, cell.triangles) == pytest.approx(hull.volume, rel=1e-9, abs=1e-12)
        assert pc.Mesh(cell.vertices, cell.triangles).is_watertight


def test_one_cell_is_the_hull_when_nothing_limits_its_faces():
    spatial = pytest.importorskip("scipy.spatial")
    hulls = pc.coarsen(STAIRS, 1)
    expected = spatial.ConvexHull(STAIRS.mesh().vertices).volume
    assert hulls.cells[0].volume == pytest.approx(expected, rel=1e-9)
    assert hulls.excess == pytest.approx(expected / STAIRS.volume - 1, rel=1e-9)


def test_a_limit_of_the_excess_is_kept():
    solid = STAIRS | pc.sphere(1, 12).translate([0, 3, 0])
    counts = []
    for most in (1.0, 0.2, 0.05):
        hulls = pc.coarsen(solid, max_excess=most)
        assert hulls.excess <= most
        counts.append(len(hulls))
    assert counts == sorted(counts) and counts[0] < counts[-1]


def test_without_limits_nothing_is_added():
    hulls = pc.coarsen(STAIRS)
    assert hulls.excess == pytest.approx(0, abs=1e-12) and len(hulls) == 4


@pytest.mark.parametrize("most", [8, 12])
def test_limits_of_vertices_and_faces_are_kept(most):
    solid = pc.sphere(1, 16) | pc.sphere(1, 16).translate([1, 1, 0])
    points = samples(solid, generator())
    for limits in ({"max_vertices": most}, {"max_faces": most}, {"max_vertices": most, "max_faces": most}):
        hulls = pc.coarsen(solid, 2, **limits)
        assert all(len(cell.vertices) <= limits.get("max_vertices", 1000) for cell in hulls.cells)
        assert all(len(cell.planes) <= limits.get("max_faces", 1000) for cell in hulls.cells)
        assert are_held(hulls.cells, points, 1e-12).all()


def test_what_is_to_be_kept_clear_stays_clear():
    door = pc.box([1, -1, 0], [2, 1, 2])
    wall = pc.box([0, -0.1, 0], [3, 0.1, 3]) - door
    assert pc.coarsen(wall, 1).excess > 0.1
    hulls = pc.coarsen(wall, 3, keep_clear=door)
    inside = pc.union([pc.hull(cell.vertices) for cell in hulls.cells]) & door
    assert inside.volume == pytest.approx(0, abs=1e-9)


def test_inner_cells_are_within_the_solid():
    hulls = pc.coarsen(STAIRS, 3, inner=True)
    assert not hulls.encloses and hulls.excess <= 0
    outside = pc.union([pc.hull(cell.vertices) for cell in hulls.cells]) - STAIRS
    assert outside.volume == pytest.approx(0, abs=1e-9)


def test_materials_stay_apart():
    a, b = pc.box([0, 0, 0], [1, 1, 1], "clay"), pc.box([1, 0, 0], [2, 1, 1], "steel")
    assert len(pc.coarsen(a | b)) == 1
    cells = pc.coarsen(a | b, by_material=True).cells
    assert sorted(cell.material for cell in cells) == ["clay", "steel"]


def test_solids_meshes_and_lists_of_hulls_are_taken():
    cells = STAIRS.cells()
    pairs = [(cell.vertices, cell.triangles) for cell in cells]
    for subject in (STAIRS, STAIRS.mesh(), cells, tuple(cells), pairs, [list(pair) for pair in pairs], [cell.vertices for cell in cells]):
        hulls = pc.coarsen(subject, 1)
        assert hulls.excess == pytest.approx(pc.coarsen(STAIRS, 1).excess, rel=1e-9)


def test_an_open_mesh_becomes_a_shell_and_that_is_told():
    box = pc.box([0, 0, 0], [4, 4, 4]).mesh()
    is_top = (box.vertices[box.triangles][:, :, 2] == 4).all(axis=1)
    opened = pc.Mesh(box.vertices, box.triangles[~is_top])
    with pytest.warns(UserWarning, match="shell"):
        hulls = pc.coarsen(opened, 8)
    assert hulls.enclosed == "shell" and hulls.thickness > 0
    assert are_held(hulls.cells, np.array(opened.vertices), 1e-12).all()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert pc.coarsen(opened, 1, surface="filled").enclosed == "filled"
        assert pc.coarsen(opened, 8, surface="shell", min_thickness=0.25).thickness == 0.25


def test_limits_of_engines_are_kept():
    solid = pc.sphere(1, 64)
    counts = {engine: max(len(cell.vertices) for cell in pc.coarsen(solid, 1, engine=engine).cells) for engine in ("physx", "jolt", "bullet", "mujoco", "unity")}
    free = len(pc.coarsen(solid, 1).cells[0].vertices)
    assert all(count <= free for count in counts.values()) and counts["physx"] <= 64 < free


def test_cells_are_the_same_for_any_number_of_threads():
    solid = some_solid(1)
    one, two = (pc.coarsen(solid, 3, threads=threads) for threads in (1, 2))
    assert [cell.vertices.tobytes() for cell in one.cells] == [cell.vertices.tobytes() for cell in two.cells]


SHARP = [
    [-1.0, 0.7652830942819201, -0.5292270989851957, 0.6340175954080617],
    [-0.9846465690584575, 1.0, -0.7284653770279207, 0.5779568511584863],
    [1.0, -0.885860338207066, 0.722293814769919, -0.44560426620787413],
    [-1.0, 0.9115401375722182, -0.940508156478662, 0.3960929920405965],
]
"""A tetrahedron with sharp edges, found in a decomposition of random bodies."""


CAPPED = {"max_vertices": 8}


@pytest.mark.parametrize("limits", [{}, CAPPED], ids=repr)
def test_a_sharp_cell_is_written_as_it_is(limits):
    solid = pc.halfspaces(SHARP)
    hulls = pc.coarsen(solid, 1, **limits)
    written = pc.hull(hulls.cells[0].vertices).volume
    assert outside(hulls.cells[0]) < 1e-9
    assert hulls.excess == pytest.approx(written / solid.volume - 1, abs=1e-9)


def test_run_coacd_gives_what_coacd_gives():
    mesh = STAIRS.mesh()
    parts = pc.compat.run_coacd(mesh.vertices, mesh.triangles, threshold=0.01)
    assert isinstance(parts, list) and len(parts) > 1
    for vertices, triangles in parts:
        assert vertices.dtype == np.float64 and triangles.dtype == np.int32 and vertices.flags.writeable
        assert pc.Mesh(vertices, triangles).is_watertight
    assert len(pc.compat.run_coacd(mesh.vertices, mesh.triangles, max_convex_hull=2)) <= 2
    assert len(pc.compat.run_coacd(mesh.vertices, mesh.triangles, max_convex_hull=1)) == 1
    with pytest.warns(UserWarning, match="mcts_nodes"):
        pc.compat.run_coacd(mesh.vertices, mesh.triangles, mcts_nodes=3)


def test_hulls_of_coacd_are_merged():
    path = data("convex", "coacd")
    files = sorted(path.glob("*.obj"), key=lambda file: file.stat().st_size)
    trimesh = pytest.importorskip("trimesh")
    parts = trimesh.load(files[0], split_object=True, group_material=False)
    hulls = [np.asarray(part.vertices) for part in parts.geometry.values()] if hasattr(parts, "geometry") else [np.asarray(parts.vertices)]
    merged = pc.coarsen(hulls, max(1, len(hulls) // 2))
    assert len(merged) <= max(1, len(hulls) // 2)
    assert are_held(merged.cells, np.concatenate(hulls), 1e-9).all()


@pytest.mark.parametrize(("most", "coacd"), [(16, 0.0364), (32, 0.0090), (64, 0.0090)])
def test_a_torus_grows_by_no_more_than_with_coacd(most, coacd):
    """What CoACD 1.0.14 adds at the same numbers of hulls, as manifold3d measures it (`bench/coarsen`)."""
    cells = pc.coarsen(pc.load(data("mesh/vhacd/torus1.obj")), max_cells=most)
    assert len(cells) <= most and cells.excess < coacd
