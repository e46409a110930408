"""Live models: after each edit they are what a fresh evaluation gives."""

from __future__ import annotations

import math
import pickle

import numpy as np
import planecut as pc
import pytest
from oracles import first_hits, generator, mesh_area, mesh_volume, random_affine

ROLES = ["add", "subtract", "intersect"]


def start() -> pc.Live:
    return pc.Live(pc.box([0, 0, 0], [4, 4, 4], "clay") - pc.box([1, 1, 1], [2, 2, 5]))


def state(live: pc.Live) -> tuple:
    """All that can be seen of a model, in bytes."""
    mesh = live.mesh()
    arrays = [getattr(mesh, name).tobytes() for name in ("vertices", "triangles", "face_ids", "face_normals")]
    # materials that are used no more stay known
    names = tuple(mesh.materials[number] for number in mesh.material_ids)
    brushes = {int(brush): (live.role(brush), tuple(live.planes(brush).values())) for brush in live.brushes}
    return (arrays, names, brushes, live.volume)


def faces_of(live: pc.Live) -> dict[int, tuple]:
    """What each face is."""
    faces = {}
    for number in live.faces.tolist():
        face = live.face(number)
        faces[number] = (face.vertices.tobytes(), face.triangles.tobytes(), face.material, face.brush, face.plane)
    return faces


def translation(by: list[float]) -> np.ndarray:
    return np.hstack([np.eye(3), np.reshape(by, (3, 1))])


def assert_is_fresh(live: pc.Live) -> None:
    """The model is what a fresh evaluation of the same solid gives, byte for byte."""
    found, expected = live.mesh(), live.to_solid().mesh()
    for name in ("vertices", "triangles", "face_ids", "face_normals"):
        assert getattr(found, name).tobytes() == getattr(expected, name).tobytes(), name
    names = [np.array([*mesh.materials, ""])[mesh.material_ids] for mesh in (found, expected)]
    np.testing.assert_array_equal(*names)
    assert found.check() == []
    assert live.volume == pytest.approx(live.to_solid().volume, rel=1e-9, abs=1e-9)


def assert_change_is_right(live: pc.Live, before: dict[int, tuple], after: dict[int, tuple]) -> None:
    removed, added = set(live.change.removed), set(live.change.added)
    assert removed <= set(before) and added <= set(after)
    assert set(before) - removed == set(after) - added, "faces that are not told of stay"
    stay = set(before) - removed
    assert {number: before[number][:3] for number in stay} == {number: after[number][:3] for number in stay}


def some_body(rng) -> pc.Solid:
    return pc.hull(rng.normal(size=(8, 3)) + rng.uniform(0, 4, 3)) if rng.random() < 0.5 else pc.box(low := rng.integers(-1, 4, 3), low + rng.integers(1, 4, 3))


def random_call(rng, live: pc.Live, e: pc.Edit) -> None:
    brushes = live.brushes.tolist()
    brush = int(rng.choice(brushes)) if brushes else 0
    planes = live.planes(brush) if brushes else {}
    what = rng.integers(9) if brushes else 0
    if what in (0, 1):
        number = e.add_brush(some_body(rng), role=str(rng.choice(ROLES, p=[0.6, 0.37, 0.03])))
        assert number in live.brushes and number not in brushes
    elif what in (2, 3):
        plane = int(rng.choice(list(planes)))
        offset = planes[plane][3] + float(rng.normal() * 0.5)
        e.move_plane(brush, plane, offset)
        assert live.planes(brush)[plane][3] == offset
    elif what == 4:
        corner = np.mean([live.face(face).vertices.mean(axis=0) for face in live.faces.tolist()] or [[0, 0, 0]], axis=0)
        normal = rng.normal(size=3)
        plane = e.add_plane(brush, [*normal, float(normal @ corner + 0.5)], str(rng.choice(["clay", "steel"])))
        assert plane in live.planes(brush) and plane not in planes
    elif what == 5 and len(planes) > 6:
        e.remove_plane(brush, int(rng.choice(list(planes))))
    elif what == 6:
        e.transform_brush(brush, random_affine(rng))
        assert list(live.planes(brush)) == list(planes)
    elif what == 7 and len(brushes) > 3:
        e.remove_brush(brush)
        assert brush not in live.brushes
    elif rng.random() < 0.5:
        e.replace_brush(brush, some_body(rng))
    else:
        e.set_role(brush, str(rng.choice(ROLES, p=[0.65, 0.33, 0.02])))
        # where it has that role, nothing has changed, and that alone would be no step
        plane, (*_, offset) = next(iter(planes.items()))
        e.move_plane(brush, plane, offset + float(rng.normal() * 0.1))


