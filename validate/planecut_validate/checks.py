"""All checks of one model."""

import math
import tempfile
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np

from . import cells, line_oracle, process
from .glb_file import read_glb
from .known import Known, known
from .leaf import manifold_of
from .line_oracle import Drawn
from .mesh import Mesh
from .model import ReferenceModel, load
from .obj_file import read_obj, read_objects
from .result import SAME, Options, Result


def check(path: Path, options: Options) -> Result:
    """Runs planecut on one model and checks everything it wrote. Does not raise for faults of planecut's."""
    result = Result(str(path))
    begin = time.perf_counter()
    model = None
    try:
        model = load(path)
    except ValueError as error:
        result.notes.append(f"reference reader: {error}")
    except ArithmeticError as error:
        result.failures.append(f"reference: {error}")
    if not result.failures:
        with tempfile.TemporaryDirectory(prefix="planecut-validate-") as folder:
            _run(result, path, model, options, Path(folder))
    if result.failures:
        result.status = "FAIL"
    result.seconds = time.perf_counter() - begin
    return result


def _run(result: Result, path: Path, model: ReferenceModel | None, options: Options, folder: Path) -> None:
    """Builds skin and cells and checks both."""
    try:
        build = process.build(options.binary, path, folder)
        drawn = _check_build(result, model, build, options)
        if drawn is not None and options.cells:
            built = process.build(options.binary, path, folder, cells=True)
            _check_cells(result, model, built, read_obj(build.obj), drawn)
    except process.Refused as refusal:
        _judge_refusal(result, model, str(refusal))
    except process.Broken as fault:
        result.failures.append(str(fault))
    except (ValueError, KeyError, IndexError, ArithmeticError) as fault:
        result.failures.append(f"cannot be read: {fault!r}")


def _judge_refusal(result: Result, model: ReferenceModel | None, message: str) -> None:
    """A refusal is right where the reference cannot make a solid of the file either."""
    if model is None or model.is_unbounded or (model.is_empty and model.empty_may_be_refused):
        result.status = "refused"
        result.notes.append(message)
    else:
        result.failures.append(message)


def _check_build(result: Result, model: ReferenceModel | None, build: process.Build, options: Options) -> Drawn | None:
    """Checks the skin, and returns the lines that were drawn through the model."""
    if model is None or model.is_unbounded:
        result.failures.append(
            "taken by planecut, " + ("not by the reference reader" if model is None else "though it is unbounded")
        )
        return None
    result.brushes = model.brushes
    result.notes += model.notes
    mesh = read_obj(build.obj)
    result.triangles = len(mesh.triangles)
    if model.counts_brushes:
        result.equal("model.brushes", _get(build.report, "model", "brushes"), model.brushes)
    if model.is_empty:
        _check_empty(result, mesh, build)
    elif not len(mesh.triangles):
        result.failures.append("the mesh is empty")
    else:
        _check_measures(result, model, mesh, build.report)
        _check_topology(result, mesh, build.report)
        _check_manifold3d(result, mesh)
        if model.is_generic:
            _check_surface(result, model, mesh)
        _check_glb(result, mesh, build.glb)
    _check_known(result, model, mesh.volume(), known(Path(result.model), options.reference))
    drawn = line_oracle.draw(model, options.lines, options.seed)
    _note_lines(result, "lines", line_oracle.compare(drawn, mesh))
    return drawn


def _note_lines(result: Result, name: str, report: line_oracle.LineReport) -> None:
    setattr(result, name, asdict(report))
    if report.mismatches:
        result.failures.append(f"{name}: {report.mismatches} of {report.lines} lines differ; {report.examples[0]}")


def _get(report: dict, *keys: str):
    """A value of the report, or nothing where it is not there."""
    for key in keys:
        report = report.get(key) if isinstance(report, dict) else None
    return report


def _check_empty(result: Result, mesh: Mesh, build: process.Build) -> None:
    """An empty result is a result: no triangles, no volume, and a warning."""
    result.status = "empty"
    result.reference_volume = 0.0
    result.equal("triangles of an empty model", len(mesh.triangles), 0)
    result.equal("triangles of an empty model in the GLB", len(read_glb(build.glb).mesh.triangles), 0)
    result.equal("solid.volume", _get(build.report, "solid", "volume"), 0.0)
    if not _get(build.report, "warnings"):
        result.failures.append("an empty result without a warning")


def _check_measures(result: Result, model: ReferenceModel, mesh: Mesh, report: dict) -> None:
    """Volumes from three sides, and the smaller measures that come with them."""
    try:
        answer = model.volume(mesh.volume())
    except ArithmeticError as error:
        result.failures.append(str(error))
        return
    reference = result.reference_volume = answer.volume
    limit = model.limit
    if answer.spread() > limit:
        result.notes.append(f"manifold3d's ways differ by {answer.spread():.0e}")
    result.same("solid.volume", _get(report, "solid", "volume"), reference, limit=limit)
    result.same("OBJ volume", mesh.volume(), reference, limit=limit)
    result.same("mesh.volume", _get(report, "mesh", "volume"), reference, limit=limit)
    brush_sum = _get(report, "model", "brush_volume_sum")
    if brush_sum is not None and model.counts_brushes:
        result.same("model.brush_volume_sum", brush_sum, model.brush_volume_sum)
    # Where faces coincide, manifold3d keeps some inner membranes, so the area is held against the mesh that was written.
    result.same("solid.area", _get(report, "solid", "area"), mesh.area())
    if model.exact is not None:
        result.same("volume by cells of a grid", mesh.volume(), model.exact[0], limit=limit)
        result.same("area by cells of a grid", mesh.area(), model.exact[1], limit=limit)
    _check_box(result, model, mesh, report)


