"""All checks of one model."""

import math
import tempfile
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

import manifold3d
import numpy as np

from . import line_oracle, process
from .glb_file import read_glb
from .mesh import Mesh
from .model import ReferenceModel, load
from .obj_file import read_obj

SAME = 1e-9
"""Largest relative difference between two ways to one number."""


@dataclass
class Result:
    """The row of one model. `failures` is empty where everything agrees; the other fields are what the table shows."""

    model: str
    status: str = "ok"
    failures: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    brushes: int = 0
    reference_volume: float = math.nan
    differences: dict[str, float] = field(default_factory=dict)
    triangles: int = 0
    lines: dict = field(default_factory=dict)
    seconds: float = 0.0

    def same(self, name: str, value: float | None, expected: float, scale: float | None = None) -> None:
        """Notes the relative difference of two numbers, and a failure where it is too large or a number is missing."""
        if value is None:
            self.failures.append(f"{name}: not in the report")
            return
        scale = abs(expected) if scale is None else scale
        difference = abs(value - expected) / scale if scale else abs(value - expected)
        self.differences[name] = difference
        if not difference <= SAME:
            self.failures.append(f"{name}: {value!r}, expected {expected!r} (relative difference {difference:.1e})")

    def equal(self, name: str, value, expected) -> None:
        """Notes a failure where two things are not the same."""
        if value != expected:
            self.failures.append(f"{name}: {value!r}, expected {expected!r}")


def check(path: Path, binary: str, lines: int, seed: int) -> Result:
    """Runs planecut on one model and checks everything it wrote. Does not raise for faults of planecut's."""
    result = Result(str(path))
    begin = time.perf_counter()
    try:
        model = load(path)
    except ValueError as error:
        model = None
        result.notes.append(f"reference reader: {error}")
    with tempfile.TemporaryDirectory(prefix="planecut-validate-") as folder:
        try:
            _check_build(result, model, process.build(binary, path, Path(folder)), lines, seed)
        except process.Refused as refusal:
            _judge_refusal(result, model, str(refusal))
        except process.Broken as fault:
            result.failures.append(str(fault))
        except (ValueError, KeyError, IndexError) as fault:
            result.failures.append(f"cannot be read: {fault!r}")
    if result.failures:
        result.status = "FAIL"
    result.seconds = time.perf_counter() - begin
    return result


def _judge_refusal(result: Result, model: ReferenceModel | None, message: str) -> None:
    """A refusal is right where the reference cannot make a solid of the file either."""
    if model is not None and not model.is_empty:
        result.failures.append(message)
    else:
        result.status = "refused"
        result.notes.append(message)


def _check_build(result: Result, model: ReferenceModel | None, build: process.Build, lines: int, seed: int) -> None:
    if model is None:
        result.failures.append("taken by planecut, not by the reference reader")
        return
    result.brushes = model.brushes
    result.notes += model.notes
    mesh = read_obj(build.obj)
    result.triangles = len(mesh.triangles)
    result.equal("model.brushes", _get(build.report, "model", "brushes"), model.brushes)
    if model.is_empty:
        result.status = "empty"
        result.equal("triangles of an empty model", len(mesh.triangles), 0)
        return
    if not len(mesh.triangles):
        result.failures.append("the mesh is empty")
        return
    _check_measures(result, model, mesh, build.report)
    _check_topology(result, mesh, build.report)
    _check_manifold3d(result, mesh)
    _check_glb(result, mesh, build.glb)
    report = line_oracle.compare(model, mesh, lines, seed)
    result.lines = asdict(report)
    if report.mismatches:
        result.failures.append(f"{report.mismatches} of {lines} lines differ; {report.examples[0]}")


def _get(report: dict, *keys: str):
    """A value of the report, or nothing where it is not there."""
    for key in keys:
        report = report.get(key) if isinstance(report, dict) else None
    return report


