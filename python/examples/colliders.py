"""Colliders for a folder of meshes: a rigid body in MJCF for each, with mass and inertia; MuJoCo settles one.

    python examples/colliders.py [output folder] [folder of meshes] [maximum number of cells]

Meshes are in metres. Without a folder of them three are made: a table, a mug and a bracket.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import planecut as pc

SCENE = """<mujoco>
  <include file="{name}"/>
  <worldbody><geom name="floor" type="plane" size="0 0 1"/></worldbody>
</mujoco>
"""


def samples():
    """Three solids by name, in metres."""
    leg = pc.box([-0.03, -0.03, 0], [0.03, 0.03, 0.7])
    legs = [leg.translate([x, y, 0]) for x in (-0.35, 0.35) for y in (-0.25, 0.25)]
    table = pc.union([pc.box([-0.4, -0.3, 0.7], [0.4, 0.3, 0.74]), *legs])
    handle = pc.torus(0.03, 0.006, segments=24, tube_segments=8).rotate("x", 90).translate([0.045, 0, 0.05])
    mug = (pc.cylinder(0.1, 0.04, segments=32) | handle) - pc.cylinder(0.1, 0.036, segments=32).translate([0, 0, 0.005])
    plate = pc.box([0, 0, 0], [0.12, 0.06, 0.01]) - pc.cylinder(0.01, 0.008, segments=24).translate([0.09, 0.03, 0])
    bracket = plate | plate.rotate("y", -90).translate([0.01, 0, 0])
    return {"table": table, "mug": mug, "bracket": bracket}


def convert(mesh, document, max_cells):
    """Writes an MJCF document of a mesh file with the command `planecut`; returns why not, or None."""
    command = ["coarsen", mesh, "-o", document, "--engine", "mujoco", "--max-cells", str(max_cells), "--quiet"]
    done = subprocess.run([sys.executable, "-m", "planecut", *map(str, command)], capture_output=True, text=True)
    return done.stderr.strip() if done.returncode else None


def settle(document, height=0.02, seconds=2.0):
    """Drops the body of a document upon a floor; returns MuJoCo's model and its data at the end."""
    import mujoco

    scene = document.with_name(f"{document.stem}_scene.xml")
    scene.write_text(SCENE.format(name=document.name), encoding="utf-8")
    model = mujoco.MjModel.from_xml_path(str(scene))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    data.qpos[2] += height - lowest(model, data)
    while data.time < seconds:
        mujoco.mj_step(model, data)
    return model, data


def lowest(model, data):
    """The height of the lowest vertex of the colliders, in metres."""
    import mujoco

    heights = []
    for geom in range(model.ngeom):
        if model.geom_group[geom] != 3:
            continue
        if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX:
            signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T
            vertices = signs * model.geom_size[geom]
        else:
            first, count = model.mesh_vertadr[model.geom_dataid[geom]], model.mesh_vertnum[model.geom_dataid[geom]]
            vertices = model.mesh_vert[first : first + count]
        heights.append((vertices @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom])[:, 2].min())
    return min(heights)


def main(folder=".", meshes=None, max_cells=16):
    """Writes a document for each mesh; returns the paths of the documents, and what went wrong by name."""
    folder = Path(folder)
    if meshes is None:
        meshes = folder / "meshes"
        meshes.mkdir(exist_ok=True)
        for name, solid in samples().items():
            solid.save(meshes / f"{name}.obj")
    documents, failed = [], {}
    for mesh in sorted(
        path for path in Path(meshes).iterdir() if path.suffix.lower() in (".obj", ".stl", ".ply", ".glb")
    ):
        document = folder / f"{mesh.stem}.xml"
        problem = convert(mesh, document, max_cells)
        if problem is None:
            documents.append(document)
        else:
            failed[mesh.name] = problem
    return documents, failed


if __name__ == "__main__":
    made, problems = main(*sys.argv[1:4])
    for path in made:
        print(path)
    for name, problem in problems.items():
        print(f"{name}: {problem}", file=sys.stderr)
    try:
        model, data = settle(made[0])
    except ImportError:
        print("MuJoCo is not installed: nothing is simulated")
    else:
        height, speed = lowest(model, data), np.linalg.norm(data.qvel)
        print(f"{made[0].stem}: {model.body_mass[1]:.4f} kg, rests {height:.5f} m above the floor at {speed:.1e} m/s")
