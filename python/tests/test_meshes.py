"""Meshes: views of memory that Rust owns, files, and the meshes of other packages."""

from __future__ import annotations

import copy
import gc
import json
import pickle
import re
import subprocess
import sys
import warnings
import zipfile
from pathlib import Path

import numpy as np
import planecut as pc
import pytest
from oracles import Tree, data, generator, is_closed, mesh_volume, raised

VIEWS = ["vertices", "triangles", "face_ids", "material_ids"]
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def some_solid(number: int = 0) -> pc.Solid:
    return Tree(generator(number), 6).solid() | pc.box([-1, -1, -1], [1, 1, 1], material="clay")


def owners() -> list[tuple[object, str]]:
    """Objects, and the names of their arrays that are views."""
    solid = some_solid()
    mesh, cell, face = solid.mesh(), solid.cells()[0], pc.Live(solid).face(0)
    of_mesh = [(mesh, name) for name in VIEWS]
    return of_mesh + [(cell, name) for name in ("planes", "vertices", "triangles")] + [(face, name) for name in ("vertices", "triangles")]


# ---- memory


def test_arrays_have_the_shapes_and_types_that_are_documented():
    mesh = some_solid().mesh()
    count = len(mesh.triangles)
    for name, dtype, shape in [
        ("vertices", np.float64, (len(mesh.vertices), 3)),
        ("triangles", np.uint32, (count, 3)),
        ("face_ids", np.uint32, (count,)),
        ("material_ids", np.uint32, (count,)),
        ("face_normals", np.float64, (int(mesh.face_ids.max()) + 1, 3)),
    ]:
        array = getattr(mesh, name)
        assert (array.dtype, array.shape) == (dtype, shape), name
        assert array.flags.c_contiguous and array.flags.aligned
    assert mesh.materials and all(isinstance(name, str) for name in mesh.materials)
    assert mesh.material_ids.max() < len(mesh.materials) and mesh.triangles.max() < len(mesh.vertices)


def test_views_share_the_memory_of_their_owner():
    for owner, name in owners():
        first, second = getattr(owner, name), getattr(owner, name)
        assert first is not second
        assert first.ctypes.data == second.ctypes.data and np.shares_memory(first, second), name
        assert not first.flags.owndata and first.base is not None


def test_the_mesh_of_a_solid_is_made_once():
    solid = some_solid()
    assert solid.mesh().vertices.ctypes.data == solid.mesh().vertices.ctypes.data
    again = copy.copy(solid)
    assert again.mesh().vertices.ctypes.data == solid.mesh().vertices.ctypes.data


def test_no_array_can_be_written_to():
    extra = [(pc.Polytope([[1, 0, 0, 1]]), "planes"), (pc.Polytope([[1, 0, 0, 1]]), "plane_ids"), (some_solid(), "bounds"), (some_solid(), "centroid")]
    live = pc.Live(some_solid())
    extra += [(some_solid().mesh(), "face_normals"), (live, "faces"), (live, "brushes"), (live.face(0), "normal")]
    for owner, name in owners():
        array = getattr(owner, name)
        assert not array.flags.writeable, name
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True
        with pytest.raises(ValueError, match="WRITEABLE"):
            array[:1].flags.writeable = True
    for owner, name in extra:
        with pytest.raises(ValueError, match="read-only"):
            getattr(owner, name)[...] = 0


def test_arrays_outlive_their_mesh_and_solid():
    solid = some_solid()
    mesh = solid.mesh()
    kept = {name: (getattr(mesh, name), getattr(mesh, name).copy()) for name in VIEWS}
    part = mesh.vertices[2:5]
    of_part = part.copy()
    del mesh, solid
    gc.collect()
    # what was freed would be used by these
    others = [some_solid(number).mesh() for number in range(1, 30)]
    for name, (view, values) in kept.items():
        np.testing.assert_array_equal(view, values, name)
    np.testing.assert_array_equal(part, of_part)
    assert len(others) == 29


