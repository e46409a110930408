"""The body in Bullet, by PyBullet."""

import numpy as np
import pybullet

from .body import SINGLE, Body


def check(body: Body) -> str:
    """Loads the robot, compares what it has, and drops it to the ground; gives figures."""
    client = pybullet.connect(pybullet.DIRECT)
    try:
        return settle(body, client)
    finally:
        pybullet.disconnect(client)


def settle(body: Body, client: int) -> str:
    size, visual = body.size(), body.visual()
    low, center = visual[:, 2].min(), np.array(body.mass["center"])
    time = float(np.sqrt(2 * size / 9.81))
    step = time / 300
    pybullet.setGravity(0, 0, -9.81)
    pybullet.setTimeStep(step)
    pybullet.createMultiBody(0, pybullet.createCollisionShape(pybullet.GEOM_PLANE))
    path = str(body.file("urdf"))
    robot = pybullet.loadURDF(path, basePosition=[0, 0, 0], flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    assert robot >= 0
    mass, _, local, _, turn = pybullet.getDynamicsInfo(robot, -1)[:5]
    assert abs(mass / body.mass["mass"] - 1) < 1e-12, f"mass {mass}"
    # Bullet keeps the moments about its own principal axes
    axes = np.array(pybullet.getMatrixFromQuaternion(turn)).reshape(3, 3)
    tensor = axes @ np.diag(local) @ axes.T
    assert np.abs(tensor - body.inertia).max() < 1e-4 * np.abs(body.inertia).max(), f"inertia {tensor}, expected {body.inertia}"
    shapes = pybullet.getCollisionShapeData(robot, -1)
    boxes = sum(shape[2] == pybullet.GEOM_BOX for shape in shapes)
    assert (len(shapes), boxes) == (body.cells, body.boxes), f"{len(shapes)} colliders, {boxes} boxes"
    # the origin of the file, not the centre of mass, is where it was put; what is seen is in the bounds of what collides
    bounds = np.array(pybullet.getAABB(robot, -1))
    moved, _ = pybullet.getBasePositionAndOrientation(robot)
    shift = np.array(moved) - center
    margin = SINGLE * (size + np.abs(visual).max())
    assert (bounds[0] - shift <= visual.min(axis=0) + margin).all(), f"{bounds[0] - shift} above {visual.min(axis=0)}"
    assert (bounds[1] - shift >= visual.max(axis=0) - margin).all(), f"{bounds[1] - shift} below {visual.max(axis=0)}"
    position = np.array(moved)
    position[2] += 0.01 * size - low - shift[2]
    pybullet.resetBasePositionAndOrientation(robot, position.tolist(), [0, 0, 0, 1])
    for _ in range(int(10 * time / step)):
        pybullet.stepSimulation()
    velocity, _ = pybullet.getBaseVelocity(robot)
    speed = float(np.abs(velocity).max()) / (size / time)
    contacts = pybullet.getContactPoints(robot)
    depth = -min((contact[8] for contact in contacts), default=0.0) / size
    assert contacts, "it touches nothing"
    assert speed < 1e-2, f"it moves by {speed} of its size in the time of a fall"
    assert depth < 1e-3, f"it is {depth} of its size within the ground"
    return f"depth {depth:.1e}, speed {speed:.0e}"