def _check_measures(result: Result, model: ReferenceModel, mesh: Mesh, report: dict) -> None:
    """Volumes from three sides, and the smaller measures that come with them."""
    try:
        answer = model.volume()
    except ArithmeticError as error:
        result.failures.append(str(error))
        return
    reference = result.reference_volume = answer.volume
    if answer.spread() > SAME:
        result.notes.append(f"manifold3d's union depends on the order by {answer.spread():.0e}")
    result.same("solid.volume", _get(report, "solid", "volume"), reference)
    result.same("OBJ volume", mesh.volume(), reference)
    result.same("mesh.volume", _get(report, "mesh", "volume"), reference)
    brush_sum = _get(report, "model", "brush_volume_sum")
    if brush_sum is not None:
        result.same("model.brush_volume_sum", brush_sum, model.brush_volume_sum)
    # manifold3d's own union keeps some inner membranes, so the area is held against the mesh that was written.
    result.same("solid.area", _get(report, "solid", "area"), mesh.area())
    size = float(np.linalg.norm(model.high - model.low))
    used = mesh.vertices[np.unique(mesh.triangles)]
    for name, expected in (("min", model.low), ("max", model.high), ("centroid", mesh.centroid())):
        values = _get(report, "solid", name)
        for axis, value in zip("xyz", values or [None] * 3):
            result.same(f"solid.{name}.{axis}", value, float(expected["xyz".index(axis)]), size)
    for name, found, expected in (("low", used.min(0), model.low), ("high", used.max(0), model.high)):
        result.same(f"OBJ {name} corner", float(np.abs(found - expected).max()), 0.0, size)


def _check_topology(result: Result, mesh: Mesh, report: dict) -> None:
    """The report's flags and counts against the indices of the OBJ."""
    result.equal("mesh.watertight", _get(report, "mesh", "watertight"), True)
    result.equal("mesh.manifold", _get(report, "mesh", "manifold"), True)
    result.equal("mesh.vertices", _get(report, "mesh", "vertices"), len(mesh.vertices))
    result.equal("mesh.triangles", _get(report, "mesh", "triangles"), len(mesh.triangles))
    faults = mesh.twin_faults()
    if faults:
        result.failures.append("OBJ: " + ", ".join(f"{count} {name}" for name, count in faults.items()))
        return
    result.equal("mesh.components", _get(report, "mesh", "components"), mesh.components())
    result.equal("mesh.genus", _get(report, "mesh", "genus"), mesh.genus())


def _check_manifold3d(result: Result, mesh: Mesh) -> None:
    """manifold3d must take the OBJ, by its indices, and leave its volume alone."""
    triangles = np.ascontiguousarray(mesh.triangles, dtype=np.uint64)
    taken = manifold3d.Manifold(manifold3d.Mesh64(np.ascontiguousarray(mesh.vertices), triangles))
    if taken.status() != manifold3d.Error.NoError:
        result.failures.append(f"manifold3d refuses the OBJ: {taken.status().name}")
        return
    result.same("volume as manifold3d takes it", taken.volume(), mesh.volume())


def _check_glb(result: Result, mesh: Mesh, path: Path) -> None:
    """The GLB holds the same solid, in single precision; its merged topology, where it has one, is manifold."""
    scene = read_glb(path)
    # Each coordinate moves by half a unit in the last place at most; the volume by that times the area.
    shift = 2.0**-24 * np.abs(mesh.vertices).max() * math.sqrt(3.0)
    tolerance = shift * mesh.area() + SAME * abs(mesh.volume())
    difference = abs(scene.mesh.volume() - mesh.volume())
    result.differences["GLB volume"] = difference / abs(mesh.volume())
    if not difference <= tolerance:
        result.failures.append(f"GLB: volume {scene.mesh.volume()!r}, expected {mesh.volume()!r} ± {tolerance:.1e}")
    # A triangle whose corners fall together in single precision may be left out, no other.
    corners = mesh.vertices.astype(np.float32)[mesh.triangles]
    distinct = np.logical_and.reduce([(corners[:, i] != corners[:, i - 1]).any(1) for i in range(3)])
    if not distinct.sum() <= len(scene.mesh.triangles) <= len(mesh.triangles):
        result.failures.append(f"GLB: {len(scene.mesh.triangles)} triangles, the OBJ has {len(mesh.triangles)}")
    for merged in scene.manifolds:
        if faults := merged.twin_faults():
            result.failures.append("GLB merged: " + ", ".join(f"{count} {name}" for name, count in faults.items()))
    if scene.manifolds:
        result.equal("GLB merged triangles", sum(len(m.triangles) for m in scene.manifolds), len(scene.mesh.triangles))
