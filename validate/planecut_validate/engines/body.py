"""A body as it was written, and what is to hold of its files in any engine."""

import json
import pathlib
import subprocess
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from .shapes import Shape

# Single precision at the corners of a body, relative to its size.
SINGLE = 4e-7


@dataclass
class Body:
    shape: Shape
    folder: pathlib.Path
    report: dict

    @property
    def mass(self) -> dict:
        return self.report["coarsen"]["mass"]

    @property
    def cells(self) -> int:
        return self.report["coarsen"]["cells_out"]

    @property
    def boxes(self) -> int:
        return self.report["coarsen"]["boxes"]

    @property
    def inertia(self) -> np.ndarray:
        xx, yy, zz, xy, xz, yz = self.mass["inertia"]
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

    def file(self, ending: str) -> pathlib.Path:
        return self.folder / f"part.{ending}"

    def visual(self) -> np.ndarray:
        lines = (self.folder / "part_meshes" / "visual.obj").read_text().splitlines()
        return np.array([[float(value) for value in line.split()[1:4]] for line in lines if line.startswith("v ")])

    def size(self) -> float:
        return float(np.linalg.norm(np.ptp(self.visual(), axis=0)))


def write(planecut: str, shape: Shape, folder: pathlib.Path) -> Body:
    """Has the body of a shape written in all formats, on two threads and, unless it is large, on one, which must give the same bytes."""
    for threads in ("2",) if shape.is_large else ("1", "2"):
        own = folder / threads
        command = [planecut, "coarsen", str(shape.input), *shape.options, "--quiet"]
        command += ["--threads", threads, "--report", str(own / "r.json")]
        command += [word for ending in ("xml", "urdf", "usda") for word in ("-o", str(own / f"part.{ending}"))]
        subprocess.run(command, check=True, timeout=300)
    for path in sorted((folder / "1").rglob("*.*")):
        name = path.relative_to(folder / "1")
        if name.name != "r.json":
            assert path.read_bytes() == (folder / "2" / name).read_bytes(), f"{name} differs with the number of threads"
    return Body(shape, folder / "2", json.loads((folder / "2" / "r.json").read_text()))


def check_report(body: Body) -> None:
    """Boxes and volume are those that are known of a shape."""
    shape = body.shape
    if shape.boxes is not None:
        assert body.boxes == shape.boxes, f"{body.boxes} boxes, expected {shape.boxes}"
    if shape.volume is not None:
        assert abs(body.mass["volume"] / shape.volume - 1) < 1e-9, f"volume {body.mass['volume']}"


def check_enclosed(body: Body, colliders: list[np.ndarray]) -> None:
    """Every vertex that is seen lies in the hull of one of the colliders' corners."""
    points, size = body.visual(), body.size()
    inside = np.zeros(len(points), dtype=bool)
    for corners in colliders:
        planes = ConvexHull(corners - points.mean(axis=0)).equations
        inside |= (planes[:, :3] @ (points - points.mean(axis=0)).T + planes[:, 3:] <= SINGLE * size).all(axis=0)
    assert inside.all(), f"{(~inside).sum()} of {len(points)} vertices are outside"
