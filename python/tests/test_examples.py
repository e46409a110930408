"""The examples, each run with small settings and checked against something that is not planecut."""

import importlib
import json
import struct
import sys
from fractions import Fraction
from math import atan, cos, degrees, fsum, hypot, radians, sin
from pathlib import Path

import numpy as np
import planecut as pc
import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"


@pytest.fixture(autouse=True)
def beside_the_examples(monkeypatch):
    """Examples are scripts: they find each other in their own folder."""
    monkeypatch.syspath_prepend(str(EXAMPLES))


def example(name):
    """An example as a module."""
    sys.modules.pop(name, None)
    return importlib.import_module(name)


def manifold_of(mesh):
    """The same mesh in manifold3d, which takes no arrays that are read-only."""
    manifold3d = pytest.importorskip("manifold3d")
    made = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.triangles.astype(np.uint64)))
    assert made.status() == manifold3d.Error.NoError
    return made


def png_size(path):
    """Width and height of a PNG file, by its header."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])


def glb_materials(path):
    """The materials by name, as a glTF file has them."""
    data = path.read_bytes()
    magic, _, _, length, kind = struct.unpack("<4sIII4s", data[:20])
    assert (magic, kind) == (b"glTF", b"JSON")
    return {material["name"]: material for material in json.loads(data[20 : 20 + length])["materials"]}


class TestCastle:
    """castle.py."""

    def test_a_castle_has_four_walls_that_are_alike(self, tmp_path):
        solid = example("castle").main(tmp_path, size=(320, 240))
        assert solid.mesh().check() == []
        assert png_size(tmp_path / "castle.png") == (320, 240)
        # the gate is in front; left of the middle is what is right of it
        left, right = solid & pc.halfspaces([[1, 0, 0, -1.6]]), solid & pc.halfspaces([[-1, 0, 0, -1.6]])
        assert left.bounds[:, 1:] == pytest.approx(right.bounds[:, 1:])
        assert np.abs(solid.bounds[:, :2]) == pytest.approx(np.full((2, 2), 14.0))


class TestTown:
    """town.py."""

    def test_a_town_is_one_watertight_solid_with_its_materials(self, tmp_path):
        town = example("town").main(tmp_path, blocks=3, size=(320, 200))
        mesh = town.mesh()
        assert mesh.is_watertight
        assert mesh.check() == []
        assert png_size(tmp_path / "town.png") == (320, 200)
        colors = sys.modules["castle"].COLORS
        for name, material in glb_materials(tmp_path / "town.glb").items():
            assert material["pbrMetallicRoughness"]["baseColorFactor"][:3] == pytest.approx(colors[name], abs=1e-6)

    def test_the_mesh_bounds_the_volume_that_manifold_finds(self, tmp_path):
        town = example("town").town(blocks=1)
        assert manifold_of(town.mesh()).volume() == pytest.approx(town.volume, rel=1e-12)

    def test_a_house_has_the_volume_of_its_parts(self):
        # without a roof that sticks out: walls less windows, counted by hand
        house = example("town").house(6.0, 7.0, 4.0, "plaster", "tiles")
        low, high = house.bounds
        assert low == pytest.approx([-3.5, -3.9, 0], abs=1e-12)
        assert high[2] == pytest.approx(4.0 + 6.0 * 0.45 + 0.6)


class TestGears:
    """gears.py."""

    def test_volumes_are_those_of_the_outlines(self, tmp_path):
        made = example("gears").main(tmp_path, module=1.5, family=(12, 20, 31), width=4.0)
        for teeth, solid, area in made:
            assert solid.volume == pytest.approx(area * 4.0, rel=1e-13), teeth
            assert manifold_of(solid.mesh()).volume() == pytest.approx(area * 4.0, rel=1e-12)
        assert png_size(tmp_path / "gears.png") == (1600, 640)

    @pytest.mark.parametrize("pressure_angle", [14.5, 20.0, 25.0])
    def test_pairs_turn_without_overlap_and_without_room(self, pressure_angle):
        gears = example("gears")
        pair = [
            (teeth, gears.gear(2.0, teeth, 1.0, pressure_angle=pressure_angle, backlash=0.1)[0]) for teeth in (24, 41)
        ]
        thick = [
            (teeth, gears.gear(2.0, teeth, 1.0, pressure_angle=pressure_angle, backlash=-0.05)[0]) for teeth in (24, 41)
        ]
        for angle in np.linspace(0.0, 15.0, 7):
            a, b = gears.train(pair, 2.0, angle)
            assert (a & b).is_empty, angle
            # and teeth that are a little thicker than they may be do not turn
            a, b = gears.train(thick, 2.0, angle)
            assert (a & b).volume > 0.0, angle

    def test_a_gear_has_the_tooth_thickness_of_its_standard(self):
        # along the pitch circle teeth and gaps are equally wide: half of pi times the module
        loop = example("gears").outline(3.0, 20, steps=400)
        radius, angle = np.hypot(*loop.T), np.arctan2(loop[:, 1], loop[:, 0])
        flank = (np.abs(angle) < np.pi / 20) & (angle > 0) & (radius > 28.3)
        order = np.argsort(radius[flank])
        half = np.interp(30.0, radius[flank][order], angle[flank][order])
        assert 2 * half * 30.0 == pytest.approx(3.0 * np.pi / 2, rel=1e-6)


class TestFracture:
    """fracture.py."""

    def test_pieces_add_up_to_the_whole(self, tmp_path):
        whole, pieces = example("fracture").main(tmp_path, count=8)
        assert len(pieces) == 8
        assert fsum(piece.volume for piece in pieces) == pytest.approx(whole.volume, rel=1e-12)
        assert all(piece.mesh().is_watertight for piece in pieces)
        assert png_size(tmp_path / "fracture.png") == (1200, 900)
        # and by another program, of the triangles
        volumes = [manifold_of(piece.mesh()).volume() for piece in pieces]
        assert fsum(volumes) == pytest.approx(manifold_of(whole.mesh()).volume(), rel=1e-12)

    def test_pieces_of_a_mesh_file_do_not_overlap_and_leave_nothing_out(self, tmp_path):
        torus = pc.torus(3, 1, segments=12, tube_segments=8)
        torus.save(tmp_path / "torus.obj")
        whole, pieces = example("fracture").main(tmp_path, tmp_path / "torus.obj", count=6)
        assert fsum(piece.volume for piece in pieces) == pytest.approx(whole.volume, rel=1e-12)
        assert all((a & b).is_empty for k, a in enumerate(pieces) for b in pieces[:k])
        assert (whole - pc.union(pieces)).is_empty

    def test_volumes_of_a_fractured_box_are_exactly_those_of_its_cells(self):
        # in exact numbers: sites in a row cut a box by planes halfway between them
        xs = [Fraction(1, 8), Fraction(3, 8), Fraction(3, 4)]
        sites = np.array([[float(x), 0.5, 0.5] for x in xs])
        pieces = example("fracture").fracture(pc.box([0, 0, 0], [1, 1, 1]), sites)
        cuts = [Fraction(0), *((a + b) / 2 for a, b in zip(xs, xs[1:])), Fraction(1)]
        assert [Fraction(piece.volume) for piece in pieces] == [b - a for a, b in zip(cuts, cuts[1:])]


class TestColliders:
    """colliders.py and colliders_pybullet.py."""

    def test_each_mesh_of_a_folder_becomes_a_body_of_its_mass(self, tmp_path):
        colliders = example("colliders")
        documents, failed = colliders.main(tmp_path, max_cells=12)
        assert [path.stem for path in documents] == ["bracket", "mug", "table"] and not failed
        mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed")
        for path in documents:
            model = mujoco.MjModel.from_xml_path(str(path))
            solid = colliders.samples()[path.stem]
            assert model.body_mass[1] == pytest.approx(1000.0 * solid.volume, rel=1e-6)
            assert model.body_ipos[1] == pytest.approx(solid.centroid, abs=1e-6)

    def test_a_table_settles_on_its_feet(self, tmp_path):
        pytest.importorskip("mujoco", reason="MuJoCo is not installed")
        colliders = example("colliders")
        (tmp_path / "meshes").mkdir()
        colliders.samples()["table"].save(tmp_path / "meshes" / "table.stl")
        (document,), _ = colliders.main(tmp_path, tmp_path / "meshes", max_cells=8)
        model, data = colliders.settle(document)
        assert np.linalg.norm(data.qvel) < 1e-3
        assert data.qpos[2] == pytest.approx(0.0, abs=2e-3)
        assert abs(data.qpos[3]) == pytest.approx(1.0, abs=1e-4)
        assert colliders.lowest(model, data) == pytest.approx(0.0, abs=2e-3)

    def test_what_cannot_be_read_is_told_and_the_rest_is_done(self, tmp_path):
        (tmp_path / "meshes").mkdir()
        (tmp_path / "meshes" / "broken.obj").write_text("v 0 0\n")
        pc.box([0, 0, 0], [1, 1, 1]).save(tmp_path / "meshes" / "cube.obj")
        documents, failed = example("colliders").main(tmp_path, tmp_path / "meshes")
        assert [path.stem for path in documents] == ["cube"]
        assert failed["broken.obj"].startswith("error:")

    def test_a_ball_rests_in_the_bowl_of_pybullet(self):
        pytest.importorskip(
            "pybullet", reason="PyBullet is not installed: there is no wheel for every version of Python"
        )
        hulls, place = example("colliders_pybullet").main()
        # the floor of the bowl is 0.02 high, its rim 0.1 and 0.18 wide
        assert hypot(*place[:2]) < 0.18
        assert 0.045 < place[2] < 0.1
        assert all(vertices.shape[1] == 3 and triangles.shape[1] == 3 for vertices, triangles in hulls)


class TestLiveEdit:
    """live_edit.py."""

    def test_dragging_gives_the_mesh_made_anew_and_undo_gives_the_first(self, tmp_path):
        module = example("live_edit")
        live, log, (before, dragged, after), moved, _ = module.main(tmp_path, reach=12.0, steps=40)
        assert len(log) == 40 and before == after
        assert any(removed and added for removed, added, _ in log)
        # made again, and by another program: what is dragged is the volume of the mesh
        again = moved.mesh()
        assert manifold_of(again).volume() == pytest.approx(dragged, rel=1e-12)
        first, undone = module.level().mesh(), live.mesh()
        assert np.array_equal(first.vertices, undone.vertices) and np.array_equal(first.triangles, undone.triangles)

    def test_the_beam_adds_what_lies_in_rooms_alone(self):
        # it lies in a room from 9.6 to where a pillar begins
        module = example("live_edit")
        live = pc.Live(module.level())
        brush = int(live.brushes[-1])
        plane, start = module.side(live, brush)
        before = live.volume
        with live.edit() as edit:
            edit.move_plane(brush, plane, start + 1.5)
        assert live.volume - before == pytest.approx(1.5 * 0.1 * module.SIZE, rel=1e-9)


class TestOptimise:
    """optimise.py."""

    @pytest.fixture(autouse=True)
    def with_scipy(self):
        """The example needs it."""
        pytest.importorskip("scipy", reason="SciPy is not installed")

    def test_the_surface_of_a_half_full_tank_goes_through_its_center(self):
        offsets, (angle, area) = example("optimise").main()
        for tilt, offset in offsets.items():
            assert offset == pytest.approx(0.5 * sin(radians(tilt)) + 0.4 * cos(radians(tilt)), abs=1e-13), tilt
        # it is largest where it meets two edges
        assert angle == pytest.approx(degrees(atan(0.8)), abs=1e-5)
        assert area == pytest.approx(0.6 * hypot(1.0, 0.8), rel=1e-6)

    @pytest.mark.parametrize("tilt", [0.0, 5.0, 20.0, 50.0, 90.0])
    def test_the_area_is_the_derivative_of_the_volume(self, tilt):
        module = example("optimise")
        liquid = module.Liquid(module.TANK, module.tilted(tilt))
        step = 1e-5
        for share in (0.11, 0.37, 0.5, 0.83):
            offset = liquid.low + share * (liquid.high - liquid.low)
            difference = (liquid.at(offset + step)[0] - liquid.at(offset - step)[0]) / (2 * step)
            assert liquid.at(offset)[1] == pytest.approx(difference, rel=1e-4)

    def test_a_small_volume_is_a_prism_in_the_lowest_edge(self):
        # a triangle of the surface's height h above the edge: area h * h / (2 sin cos), 0.6 long
        module = example("optimise")
        up = module.tilted(25.0)
        height = 0.2
        volume = 0.6 * height**2 / (2 * up[0] * up[2])
        assert module.Liquid(module.TANK, up).level(volume) == pytest.approx(height, rel=1e-12)
