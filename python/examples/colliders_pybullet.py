"""Colliders in PyBullet by `planecut.compat.run_coacd`, which takes the place of `coacd.run_coacd`.

python examples/colliders_pybullet.py
"""

import numpy as np
import planecut as pc
from planecut.compat import run_coacd  # instead of: from coacd import run_coacd


def bowl():
    """A mesh that is not convex, in metres: vertices of shape (n, 3), and triangles of shape (m, 3)."""
    solid = pc.revolve([[0, 0], [0.1, 0], [0.2, 0.1], [0.18, 0.1], [0.09, 0.02], [0, 0.02]], segments=16)
    mesh = solid.mesh()
    return mesh.vertices, mesh.triangles


def main(seconds=3.0):
    """Lets a ball fall into a bowl; returns the hulls, and where the ball comes to rest."""
    import pybullet

    hulls = run_coacd(*bowl(), threshold=0.05, max_convex_hull=40)
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0, 0, -9.81, physicsClientId=client)
        for vertices, _ in hulls:
            # of a mesh without indices PyBullet takes the convex hull
            shape = pybullet.createCollisionShape(
                pybullet.GEOM_MESH, vertices=vertices.tolist(), physicsClientId=client
            )
            pybullet.createMultiBody(0, shape, physicsClientId=client)
        sphere = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=0.03, physicsClientId=client)
        ball = pybullet.createMultiBody(0.1, sphere, basePosition=[0.05, 0, 0.3], physicsClientId=client)
        pybullet.changeDynamics(ball, -1, rollingFriction=0.001, spinningFriction=0.001, physicsClientId=client)
        for _ in range(round(seconds * 240)):
            pybullet.stepSimulation(physicsClientId=client)
        place, _ = pybullet.getBasePositionAndOrientation(ball, physicsClientId=client)
    finally:
        pybullet.disconnect(client)
    return hulls, np.array(place)


if __name__ == "__main__":
    hulls, place = main()
    print(f"{len(hulls)} hulls; the ball rests at {place.round(3).tolist()}")