def _check_known(result: Result, model: ReferenceModel, volume: float, entry: Known | None) -> None:
    """The volume against one that is known from elsewhere; a difference is a note where manifold3d finds what planecut does."""
    if entry is None:
        return
    difference = abs(volume - entry.volume) / (abs(entry.volume) or 1.0)
    if difference <= entry.limit:
        result.differences["known volume"] = difference
        return
    told = f"known volume {entry.volume!r}, mesh {volume!r} (relative difference {difference:.1e})"
    if abs(volume - result.reference_volume) <= model.limit * abs(volume):
        result.notes.append(f"{told}; manifold3d agrees with the mesh")
    else:
        result.failures.append(told)


def _check_box(result: Result, model: ReferenceModel, mesh: Mesh, report: dict) -> None:
    """Bounding box and centroid."""
    size = float(np.linalg.norm(model.high - model.low))
    used = mesh.vertices[np.unique(mesh.triangles)]
    for name, expected in (("min", used.min(0)), ("max", used.max(0)), ("centroid", mesh.centroid())):
        values = _get(report, "solid", name)
        for axis, value in zip("xyz", values or [None] * 3):
            result.same(f"solid.{name}.{axis}", value, float(expected["xyz".index(axis)]), size)
    if model.box_is_exact:
        for name, found, expected in (("low", used.min(0), model.low), ("high", used.max(0), model.high)):
            result.same(f"OBJ {name} corner", float(np.abs(found - expected).max()), 0.0, size, limit=model.limit)


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
    try:
        result.same("volume as manifold3d takes it", manifold_of(mesh).volume(), mesh.volume())
    except ArithmeticError as error:
        result.failures.append(f"OBJ: {error}")


def _check_surface(result: Result, model: ReferenceModel, mesh: Mesh) -> None:
    """Area and, where it is settled, topology against manifold3d's own, where no faces coincide."""
    surface = model.surface()
    result.same("area", mesh.area(), surface.area, limit=model.limit)
    if model.is_simple and not mesh.twin_faults():
        result.equal("connected surfaces", mesh.components(), surface.components)
        result.equal("genus", mesh.genus(), surface.genus)


def _check_glb(result: Result, mesh: Mesh, path: Path) -> None:
    """The GLB holds the same solid, in single precision; its merged topology, where it has one, is manifold."""
    scene = read_glb(path)
    tolerance = _single_precision(mesh) + SAME * abs(mesh.volume())
    difference = abs(scene.mesh.volume() - mesh.volume())
    result.differences["GLB volume"] = difference / abs(mesh.volume())
    if not difference <= tolerance:
        result.failures.append(f"GLB: volume {scene.mesh.volume()!r}, expected {mesh.volume()!r} ± {tolerance:.1e}")
    # Triangles with an edge that single precision can hardly hold may be left out, no others.
    corners = mesh.vertices[mesh.triangles]
    spacing = 2.0**-22 * np.abs(mesh.vertices).max(initial=0.0)
    distinct = (np.abs(corners - np.roll(corners, 1, axis=1)).max(2) > spacing).all(1)
    if not distinct.sum() <= len(scene.mesh.triangles) <= len(mesh.triangles):
        result.failures.append(f"GLB: {len(scene.mesh.triangles)} triangles, the OBJ has {len(mesh.triangles)}")
    for merged in scene.manifolds:
        if faults := merged.twin_faults():
            result.failures.append("GLB merged: " + ", ".join(f"{count} {name}" for name, count in faults.items()))
    if scene.manifolds:
        result.equal("GLB merged triangles", sum(len(m.triangles) for m in scene.manifolds), len(scene.mesh.triangles))


def _single_precision(mesh: Mesh) -> float:
    """How far rounding to single precision moves a volume: each coordinate by half a unit in its last place, at most."""
    shift = 2.0**-24 * np.abs(mesh.vertices).max(initial=0.0) * math.sqrt(3.0)
    return shift * mesh.area()


def _check_cells(result: Result, model: ReferenceModel, build: process.Build, skin: Mesh, drawn: Drawn) -> None:
    """The cells by themselves, their sum against the skin, and their union against the model along the same lines."""
    found = read_objects(build.obj)
    report = cells.examine(found)
    result.cells = report.cells
    result.failures += report.faults[:_SHOWN]
    if report.slivers:
        result.notes.append(f"{report.slivers} cells thinner than rounding")
    if len(report.faults) > _SHOWN:
        result.failures.append(f"{len(report.faults) - _SHOWN} more faults of cells")
    result.equal("solid.cells", _get(build.report, "solid", "cells"), report.cells)
    result.equal("mesh nodes of the GLB", len(read_glb(build.glb).nodes), report.cells)
    if not model.is_empty and found:
        skin_volume = skin.volume()
        result.same("sum of cells", report.volume, skin_volume, abs(skin_volume), report.rounding)
        result.same(
            "solid.volume of cells",
            _get(build.report, "solid", "volume"),
            skin_volume,
            abs(skin_volume),
            report.rounding,
        )
    lines, doubled = cells.compare_lines(drawn, found)
    _note_lines(result, "cell_lines", lines)
    if doubled:
        result.failures.append(f"cells overlap on {doubled} lines")


_SHOWN = 3
"""Faults of cells that are told one by one."""
