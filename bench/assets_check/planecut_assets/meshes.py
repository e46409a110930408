"""Meshes read again by trimesh, and taken for solids by manifold3d."""

from pathlib import Path

import manifold3d
import numpy as np
import trimesh

from .assets import Asset
from .gltf_file import GltfFile
from .measure import Surface, Volume, compare
from .setting import Setting

SINGLE = 2.0**-24
"""How far rounding to single precision moves a number, relative to it."""

KEEPS_TOPOLOGY = ("obj", "ply", "3mf", "glb", "gltf")
"""Formats that tell which vertices are one; glTF does by `EXT_mesh_manifold`, which trimesh does not know."""


def check_mesh(setting: Setting, asset: Asset) -> list[Volume]:
    """Reads the file with both; what is amiss goes to `setting`."""
    gltf = GltfFile.read(asset.path) if asset.ending in ("glb", "gltf") else None
    if gltf and gltf.compressed:
        return []
    vertices, triangles = _read(asset.path)
    found = Surface.of(vertices, triangles)
    step = gltf.half_step() if gltf else _half_step(asset, found.extent)
    check_count(setting, asset, "trimesh", len(triangles), step)
    volumes = [compare(asset.where, "trimesh", found, asset.report, step)]
    if asset.ending in KEEPS_TOPOLOGY and len(triangles) > 0:
        if not gltf and not trimesh.Trimesh(vertices, triangles, process=False).is_watertight:
            setting.fail(asset.where, "trimesh finds it not watertight")
        parts = _parts_of_gltf(gltf) if gltf else [manifold3d.Mesh64(vertices, triangles.astype(np.uint64))]
        solids = [manifold3d.Manifold(part) for part in parts]
        refused = {solid.status().name for solid in solids} - {"NoError"}
        if refused:
            setting.fail(asset.where, f"manifold3d takes it for no solid: {', '.join(sorted(refused))}")
        else:
            whole = Surface(sum(solid.volume() for solid in solids), found.area, found.extent)
            volumes.append(compare(asset.where, "manifold3d", whole, asset.report, step))
    for volume in filter(lambda volume: volume.amiss, volumes):
        setting.fail(asset.where, volume)
    return volumes


def check_count(setting: Setting, asset: Asset, reader: str, triangles: int, half_step: float) -> None:
    """As many triangles as planecut reports; fewer where coordinates are rounded and edges are lost by that."""
    expected = asset.report["mesh"]["triangles"]
    if triangles > expected or (triangles < expected and half_step == 0.0):
        setting.fail(asset.where, f"{reader} finds {triangles} triangles, planecut reports {expected}")
    elif triangles < expected:
        setting.note(f"{asset.where}: {reader} finds {triangles} triangles; {expected - triangles} are lost in rounding")


def _read(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """All triangles, where they are in the world, with the vertices as the file has them.

    trimesh makes a mesh of each material's triangles, with all vertices of the file; these are taken once.
    """
    keep = {"process": False}
    if path.suffix == ".obj":
        keep |= {"maintain_order": True, "group_material": False, "skip_materials": True}
    scene = trimesh.load_scene(path, **keep)
    vertices, triangles = {}, [np.zeros((0, 3), int)]
    count = 0
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        part = scene.geometry[name]
        placed = np.asarray(part.vertices, float) @ matrix[:3, :3].T + matrix[:3, 3]
        first, _ = vertices.setdefault(placed.tobytes(), (count, placed))
        count = max(count, first + len(placed))
        triangles.append(part.faces + first)
    return np.concatenate([np.zeros((0, 3))] + [placed for _, placed in vertices.values()]), np.concatenate(triangles)


def _half_step(asset: Asset, extent: float) -> float:
    """OBJ has the shortest decimals that read back as the same number; PLY says; STL and readers of 3MF are in single precision."""
    if asset.ending == "ply":
        head = asset.path.read_bytes()[:2000].partition(b"end_header")[0]
        return 0.0 if b"property double x" in head else extent * SINGLE
    return 0.0 if asset.ending == "obj" else extent * SINGLE


def _parts_of_gltf(gltf: GltfFile) -> list[manifold3d.Mesh64]:
    """The meshes as `EXT_mesh_manifold` says that they are. Raises `ValueError` where it breaks a rule of its own."""
    parts = []
    for mesh, matrix in gltf.placed_meshes():
        says = mesh["extensions"]["EXT_mesh_manifold"]
        primitive = says["manifoldPrimitive"]
        points = gltf.array(primitive["attributes"]["POSITION"]).astype(float)
        corners = gltf.array(primitive["indices"])
        drawn = np.concatenate([gltf.array(primitive["indices"]) for primitive in mesh["primitives"]])
        if not np.array_equal(points[drawn], points[corners]):
            raise ValueError("EXT_mesh_manifold merges vertices of different positions")
        if "mergeIndices" in says:
            drawn[gltf.array(says["mergeIndices"])] = gltf.array(says["mergeValues"])
        if not np.array_equal(drawn, corners):
            raise ValueError("EXT_mesh_manifold: its merges do not give the indices of its primitive")
        placed = points @ matrix[:3, :3].T + matrix[:3, 3]
        parts.append(manifold3d.Mesh64(placed, corners.astype(np.uint64).reshape(-1, 3)))
    return parts
