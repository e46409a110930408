"""Maps and trees that planecut writes: by planecut itself, and trees by OpenSCAD."""

import subprocess
from pathlib import Path

import trimesh

from .assets import MODELS, Asset
from .measure import Surface, Volume, compare
from .meshes import SINGLE
from .planecut import Planecut, Refused
from .setting import Setting

MAX_TRIANGLES = 3000
"""Above which OpenSCAD, whose time grows fast, is asked in full runs only."""

TIMEOUT = 120
"""Seconds that OpenSCAD is given for a tree; ten times as many in full runs."""

OPENSCAD_GRID = 1e-9
"""Part of the largest coordinate by which OpenSCAD may move a corner; it merges corners that are nearly one."""


def check_round_trip(setting: Setting, asset: Asset, openscad: str | None) -> list[Volume]:
    """The volumes that are found in a map or a tree; what is amiss goes to `setting`."""
    if asset.ending not in MODELS:
        return []
    volumes = []
    try:
        volumes.append(_by_planecut(setting.planecut, asset))
    except Refused as refused:
        setting.fail(asset.where, f"planecut reads it back: {refused}")
    solid = asset.report["mesh"]["triangles"]
    if openscad and asset.ending == "csg" and solid and (setting.full or solid <= MAX_TRIANGLES):
        found = _by_openscad(setting, asset, openscad)
        volumes += [found] if found else []
    for volume in volumes:
        if volume.amiss:
            setting.fail(asset.where, volume)
    return volumes


def _by_planecut(planecut: Planecut, asset: Asset) -> Volume:
    solid = planecut.info(asset.path)["solid"]
    extent = max(abs(value) for end in ("min", "max") for value in solid[end]) if solid["volume"] else 0.0
    return compare(asset.where, "planecut", Surface(solid["volume"], solid["area"], extent), asset.report, 0.0)


def _by_openscad(setting: Setting, asset: Asset, openscad: str) -> Volume | None:
    """Through binary STL: all other formats of OpenSCAD have six digits."""
    mesh = asset.path.with_name(asset.path.name + ".openscad.stl")
    command = [openscad, "--export-format", "binstl", "-o", str(mesh), str(asset.path)]
    seconds = TIMEOUT * (10 if setting.full else 1)
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        setting.note(f"{asset.where}: OpenSCAD came to no end within {seconds} s")
        return None
    lines = done.stderr.splitlines()
    # cells that share part of a wall leave cracks on its grid: it warns of those and goes on, and the volume tells
    for warning in [line for line in lines if line.startswith("WARNING")][:1]:
        setting.note(f"{asset.where}: OpenSCAD: {warning}")
    complaints = [line for line in lines if line.startswith("ERROR")]
    if done.returncode != 0 or complaints or not _has_triangles(mesh):
        said = complaints or [f"exit status {done.returncode}", "no triangles"][done.returncode == 0 :]
        setting.fail(asset.where, f"OpenSCAD: {said[0]}")
    if not _has_triangles(mesh):
        return None
    read = trimesh.load_mesh(mesh, process=False)
    found = Surface.of(read.vertices, read.faces)
    return compare(asset.where, "OpenSCAD", found, asset.report, found.extent * (SINGLE + OPENSCAD_GRID))


def _has_triangles(mesh: Path) -> bool:
    return mesh.exists() and mesh.stat().st_size > 84
