"""MuJoCo takes the files as they are, one for each cell."""

import xml.etree.ElementTree as xml
from dataclasses import dataclass
from pathlib import Path

import mujoco

from .bodies import read_bodies
from .decompositions import INPUTS
from .entrant import planecut_files
from .setting import Setting

_INPUT, _CELLS = "lego", 10


@dataclass(frozen=True)
class MuJoCoCell:
    """A cell's corners as written and those of MuJoCo's hull; its volume, and the relative difference of MuJoCo's."""

    corners: int
    corners_in_mujoco: int
    volume: float
    difference: float


def measure_mujoco(setting: Setting) -> list[MuJoCoCell]:
    """Each cell as the mesh of a body of density 1, so that its mass is its volume."""
    folder = setting.scratch / "mujoco"
    folder.mkdir()
    files = planecut_files(setting.binary, setting.data / INPUTS[_INPUT], folder, "--max-cells", str(_CELLS))
    model = mujoco.MjModel.from_xml_string(_scene(files))
    cells = []
    for number, file in enumerate(files):
        (body,) = read_bodies(file)
        volume = body.hull().volume()
        # Body 0 is the world; a mesh's graph starts with the number of its hull's corners.
        mass = float(model.body_mass[1 + number])
        corners = int(model.mesh_graph[model.mesh_graphadr[number]])
        cells.append(MuJoCoCell(len(body.corners), corners, volume, mass / volume - 1.0))
        print(cells[-1], flush=True)
    return cells


def _scene(files: list[Path]) -> str:
    """A body for each file."""
    root = xml.Element("mujoco")
    assets, world = xml.SubElement(root, "asset"), xml.SubElement(root, "worldbody")
    for file in files:
        xml.SubElement(assets, "mesh", name=file.stem, file=str(file), inertia="convex")
        body = xml.SubElement(world, "body")
        xml.SubElement(body, "freejoint")
        xml.SubElement(body, "geom", type="mesh", mesh=file.stem, density="1")
    return xml.tostring(root, encoding="unicode")
