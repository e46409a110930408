"""`trimesh_engine` in trimesh's table of engines: trimesh's own tests, and results compared with manifold3d's."""

import os
import subprocess
import sys
import tarfile
from pathlib import Path

import numpy as np
import planecut as pc
import pytest

trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")

GENERIC = '''
"""What trimesh's tests take from their module of this name, which the sources on PyPI leave out, as they do its models.

Two balls that overlap stand for ballA.off and ballB.off; what is true of them comes from manifold3d.
"""

import logging
import time

import manifold3d
import numpy as np
import planecut
import trimesh

log = logging.getLogger("trimesh")
all_dependencies = False

trimesh.boolean._engines = {
    "planecut": planecut.trimesh_engine,
    # what is asked without a name comes to us, too, and nothing comes to another engine
    None: planecut.trimesh_engine,
    "manifold": trimesh.boolean._engines["manifold"],
}
trimesh.boolean.engines_available = {"planecut", None}


def get_mesh(name):
    """Balls that overlap, the second one further along all axes."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    if name == "ballB.off":
        ball.apply_translation([0.6, 0.45, 0.5])
    return ball


def _volumes():
    made = [
        manifold3d.Manifold(manifold3d.Mesh64(np.array(ball.vertices), np.array(ball.faces, dtype=np.uint64)))
        for ball in (get_mesh("ballA.off"), get_mesh("ballB.off"))
    ]
    # in manifold3d ^ is the intersection
    results = {"difference": made[0] - made[1], "intersection": made[0] ^ made[1], "union": made[0] + made[1]}
    return {name: result.volume() for name, result in results.items()}


data = {"boolean": _volumes()}
'''


@pytest.fixture(scope="module")
def sources(request, tmp_path_factory):
    """The folder of the sources of the trimesh that is installed, fetched from PyPI once and kept in pytest's cache."""
    cache = getattr(request.config, "cache", None)
    folder = Path(cache.mkdir("trimesh")) if cache else tmp_path_factory.mktemp("trimesh")
    name = f"trimesh-{trimesh.__version__}"
    if not (folder / name).is_dir():
        command = [
            sys.executable,
            "-m",
            "pip",
            "download",
            "--quiet",
            "--disable-pip-version-check",
            "--no-binary",
            "trimesh",
            "--no-deps",
        ]
        try:
            done = subprocess.run(
                [*command, "--dest", folder, f"trimesh=={trimesh.__version__}"],
                capture_output=True,
                text=True,
                timeout=120,
            )
        except subprocess.TimeoutExpired:
            pytest.skip("the sources of trimesh cannot be fetched: PyPI does not answer")
        if done.returncode:
            pytest.skip(f"the sources of trimesh cannot be fetched: {done.stderr.strip().splitlines()[-1:]}")
        with tarfile.open(folder / f"{name}.tar.gz") as archive:
            archive.extractall(folder, filter="data") if hasattr(tarfile, "data_filter") else archive.extractall(folder)
    if not (folder / name / "tests" / "test_boolean.py").is_file():
        pytest.skip(f"the sources of {name} hold no tests/test_boolean.py")
    return folder / name


def test_trimesh_s_own_tests_pass_with_this_engine(sources, tmp_path):
    pytest.importorskip("manifold3d", reason="manifold3d is not installed: it says what is true")
    (tmp_path / "generic.py").write_text(GENERIC)
    (tmp_path / "test_boolean.py").write_bytes((sources / "tests" / "test_boolean.py").read_bytes())
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-rA", "test_boolean.py"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    for name in ("test_boolean", "test_boolean_no_volume", "test_multiple", "test_empty", "test_multiple_difference"):
        assert f"PASSED test_boolean.py::{name}" in done.stdout


@pytest.fixture
def engine(monkeypatch):
    """The engine by its name in trimesh's table."""
    monkeypatch.setitem(trimesh.boolean._engines, "planecut", pc.trimesh_engine)
    return "planecut"


