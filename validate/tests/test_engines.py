"""The checks of rigid bodies pass on a body written by hand, and fail on each damage to it."""

import pathlib
import tempfile
import unittest

from planecut_validate.engines import in_bullet, in_mujoco, in_usd
from planecut_validate.engines.body import Body
from planecut_validate.engines.shapes import Shape

# A pyramid of height 1 over a square of side 2, beside it a box on which nothing is seen; density 3: 4 kg.
# About the centre of mass, a quarter above the square, a pyramid has m·a²/20 + 3·m·h²/80 and m·a²/10.
VERTICES = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)]
TRIANGLES = [(0, 2, 1), (0, 3, 2), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
MASS = {"mass": 4.0, "volume": 4 / 3, "center": [0, 0, 0.25], "inertia": [0.95, 0.95, 1.6, 0, 0, 0]}
OBJ = "".join(f"v {x} {y} {z}\n" for x, y, z in VERTICES) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in TRIANGLES)
MJCF = """<mujoco><compiler meshdir="part_meshes"/>
<asset><mesh name="part_visual" file="visual.obj"/><mesh name="c" file="collision_0.obj"/></asset>
<worldbody><body><freejoint/><inertial pos="0 0 .25" mass="4" fullinertia=".95 .95 1.6 0 0 0"/>
<geom name="part_visual" type="mesh" mesh="part_visual" group="2" contype="0" conaffinity="0"/>
<geom type="mesh" mesh="c"/><geom type="box" size=".5 .5 .1" pos="0 0 .1"/></body></worldbody></mujoco>
"""
URDF = """<robot name="part"><mujoco><compiler strippath="false" discardvisual="false"/></mujoco><link name="part"><inertial><origin xyz="0 0 .25"/><mass value="4"/>
<inertia ixx=".95" iyy=".95" izz="1.6" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><mesh filename="part_meshes/visual.obj"/></geometry></visual>
<collision><geometry><mesh filename="part_meshes/collision_0.obj"/></geometry></collision>
<collision><origin xyz="0 0 .1"/><geometry><box size="1 1 .2"/></geometry></collision></link></robot>
"""
POINTS = ", ".join(str(vertex) for vertex in VERTICES)
MESH = f"""int[] faceVertexCounts = [{", ".join("3" for _ in TRIANGLES)}]
int[] faceVertexIndices = [{", ".join(str(corner) for corners in TRIANGLES for corner in corners)}]
point3f[] points = [{POINTS}]"""
USDA = f"""#usda 1.0
( defaultPrim = "part"
  kilogramsPerUnit = 1
  metersPerUnit = 1
  upAxis = "Z" )
def Xform "part" ( prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"] )
{{
float physics:mass = 4
point3f physics:centerOfMass = (0, 0, 0.25)
float3 physics:diagonalInertia = (0.95, 0.95, 1.6)
quatf physics:principalAxes = (1, 0, 0, 0)
def Mesh "visual"
{{
{MESH}
}}
def Mesh "hull" ( prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"] )
{{
uniform token physics:approximation = "convexHull"
uniform token purpose = "guide"
{MESH}
}}
def Cube "cube" ( prepend apiSchemas = ["PhysicsCollisionAPI"] )
{{
uniform token purpose = "guide"
double size = 0.5
double3 xformOp:translate = (0, 0, 0.25)
uniform token[] xformOpOrder = ["xformOp:translate"]
}}
}}
"""
FILES = {"part.xml": MJCF, "part.urdf": URDF, "part.usda": USDA, "part_meshes/visual.obj": OBJ, "part_meshes/collision_0.obj": OBJ}


def outcome(check, damage=None):
    """What a check says of the body, one text in one of its files replaced by another; nothing where it passes."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "part_meshes").mkdir()
        for name, text in FILES.items():
            if damage and damage[0] == name:
                assert damage[1] in text, damage
                text = text.replace(damage[1], damage[2], 1)
            (root / name).write_text(text, encoding="utf-8")
        report = {"coarsen": {"cells_out": 2, "boxes": 1, "mass": MASS}}
        try:
            check(Body(Shape("pyramid", root, []), root, report))
        except AssertionError as error:
            return str(error) or "refused"
    return None


class Engines(unittest.TestCase):
    def check(self, check, damages):
        self.assertIsNone(outcome(check))
        for damage in damages:
            with self.subTest(damage=damage):
                self.assertIsNotNone(outcome(check, damage))

    def test_mujoco(self):
        self.check(
            in_mujoco.check,
            [
                ("part.xml", 'mass="4"', 'mass="4.01"'),
                ("part.xml", ".95 .95 1.6", ".95 .96 1.6"),
                ("part.xml", "0 0 .25", "0 0 .26"),
                ("part.xml", 'contype="0" conaffinity="0"', ""),
                ("part.xml", '<geom type="box" size=".5 .5 .1" pos="0 0 .1"/>', ""),
                ("part_meshes/collision_0.obj", "v 0 0 1\n", "v 0 0 0.999\n"),
                ("part.urdf", 'discardvisual="false"', 'discardvisual="true"'),
            ],
        )

    def test_bullet(self):
        self.check(
            in_bullet.check,
            [
                ("part.urdf", 'value="4"', 'value="4.01"'),
                ("part.urdf", 'izz="1.6"', 'izz="1.7"'),
                ("part.urdf", 'ixx=".95"', 'ixx="1.6"'),
                ("part.urdf", 'xyz="0 0 .25"', 'xyz="0 0 .35"'),
                ("part.urdf", '<box size="1 1 .2"/>', '<sphere radius=".1"/>'),
            ],
        )

    def test_usd(self):
        self.check(
            in_usd.check,
            [
                ("part.usda", "physics:mass = 4", "physics:mass = 5"),
                ("part.usda", '"PhysicsRigidBodyAPI", ', ""),
                ("part.usda", "convexHull", "none"),
                ("part.usda", "metersPerUnit = 1", "metersPerUnit = 0.01"),
                ("part.usda", "(0.95, 0.95, 1.6)", "(0.95, 1.6, 0.95)"),
                ("part.usda", '"PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"', '"PhysicsMeshCollisionAPI"'),
                ("part.usda", f'"guide"\n{MESH}', f'"guide"\n{MESH.replace("(0, 0, 1)", "(0, 0, 0.9)")}'),
            ],
        )


if __name__ == "__main__":
    unittest.main()