def test_a_step_that_changes_nothing_is_none() -> None:
    live = pc.Live(pc.box([0, 0, 0], [1, 1, 1]))
    with live.edit() as e:
        e.set_role(0, "add")
    with live.edit() as e:
        e.move_plane(0, 0, 2)
        e.move_plane(0, 0, live.planes(0)[0][3] - 1)
    with pytest.raises(pc.PlanecutError):
        live.undo()


@pytest.mark.parametrize("case", range(10))
def test_random_edits_give_what_a_fresh_evaluation_gives_and_can_be_undone(case):
    rng = generator(case)
    live = start()
    states, refused = [state(live)], 0
    faces = faces_of(live)
    for _ in range(12):
        try:
            with live.edit() as e:
                for _ in range(int(rng.integers(1, 4))):
                    random_call(rng, live, e)
        except pc.PlanecutError as error:
            # such as a brush that became unbounded
            refused += 1
            assert "\n" not in str(error)
            assert state(live) == states[-1]
            faces = faces_of(live)
            continue
        now = faces_of(live)
        assert_change_is_right(live, faces, now)
        assert_is_fresh(live)
        faces = now
        states.append(state(live))
    print(f"{len(states) - 1} edits, {refused} refused, volumes {[round(state[-1], 3) for state in states]}")
    assert len(states) > 4 and len({state[-1] for state in states}) > 3
    for direction, others in ((live.undo, states[-2::-1]), (live.redo, states[1:])):
        for expected in others:
            direction()
            now = faces_of(live)
            assert_change_is_right(live, faces, now)
            faces = now
            assert state(live) == expected
        with pytest.raises(pc.PlanecutError):
            direction()


def test_many_calls_are_one_step():
    live = start()
    before = live.volume
    with live.edit() as e:
        for k in range(5):
            e.add_brush(pc.box([10 * k + 10, 0, 0], [10 * k + 11, 1, 1]))
        e.move_plane(0, 0, 5.0)
    assert live.volume == before + 5 + 4 * 4
    live.undo()
    assert live.volume == before and len(live.brushes) == 2
    live.redo()
    assert live.volume == before + 5 + 4 * 4 and len(live.brushes) == 7


def test_an_edit_without_calls_is_no_step():
    live = start()
    with live.edit():
        pass
    with pytest.raises(pc.PlanecutError, match="nothing"):
        live.undo()


def test_a_new_edit_forgets_what_was_undone():
    live = start()
    with live.edit() as e:
        e.move_plane(0, 0, 5.0)
    live.undo()
    with live.edit() as e:
        e.move_plane(0, 0, 6.0)
    with pytest.raises(pc.PlanecutError, match="nothing"):
        live.redo()


@pytest.mark.parametrize("error", [RuntimeError("mine"), KeyboardInterrupt(), GeneratorExit()], ids=repr)
def test_an_exception_takes_back_all_of_the_edit_and_comes_out(error):
    live = start()
    with live.edit() as e:
        e.move_plane(0, 0, 5.0)
    before, faces = state(live), faces_of(live)
    with pytest.raises(type(error)) as found:
        with live.edit() as e:
            e.remove_brush(1)
            brush = e.add_brush(pc.sphere(1, 8))
            e.transform_brush(brush, np.diag([1.0, 2, 3, 1]))
            e.remove_brush(0)
            raise error
    assert found.value is error
    assert state(live) == before and len(faces_of(live)) == len(faces)
    assert_is_fresh(live)
    live.undo()
    assert state(live) == state(start())