def test_what_comes_in_is_copied():
    vertices, triangles = TETRAHEDRON[0].copy(), TETRAHEDRON[1].copy()
    mesh = pc.Mesh(vertices, triangles)
    solid = pc.from_mesh(vertices, triangles)
    before = mesh.volume
    vertices *= 5
    triangles[:] = 0
    assert mesh.volume == before == solid.volume
    np.testing.assert_array_equal(mesh.vertices, TETRAHEDRON[0])


# ---- checks


def test_a_sound_mesh_has_no_problems_and_a_broken_one_says_which():
    vertices, triangles = TETRAHEDRON
    sound = pc.Mesh(vertices, triangles)
    assert sound.check() == [] and sound.is_watertight
    assert sound.volume == pytest.approx(mesh_volume(vertices, triangles), rel=1e-15)
    opened = pc.Mesh(vertices, triangles[:-1])
    assert not opened.is_watertight and len(opened.check()) >= 1
    turned = pc.Mesh(vertices, np.vstack([triangles[:-1], triangles[-1:, ::-1]]))
    assert not turned.is_watertight and turned.check()
    assert pc.Mesh(vertices, triangles[:, ::-1]).volume == pytest.approx(-sound.volume)
    two = pc.Mesh(np.vstack([vertices, vertices + 0.1]), np.vstack([triangles, triangles + 4]))
    assert two.is_watertight and two.check(), "surfaces that cross are found"
    apart = pc.Mesh(np.vstack([vertices, vertices + 2]), np.vstack([triangles, triangles + 4]))
    assert apart.check() == []


def test_faces_are_planar_and_normals_point_out():
    mesh = some_solid().mesh()
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    is_wide = lengths > 1e-6
    of_face = mesh.face_normals[mesh.face_ids]
    np.testing.assert_allclose(np.linalg.norm(mesh.face_normals, axis=1), 1.0, rtol=1e-12)
    assert ((normals / np.where(lengths, lengths, 1)[:, None] * of_face).sum(axis=1)[is_wide] > 1 - 1e-9).all()
    for face in range(len(mesh.face_normals)):
        corners = mesh.vertices[mesh.triangles[mesh.face_ids == face]].reshape(-1, 3)
        assert np.ptp(corners @ mesh.face_normals[face]) < 1e-9


# ---- files


@pytest.mark.parametrize("ending", ["glb", "gltf", "obj", "stl", "ply"])
def test_meshes_come_back_from_files(tmp_path, ending):
    solid = some_solid()
    for number, source in enumerate((solid, solid.mesh())):
        path = tmp_path / f"{number}.{ending}"
        source.save(path, **({"scale": 1.0} if number else {}))
        loaded = pc.load(str(path))
        # STL, GLB and glTF keep single precision
        assert loaded.volume == pytest.approx(solid.volume, rel=1e-5), path
        np.testing.assert_allclose(loaded.bounds, solid.bounds, atol=1e-5)


def test_obj_keeps_doubles_and_materials(tmp_path):
    solid = some_solid()
    solid.save(tmp_path / "x.obj")
    loaded = pc.load(tmp_path / "x.obj")
    assert loaded.volume == pytest.approx(solid.volume, rel=1e-12)
    used = [{mesh.materials[number] for number in mesh.material_ids} for mesh in (loaded.mesh(), solid.mesh())]
    assert used[0] == used[1] >= {"clay"}


@pytest.mark.parametrize("ending", ["map", "csg"])
def test_convex_bodies_come_back_from_files(tmp_path, ending):
    solid = pc.box([-1, -1, -1], [3, 3, 3]) - pc.hull(generator().normal(size=(12, 3)))
    solid.save(tmp_path / f"x.{ending}")
    assert pc.load(tmp_path / f"x.{ending}").volume == pytest.approx(solid.volume, rel=1e-6)


