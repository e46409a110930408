"""The body in MuJoCo."""

import mujoco
import numpy as np

from .body import Body, check_enclosed

SCENE = """<mujoco>
  <include file="part.xml"/>
  <option timestep="{step}" integrator="implicitfast"/>
  <default><geom solref="{soft} 1"/></default>
  <worldbody><geom name="ground" type="plane" size="0 0 1"/></worldbody>
</mujoco>
"""
BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])


def check(body: Body) -> str:
    """Loads the model by itself, compares what it has, and drops it to the ground; gives figures."""
    model = mujoco.MjModel.from_xml_path(str(body.file("xml")))
    assert model.nbody == 2 and model.nq == 7, f"{model.nbody} bodies, {model.nq} coordinates"
    # the mass is the stated one, not one of geoms
    assert abs(model.body_mass[1] / body.mass["mass"] - 1) < 1e-12, f"mass {model.body_mass[1]}"
    assert np.allclose(model.body_ipos[1], body.mass["center"], atol=1e-12 * body.size(), rtol=1e-12)
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[1])
    turn = turn.reshape(3, 3)
    tensor = turn @ np.diag(model.body_inertia[1]) @ turn.T
    assert np.abs(tensor - body.inertia).max() < 1e-9 * np.abs(body.inertia).max(), f"inertia {tensor}"
    colliding = [geom for geom in range(model.ngeom) if model.geom_contype[geom]]
    boxes = [geom for geom in colliding if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX]
    assert (len(colliding), len(boxes)) == (body.cells, body.boxes), f"{len(colliding)} colliders, {len(boxes)} boxes"
    assert model.ngeom == body.cells + 1 and model.geom("part_visual").group[0] == 2
    check_enclosed(body, [corners(model, geom) for geom in colliding])
    robot = mujoco.MjModel.from_xml_path(str(body.file("urdf")))
    assert robot.ngeom == body.cells + 1, f"{robot.ngeom} geoms of the URDF"
    return settle(body)


def corners(model: mujoco.MjModel, geom: int) -> np.ndarray:
    """The corners of a collider as MuJoCo holds them."""
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX:
        points = BOX * model.geom_size[geom]
    else:
        mesh = model.geom_dataid[geom]
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        points = model.mesh_vert[first : first + count].astype(float)
    return points @ turn.reshape(3, 3).T + model.geom_pos[geom]


def settle(body: Body) -> str:
    """Drops it from a hundredth of its size: it comes to rest on the ground and not in it."""
    size, low = body.size(), body.visual()[:, 2].min()
    # how long it takes to fall by its size
    time = float(np.sqrt(2 * size / 9.81))
    step = time / 300
    scene = body.folder / "scene.xml"
    scene.write_text(SCENE.format(step=step, soft=2 * step))
    model = mujoco.MjModel.from_xml_path(str(scene))
    data = mujoco.MjData(model)
    data.qpos[2] = 0.01 * size - low
    mujoco.mj_step(model, data, nstep=int(10 * time / step))
    mujoco.mj_forward(model, data)
    depth = -min((contact.dist for contact in data.contact[: data.ncon]), default=0.0) / size
    speed = float(np.abs(data.qvel[:3]).max()) / (size / time)
    turn = np.empty(9)
    mujoco.mju_quat2Mat(turn, data.qpos[3:])
    seen = float((body.visual() @ turn.reshape(3, 3)[2]).min() + data.qpos[2]) / size
    assert data.ncon > 0, "it touches nothing"
    assert speed < 1e-3, f"it moves by {speed} of its size in the time of a fall"
    assert depth < 1e-3, f"it is {depth} of its size within the ground"
    assert seen > -1e-3, f"what is seen is {-seen} of its size within the ground"
    return f"depth {depth:.1e}, speed {speed:.0e}, seen at {seen:+.1e}"