def test_calls_out_of_an_edit_are_refused():
    live = start()
    with live.edit() as e:
        e.move_plane(0, 0, 5.0)
        for work in (live.undo, live.redo, lambda: live.edit().__enter__()):
            with pytest.raises(pc.PlanecutError, match="not complete"):
                work()
    before = state(live)
    for work in (lambda: e.move_plane(0, 0, 6.0), lambda: live.edit().remove_brush(0)):
        with pytest.raises(pc.PlanecutError, match="over"):
            work()
    assert state(live) == before


def test_an_edit_can_be_seen_while_it_is_made():
    live = start()
    with live.edit() as e:
        e.move_plane(0, 0, 5.0)
        assert live.volume == start().volume + 16
        brush = e.add_brush(pc.box([9, 9, 9], [10, 10, 10]))
        assert live.role(brush) == "add" and live.volume == start().volume + 17


@pytest.mark.parametrize("case", range(6))
def test_faces_lie_on_the_planes_that_they_name(case):
    rng = generator(case)
    live = start()
    with live.edit() as e:
        for role in ("add", "subtract", "add"):
            e.add_brush(some_body(rng), role)
    area, vertices = 0.0, []
    for number in live.faces.tolist():
        face = live.face(number)
        *normal, offset = live.planes(face.brush)[face.plane]
        length = np.linalg.norm(normal)
        np.testing.assert_allclose(face.vertices @ normal / length, offset / length, atol=1e-9)
        sign = -1.0 if live.role(face.brush) == "subtract" else 1.0
        np.testing.assert_allclose(face.normal, sign * np.array(normal) / length, atol=1e-12)
        a, b, c = (face.vertices[face.triangles[:, k]] for k in range(3))
        assert (np.cross(b - a, c - a) @ face.normal >= -1e-12).all()
        assert sorted(np.unique(face.triangles)) == list(range(len(face.vertices)))
        area += mesh_area(face.vertices, face.triangles)
        vertices.append(face.vertices[face.triangles].reshape(-1, 3))
    soup = np.concatenate(vertices)
    assert area == pytest.approx(live.to_solid().area, rel=1e-9)
    assert mesh_volume(soup, np.arange(len(soup)).reshape(-1, 3)) == pytest.approx(live.volume, rel=1e-9)


@pytest.mark.parametrize("case", range(8))
def test_rays_pick_the_face_that_brute_force_finds(case):
    rng = generator(case)
    live = start()
    with live.edit() as e:
        for _ in range(3):
            e.add_brush(some_body(rng), str(rng.choice(["add", "subtract"])))
    corners, owners = [], []
    for number in live.faces.tolist():
        face = live.face(number)
        corners.append(face.vertices[face.triangles].reshape(-1, 3))
        owners += [number] * len(face.triangles)
    soup = np.concatenate(corners)
    origins = rng.uniform(-4, 8, (150, 3))
    directions = (rng.uniform(0, 4, (150, 3)) - origins) * rng.uniform(0.01, 100, (150, 1))
    distances, triangles = first_hits(soup, np.arange(len(soup)).reshape(-1, 3), origins, directions)
    agree, hits = 0, 0
    for origin, direction, distance, triangle in zip(origins, directions, distances, triangles):
        found = live.pick(origin, direction)
        if found is None or not np.isfinite(distance):
            agree += found is None and not np.isfinite(distance)
            continue
        hits += 1
        assert isinstance(found[0], int) and isinstance(found[1], float)
        agree += found[0] == owners[triangle] and abs(found[1] - distance) < 1e-7
    # a ray may pass an edge on either side
    assert agree >= 0.99 * len(origins) and hits > 20
    expected = live.to_solid().ray_cast(origins, directions)
    picked = [np.inf if (found := live.pick(o, d)) is None else found[1] for o, d in zip(origins, directions)]
    assert np.isclose(picked, expected, rtol=1e-9, atol=1e-9, equal_nan=True).mean() >= 0.99