def meshes():
    """Closed meshes that overlap, none of them convex but the last."""
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])
    torus = trimesh.creation.torus(1.0, 0.4, major_sections=24, minor_sections=12)
    other = torus.copy().apply_transform(turn).apply_translation([0.5, 0.1, 0.05])
    pipe = trimesh.creation.annulus(0.3, 0.7, 2.0, sections=24).apply_translation([0.2, 0.4, 0.1])
    return [torus, other, pipe, trimesh.creation.box([0.9, 1.3, 0.7], turn)]


def in_doubles(all_of, operation):
    """The same operation by manifold3d; trimesh's own engine for it goes through single precision."""
    import manifold3d

    types = {
        "union": manifold3d.OpType.Add,
        "difference": manifold3d.OpType.Subtract,
        "intersection": manifold3d.OpType.Intersect,
    }
    made = [
        manifold3d.Manifold(manifold3d.Mesh64(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.uint64)))
        for mesh in all_of
    ]
    return manifold3d.Manifold.batch_boolean(made, types[operation])


@pytest.mark.parametrize("operation", ["union", "difference", "intersection"])
def test_results_are_those_of_manifold(engine, operation):
    pytest.importorskip("manifold3d", reason="manifold3d is not installed")
    all_of = meshes()
    for count in (2, 3, 4):
        ours = getattr(trimesh.boolean, operation)(all_of[:count], engine=engine)
        theirs = in_doubles(all_of[:count], operation)
        assert ours.is_volume
        assert ours.volume == pytest.approx(theirs.volume(), rel=1e-10)
        assert ours.area == pytest.approx(theirs.surface_area(), rel=1e-10)
        assert ours.body_count == len(theirs.decompose())
        assert ours.euler_number == 2 * ours.body_count - 2 * sum(part.genus() for part in theirs.decompose())


def test_methods_of_meshes_take_the_engine(engine):
    a, b = meshes()[:2]
    assert a.union(b, engine=engine).volume + a.intersection(b, engine=engine).volume == pytest.approx(
        a.volume + b.volume, rel=1e-12
    )
    assert a.difference(b, engine=engine).volume + a.intersection(b, engine=engine).volume == pytest.approx(
        a.volume, rel=1e-12
    )


def test_one_mesh_and_many_give_a_mesh_of_ones_own(engine):
    box = trimesh.creation.box([1, 1, 1])
    result = trimesh.boolean.union([box], engine=engine)
    result.apply_translation([5, 0, 0])
    result.vertices[0] += 0.0
    assert box.bounds[1].tolist() == [0.5, 0.5, 0.5]
    row = [trimesh.creation.box([1, 1, 1]).apply_translation([0.75 * k, 0, 0]) for k in range(40)]
    assert trimesh.boolean.union(row, engine=engine).volume == pytest.approx(0.75 * 39 + 1)


def test_open_meshes_and_unknown_operations_are_refused(engine):
    box = trimesh.creation.box([1, 1, 1])
    lid_off = trimesh.Trimesh(box.vertices, box.faces[2:], process=False)
    with pytest.raises(pc.PlanecutError, match="no volume"):
        trimesh.boolean.union([box, lid_off], engine=engine)
    with pytest.raises(pc.PlanecutError, match="open|once|closed"):
        trimesh.boolean.union([box, lid_off], engine=engine, check_volume=False)
    with pytest.raises(pc.PlanecutError, match="operation"):
        pc.trimesh_engine([box], "xor")
    with pytest.raises(pc.PlanecutError, match="no meshes"):
        pc.trimesh_engine([], "union")


def test_importing_installs_nothing():
    code = (
        "import sys, planecut; assert 'trimesh' not in sys.modules; "
        "import trimesh; assert 'planecut' not in trimesh.boolean._engines"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_a_mesh_goes_there_and_back():
    for mesh in meshes():
        back = pc.from_trimesh(mesh).to_trimesh()
        assert back.is_volume
        assert back.volume == pytest.approx(mesh.volume, rel=1e-12)
        assert np.allclose(back.bounds, mesh.bounds)
        assert back.moment_inertia == pytest.approx(mesh.moment_inertia, rel=1e-9, abs=1e-12)