@pytest.mark.parametrize("ending", ["glb", "gltf", "obj", "stl", "ply"])
def test_trimesh_reads_what_is_saved(tmp_path, ending):
    trimesh = pytest.importorskip("trimesh")
    solid = some_solid()
    solid.save(tmp_path / f"x.{ending}")
    mesh = trimesh.load(tmp_path / f"x.{ending}", force="mesh")
    assert mesh.volume == pytest.approx(solid.volume, rel=1e-5)


def test_3mf_is_a_package_with_a_model_that_holds_the_mesh(tmp_path):
    mesh = some_solid().mesh()
    mesh.save(tmp_path / "x.3mf")
    with zipfile.ZipFile(tmp_path / "x.3mf") as package:
        text = package.read("3D/3dmodel.model").decode()
    assert len(re.findall("<triangle ", text)) == len(mesh.triangles)
    assert len(re.findall("<vertex ", text)) == len(mesh.vertices)


def test_hulls_are_saved_each_as_one_mesh(tmp_path):
    hulls = pc.coarsen(some_solid(), max_cells=3)
    hulls.save(tmp_path / "x.obj")
    assert sum(line.startswith("o ") for line in (tmp_path / "x.obj").read_text().splitlines()) == len(hulls)


def test_a_model_file_takes_parameters(tmp_path):
    path = tmp_path / "x.json"
    path.write_text('{"planecut": 1, "parameters": {"width": 4}, "model": {"box": {"min": [0, 0, 0], "max": ["=width", 2, 3]}}}')
    assert pc.load(path).volume == pytest.approx(4 * 2 * 3)
    assert pc.load(path, width=7).volume == pytest.approx(7 * 2 * 3)
    assert pc.load(path, width=np.float32(7)).volume == pytest.approx(7 * 2 * 3)
    error = raised(lambda: pc.load(path, depth=1))
    assert isinstance(error, pc.PlanecutError) and "depth" in str(error)
    error = raised(lambda: pc.load(tmp_path / "absent.json"))
    assert isinstance(error, pc.PlanecutError) and error.path == str(tmp_path / "absent.json")


def test_errors_of_files_say_the_line(tmp_path):
    path = tmp_path / "x.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    error = raised(lambda: pc.load(path))
    assert isinstance(error, pc.PlanecutError)
    assert (error.path, error.line) == (str(path), 4)
    path = tmp_path / "y.json"
    path.write_text('{"planecut": 1,\n "model": {"box": {"min": [0, 0, 0], "max": [1, 2]}}}')
    error = raised(lambda: pc.load(path))
    assert isinstance(error, pc.PlanecutError) and (error.path, error.json_path) == (str(path), "$.model.box.max")


def test_maps_have_the_volumes_of_the_reference():
    reference = json.loads(data("map", "reference.json").read_text())
    small = [name for name, entry in reference.items() if "union_volume" in entry and entry["brushes"] < 200][:12]
    assert small
    for name in small:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            solid = pc.load(data("map", *name.split("/")), allow_loss=True)
        assert solid.volume == pytest.approx(reference[name]["union_volume"], rel=1e-9), name


# ---- other packages


def test_manifold3d_meshes_are_taken_with_merges_and_properties():
    manifold3d = pytest.importorskip("manifold3d")
    body = Tree(generator(), 5).manifold()
    # normals as properties split vertices along sharp edges: only the merge vectors close the mesh
    split = body.calculate_normals(0, 30.0)
    for mesh in (body.to_mesh64(), split.to_mesh64(), body.to_mesh()):
        tolerance = 1e-6 if isinstance(mesh, manifold3d.Mesh) else 1e-9
        assert pc.from_mesh(mesh).volume == pytest.approx(body.volume(), rel=tolerance)
    mesh = split.to_mesh64()
    assert np.asarray(mesh.vert_properties).shape[1] > 3 and len(mesh.merge_from_vert) > 0
    parts = pc.from_mesh(mesh.vert_properties, mesh.tri_verts, merge_from_vert=mesh.merge_from_vert, merge_to_vert=mesh.merge_to_vert)
    assert parts.volume == pytest.approx(body.volume(), rel=1e-9)