def test_rays_miss_triangles_that_are_nearly_points():
    rng = np.random.default_rng([6, 7])
    live = start()
    with live.edit() as e:
        for _ in range(3):
            e.add_brush(some_body(rng), str(rng.choice(["add", "subtract"])))
    origins = rng.uniform(-4, 8, (150, 3))
    directions = rng.uniform(0, 4, (150, 3)) - origins
    picks = [live.pick(origin, direction) for origin, direction in zip(origins, directions)]
    for origin, direction, pick in zip(origins, directions, picks):
        if pick is not None:
            face = live.face(pick[0])
            at = origin + direction / np.linalg.norm(direction) * pick[1]
            assert abs((at - face.vertices[0]) @ face.normal) < 1e-6, "where it meets a face, it meets its plane"


def test_roles_do_what_operators_do():
    a, b = pc.box([0, 0, 0], [2, 2, 2]), pc.box([1, 1, 1], [3, 3, 3])
    for role, expected in (("add", a | b), ("subtract", a - b), ("intersect", a & b)):
        live = pc.Live(a)
        with live.edit() as e:
            brush = e.add_brush(b, role)
        assert live.role(brush) == role and live.volume == expected.volume
        assert pc.Live(expected).volume == expected.volume
        with live.edit() as e:
            e.set_role(brush, "add")
        assert live.volume == (a | b).volume


def test_closed_meshes_are_brushes_too():
    torus = pc.torus(2, 0.5, 8, 6).mesh()
    body = pc.from_mesh(torus.vertices, torus.triangles)
    live = pc.Live(pc.box([-4, -4, -4], [4, 4, 0]))
    with live.edit() as e:
        e.add_brush(body, "subtract")
    assert live.volume == pytest.approx((pc.box([-4, -4, -4], [4, 4, 0]) - body).volume, rel=1e-12)
    assert_is_fresh(live)
    live.undo()
    assert live.volume == 8 * 8 * 4


def test_materials_of_planes_and_brushes_are_kept():
    live = pc.Live(pc.box([0, 0, 0], [2, 2, 2], "clay"))
    with live.edit() as e:
        cut = e.add_plane(0, [1, 1, 1, 4], "gold")
        e.add_brush(pc.box([5, 0, 0], [6, 1, 1], "steel"))
    materials = {live.face(number).material for number in live.faces.tolist()}
    assert materials == {"clay", "gold", "steel"}
    assert [live.face(n).material for n in live.faces.tolist() if (live.face(n).brush, live.face(n).plane) == (0, cut)] == ["gold"]


def test_a_solid_does_not_change_with_the_live_model_of_it():
    solid = pc.box([0, 0, 0], [1, 1, 1])
    live = pc.Live(solid)
    before = live.to_solid()
    mesh = live.mesh()
    with live.edit() as e:
        e.move_plane(0, 0, 2.0)
    assert (solid.volume, before.volume, mesh.volume, live.volume) == (1.0, 1.0, 1.0, 2.0)


