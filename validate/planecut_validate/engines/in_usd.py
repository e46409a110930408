"""The body in USD's own library."""

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdPhysics

from .body import Body, check_enclosed
from .in_mujoco import BOX


def check(body: Body) -> str:
    """Opens the stage, finds what it describes, and compares it; gives figures."""
    stage = Usd.Stage.Open(str(body.file("usda")))
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Z"
    assert UsdPhysics.GetStageKilogramsPerUnit(stage) == 1
    root = stage.GetDefaultPrim()
    assert root and root.IsA(UsdGeom.Xform) and root.HasAPI(UsdPhysics.RigidBodyAPI) and root.HasAPI(UsdPhysics.MassAPI)
    check_mass(body, UsdPhysics.MassAPI(root))
    visual = UsdGeom.Mesh(stage.GetPrimAtPath(root.GetPath().AppendChild("visual")))
    assert visual and not visual.GetPrim().HasAPI(UsdPhysics.CollisionAPI)
    points = np.array(visual.GetPointsAttr().Get(), dtype=float)
    assert np.abs(points - body.visual()).max() <= 1e-7 * np.abs(points).max()
    assert visual.ValidateTopology(visual.GetFaceVertexIndicesAttr().Get(), visual.GetFaceVertexCountsAttr().Get(), len(points))
    colliders = [prim for prim in stage.Traverse() if prim.HasAPI(UsdPhysics.CollisionAPI)]
    cubes = [prim for prim in colliders if prim.IsA(UsdGeom.Cube)]
    assert (len(colliders), len(cubes)) == (body.cells, body.boxes), f"{len(colliders)} colliders, {len(cubes)} boxes"
    check_enclosed(body, [corners(prim) for prim in colliders])
    return f"{len(colliders)} prims"


def check_mass(body: Body, mass: UsdPhysics.MassAPI) -> None:
    assert abs(mass.GetMassAttr().Get() / body.mass["mass"] - 1) < 1e-6
    center = np.array(mass.GetCenterOfMassAttr().Get())
    assert np.abs(center - body.mass["center"]).max() < 1e-6 * (body.size() + np.abs(center).max())
    turn = Gf.Matrix3d(Gf.Quatd(mass.GetPrincipalAxesAttr().Get()))
    # rows are images of the axes
    turn = np.array(turn).T
    tensor = turn @ np.diag(mass.GetDiagonalInertiaAttr().Get()) @ turn.T
    assert np.abs(tensor - body.inertia).max() < 1e-5 * np.abs(body.inertia).max(), f"inertia {tensor}"


def corners(prim: Usd.Prim) -> np.ndarray:
    """The corners of a collider, in coordinates of the stage."""
    assert UsdGeom.Imageable(prim).GetPurposeAttr().Get() == UsdGeom.Tokens.guide
    if prim.IsA(UsdGeom.Cube):
        points = BOX * (UsdGeom.Cube(prim).GetSizeAttr().Get() / 2)
    else:
        mesh = UsdPhysics.MeshCollisionAPI(prim)
        assert prim.HasAPI(UsdPhysics.MeshCollisionAPI) and mesh.GetApproximationAttr().Get() == UsdPhysics.Tokens.convexHull
        points = np.array(UsdGeom.Mesh(prim).GetPointsAttr().Get(), dtype=float)
    matrix = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.Default()))
    return points @ matrix[:3, :3] + matrix[3, :3]