def test_manifold3d_takes_our_arrays():
    manifold3d = pytest.importorskip("manifold3d")
    solid = some_solid()
    mesh = solid.mesh()
    # its binding refuses arrays that are read-only
    body = manifold3d.Manifold(manifold3d.Mesh64(vert_properties=mesh.vertices.copy(), tri_verts=mesh.triangles.astype(np.uint64)))
    assert body.status() == manifold3d.Error.NoError
    assert body.volume() == pytest.approx(solid.volume, rel=1e-9)


def test_trimesh_goes_there_and_back():
    pytest.importorskip("trimesh")
    solid = some_solid()
    for mesh in (solid.to_trimesh(), solid.mesh().to_trimesh()):
        assert mesh.is_watertight and mesh.volume == pytest.approx(solid.volume, rel=1e-9)
        mesh.vertices[0] += 0.0  # its own, to be changed
        mesh.apply_translation([1, 0, 0])
        back = pc.from_trimesh(mesh, "steel")
        assert back.volume == pytest.approx(solid.volume, rel=1e-9)
        np.testing.assert_allclose(back.bounds, solid.translate([1, 0, 0]).bounds, atol=1e-9)
        assert back.mesh().materials == ["steel"]


@pytest.mark.parametrize("operation", ["union", "difference", "intersection"])
def test_the_engine_for_trimesh_agrees_with_manifold3d(operation):
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("manifold3d")
    trees = [Tree(generator(number), 1) for number in range(3)]
    meshes = [tree.solid().to_trimesh() for tree in trees]
    first, second, third = (tree.manifold() for tree in trees)
    expected = {"union": first + second + third, "difference": first - second - third, "intersection": first ^ second ^ third}[operation]
    found = pc.trimesh_engine(meshes, operation)
    assert isinstance(found, trimesh.Trimesh) and (found.is_watertight or len(found.faces) == 0)
    assert found.volume == pytest.approx(expected.volume(), rel=1e-9, abs=1e-9)
    # trimesh's own engine works in single precision
    other = getattr(trimesh.boolean, operation)(meshes, engine="manifold")
    assert found.volume == pytest.approx(other.volume, rel=1e-5)


def test_importing_planecut_imports_numpy_alone():
    code = "import sys, planecut; print([name for name in ('trimesh', 'scipy', 'manifold3d', 'ray', 'dask') if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=Path(__file__).parent).stdout.strip() == "[]"


def test_meshes_of_materials_keep_them():
    vertices, triangles = TETRAHEDRON
    mesh = pc.Mesh(vertices, triangles, materials=["a", "b"], material_ids=[0, 1, 1, 0])
    np.testing.assert_array_equal(mesh.material_ids, [0, 1, 1, 0])
    solid = pc.from_mesh(vertices, triangles, materials=["a", "b"], material_ids=[0, 1, 1, 0])
    out = solid.mesh()
    names = np.array(out.materials)[out.material_ids]
    areas = {name: 0.0 for name in "ab"}
    a, b, c = (out.vertices[out.triangles[:, k]] for k in range(3))
    for name, area in zip(names, np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2):
        areas[name] += area
    slanted = np.sqrt(3) / 2
    assert areas["a"] == pytest.approx(1.0) and areas["b"] == pytest.approx(0.5 + slanted)


def test_meshes_pickle_with_all_their_arrays():
    mesh = some_solid().mesh()
    for other in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh)):
        for name in [*VIEWS, "face_normals"]:
            assert getattr(other, name).tobytes() == getattr(mesh, name).tobytes(), name
        assert other.materials == mesh.materials and is_closed(other.triangles)