@pytest.mark.parametrize("case", range(6))
def test_measures_follow_each_edit(case):
    rng = generator(case)
    live = start()
    for step in range(12):
        with live.edit() as e:
            e.add_brush(some_body(rng), str(rng.choice(["add", "subtract"])))
            if step % 3 == 2:
                e.remove_brush(int(rng.choice(live.brushes)))
        if step % 4 == 1:
            live.undo()
        soup, areas = [], {}
        for face in map(live.face, live.faces.tolist()):
            soup.append(face.vertices[face.triangles].reshape(-1, 3))
            areas[face.material] = areas.get(face.material, 0.0) + mesh_area(face.vertices, face.triangles)
        soup = np.concatenate(soup)
        triangles = np.arange(len(soup)).reshape(-1, 3)
        assert live.volume == pytest.approx(mesh_volume(soup, triangles), rel=1e-9)
        assert live.area == pytest.approx(mesh_area(soup, triangles), rel=1e-9)
        assert live.areas == pytest.approx(areas, rel=1e-9)
        np.testing.assert_array_equal(live.bounds, [soup.min(axis=0), soup.max(axis=0)])
        corners = soup.reshape(-1, 3, 3)
        weights = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        np.testing.assert_allclose(live.centroid, weights @ corners.sum(axis=1) / 4 / weights.sum(), rtol=1e-9, atol=1e-9)
        new = pc.Live(live.to_solid())
        assert (live.volume, live.area, live.areas) == (new.volume, new.area, new.areas)
        assert (live.centroid.tobytes(), live.bounds.tobytes()) == (new.centroid.tobytes(), new.bounds.tobytes())


def test_an_empty_model_has_measures():
    live = start()
    with live.edit() as e:
        e.remove_brush(0)
    assert (live.volume, live.area, live.areas, live.volumes) == (0, 0, {}, {})
    assert np.isnan(live.centroid).all() and live.centroid.shape == (3,)
    assert np.isnan(live.bounds).all() and live.bounds.shape == (2, 3)


def test_a_viewer_needs_the_buffers_of_added_faces_alone():
    rng = generator(3)
    live = start()
    center = np.array([2.0, 1.0, 0.5])
    first = live.buffers(live.faces, center)
    assert first.materials == [live.face(number).material for number in first.faces.tolist()]
    drawn = dict(zip(first.faces.tolist(), pieces(first), strict=True))
    for _ in range(8):
        with live.edit() as e:
            e.add_brush(some_body(rng), str(rng.choice(["add", "subtract"])))
        for number in live.change.removed:
            del drawn[number]
        added = live.buffers(live.change.added, center)
        assert added.faces.tolist() == live.change.added
        drawn.update(zip(live.change.added, pieces(added), strict=True))
    assert sorted(drawn) == sorted(live.faces.tolist())
    for number, (positions, normals, indices) in drawn.items():
        face = live.face(number)
        alone = face.buffers(center)
        for found, expected in zip((positions, normals[0], indices), alone, strict=True):
            assert found.dtype == expected.dtype and not expected.flags.writeable
            np.testing.assert_array_equal(found, expected)
        assert (normals == normals[0]).all() and [array.dtype for array in alone] == [np.float32, np.float32, np.uint32]
        np.testing.assert_allclose(positions[indices], (face.vertices - center)[face.triangles], atol=1e-6)
        np.testing.assert_allclose(normals[0], face.normal, atol=1e-6)


def pieces(buffers: pc.Buffers) -> list[tuple]:
    """Positions, normals and indices of each face by itself."""
    arrays = buffers.positions, buffers.normals, buffers.indices
    assert [(array.dtype.name, array.flags.writeable) for array in arrays] == [("float32", False), ("float32", False), ("uint32", False)]
    assert buffers.vertex_starts[-1] == len(buffers.positions) and buffers.index_starts[-1] == len(buffers.indices)
    result = []
    for k in range(len(buffers.faces)):
        own = slice(buffers.vertex_starts[k], buffers.vertex_starts[k + 1])
        triangles = buffers.indices[buffers.index_starts[k] : buffers.index_starts[k + 1]] - buffers.vertex_starts[k]
        result.append((buffers.positions[own], buffers.normals[own], triangles))
    return result


