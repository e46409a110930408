"""Meshes read again by trimesh, and taken for solids by manifold3d."""

import re
import subprocess
import warnings
from io import BytesIO
from pathlib import Path

import manifold3d
import numpy as np
import trimesh

from .assets import PLAIN, Asset
from .gltf_file import GltfFile
from .measure import Surface, Volume, compare
from .setting import Setting

SINGLE = 2.0**-24
"""How far rounding to single precision moves a number, relative to it."""

TIMEOUT = 300
"""Seconds for unpacking a file."""

_UNPACK = Path(__file__).resolve().parents[1] / "javascript" / "unpack.js"


def check_mesh(setting: Setting, asset: Asset) -> list[Volume]:
    """Reads the file with both; what is amiss goes to `setting`."""
    if asset.report["mesh"]["triangles"] == 0 and asset.ending == "3mf":
        # trimesh takes no 3MF without an object.
        return []
    path, gltf = asset.path, None
    if asset.ending in ("glb", "gltf"):
        gltf = GltfFile.read(path)
        if gltf.compressed:
            path = _unpacked(path)
            gltf = GltfFile.read(path)
    vertices, triangles = _read(path)
    found = Surface.of(vertices, triangles)
    step = gltf.half_step() if gltf else _half_step(asset, found.extent)
    check_count(setting, asset, "trimesh", len(triangles), step)
    volumes = [compare(asset.where, "trimesh", found, asset.report, step)]
    if asset.keeps_topology and len(triangles) > 0:
        if asset.ending == "obj":
            vertices, triangles = _read_bare_obj(path)
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
        way = "" if asset.variant == PLAIN else f" ({asset.variant})"
        lost = expected - triangles
        setting.note(
            f"{asset.input}{way}: {lost} of {expected} triangles are not written where coordinates are rounded"
        )


def _read(file: Path | BytesIO, ending: str = "") -> tuple[np.ndarray, np.ndarray]:
    """All triangles, where they are in the world, with the vertices as the file has them.

    trimesh makes a mesh of each material's triangles, with all vertices of the file; these are taken once.
    """
    ending = ending or Path(str(file)).suffix[1:]
    keep: dict = {"process": False, "file_type": ending}
    if ending == "obj":
        keep |= {"maintain_order": True, "group_material": False, "skip_materials": True}
    with warnings.catch_warnings():
        # What trimesh says of texture coordinates of vertices that no triangle of a material uses.
        warnings.simplefilter("ignore", RuntimeWarning)
        scene = trimesh.load_scene(file, **keep)
    vertices: dict[bytes, tuple[int, np.ndarray]] = {}
    triangles, count = [np.zeros((0, 3), int)], 0
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        part = scene.geometry[name]
        placed = np.asarray(part.vertices, float) @ matrix[:3, :3].T + matrix[:3, 3]
        first, _ = vertices.setdefault(placed.tobytes(), (count, placed))
        count = max(count, first + len(placed))
        triangles.append(part.faces + first)
    return np.concatenate([np.zeros((0, 3))] + [placed for _, placed in vertices.values()]), np.concatenate(triangles)


def _read_bare_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Without texture coordinates and normals: trimesh makes several vertices of one that has several of these."""
    lines = (line for line in path.read_bytes().splitlines() if not line.startswith((b"vt ", b"vn ")))
    return _read(BytesIO(re.sub(rb"(?m)(?<= )(\d+)/[\d/]*", rb"\1", b"\n".join(lines))), "obj")


def _unpacked(path: Path) -> Path:
    """The GLB file with its buffer unpacked by the decoder that three.js has."""
    unpacked = path.with_suffix(".unpacked.glb")
    subprocess.run(["node", str(_UNPACK), str(path), str(unpacked)], check=True, timeout=TIMEOUT)
    return unpacked


def _half_step(asset: Asset, extent: float) -> float:
    """OBJ and 3MF have decimals that read back as the same number; PLY says what it has; STL has single precision."""
    head = asset.path.read_bytes()[:2000].partition(b"end_header")[0]
    double = asset.ending in ("obj", "3mf") or (asset.ending == "ply" and b"property double x" in head)
    return 0.0 if double else extent * SINGLE


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