def test_buffers_are_of_faces_that_are_there():
    live = start()
    with pytest.raises(pc.PlanecutError, match="faces: found 4711"):
        live.buffers([4711])
    with pytest.raises(pc.PlanecutError, match="faces: found -1"):
        live.buffers([-1])
    with pytest.raises(pc.PlanecutError, match="center"):
        live.buffers([], [1, 2])
    nothing = live.buffers([])
    assert nothing.positions.shape == (0, 3) and nothing.indices.shape == (0, 3) and nothing.vertex_starts.tolist() == [0]
    buffers = live.buffers(live.faces.tolist())
    again = pickle.loads(pickle.dumps(buffers))
    for name in ("positions", "normals", "indices", "faces", "vertex_starts", "index_starts"):
        np.testing.assert_array_equal(getattr(again, name), getattr(buffers, name))
    assert again.materials == buffers.materials and repr(again) == repr(buffers)


def test_rays_through_corners_and_along_faces_meet_what_is_there():
    live = start()
    assert live.pick([-1, -1, 9], [0, 0, -1]) is None
    assert live.pick([4, 4, 9], [0, 0, -1])[1] == 5
    assert live.pick([0.5, 0.5, 2], [0, 0, 1])[1] == 2
    assert live.pick([0.5, 0.5, 4], [0, 0, 1])[1] == 0
    number, distance = live.pick([1.5, 1.5, 9], [0, 0, -1e-200])
    assert distance == 8 and live.face(number).normal.tolist() == [0, 0, 1]


def test_planes_turn_materials_and_names_change_and_brushes_are_copied():
    live = pc.Live(pc.box([0, 0, 0], [1, 1, 1], material="stone"))
    with live.edit() as e:
        # the plane x = 1 becomes one through the edges at (0, y, 1) and (1, y, 0)
        top = next(plane for plane, (x, *_) in live.planes(0).items() if x > 0)
        e.turn_plane(0, top, [1, 0, 1, 1])
        e.set_material(0, "steel", top)
        e.rename_brush(0, "wedge")
    assert live.volume == 0.5
    assert set(live.areas) == {"stone", "steel"}
    # all but one of its faces are of stone
    assert live.volumes == {"stone": 0.5}
    assert math.isclose(live.areas["steel"], math.sqrt(2), rel_tol=1e-15)
    with live.edit() as e:
        (copy,) = e.copy_brushes([0], translation([2, 0, 0]))
        (mirrored,) = e.mirror_brushes([0], [1, 0, 0, -1])
        row = e.array_brushes([copy, mirrored], translation([0, 3, 0]), 2)
    assert len({0, copy, mirrored, *row}) == len(live.brushes) == 7
    assert math.isclose(live.volume, 7 * 0.5, rel_tol=1e-15)
    assert live.bounds.tolist() == [[-3, 0, 0], [3, 7, 1]]
    live.undo()
    assert live.volume == 0.5


def test_a_plane_snaps_to_planes_corners_and_a_grid():
    live = pc.Live(pc.box([0, 0, 0], [1, 1, 1]) | pc.box([2.2, 0, 0], [3, 1, 1]))
    right = next(plane for plane, (x, *_) in live.planes(0).items() if x > 0)
    plane, target, distance = live.snap(0, right, [1, 0, 0, 2.1], planes=0.25)
    assert (plane.tolist(), target) == ([1, 0, 0, 2.2], "plane")
    assert math.isclose(distance, 0.1, rel_tol=1e-12)
    assert live.snap(0, right, [1, 0, 0, 1.7], planes=0.25) is None
    plane, target, _ = live.snap(0, right, [1, 0, 0, 1.7], planes=0.25, grid=0.5)
    assert (plane.tolist(), target) == ([1, 0, 0, 1.5], "grid")
    with live.edit() as e:
        e.turn_plane(0, right, plane)
    assert math.isclose(live.volume, 2.3, rel_tol=1e-15)
    with pytest.raises(pc.PlanecutError):
        live.snap(0, 99, [1, 0, 0, 1])
