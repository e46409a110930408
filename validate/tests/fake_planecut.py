"""Stands in for `planecut build`, with manifold3d's solid as the mesh, so that the checks can be tried on known damage.

`FAKE_DAMAGE` names what to do to the mesh before it is written; see `DAMAGES`, `CELL_DAMAGES` and `OPERATION_DAMAGES`.
"""

import argparse
import json
import os
import sys
from pathlib import Path

import manifold3d
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from fake_files import write_glb, write_obj  # noqa: E402

from planecut_validate.leaf import manifold_of, mesh_of  # noqa: E402
from planecut_validate.mesh import Mesh  # noqa: E402
from planecut_validate.model import load  # noqa: E402
from planecut_validate.solid_tree import SolidTree  # noqa: E402
from planecut_validate.tree_model import TreeModel  # noqa: E402


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("command", choices=["build"])
    parser.add_argument("input", type=Path)
    parser.add_argument("-o", action="append", type=Path, default=[])
    parser.add_argument("--report", type=Path)
    parser.add_argument("--threads", type=int)
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--cells", action="store_true")
    arguments = parser.parse_args()
    try:
        model = load(arguments.input)
    except ValueError as error:
        print(f"error: {arguments.input}: {error}", file=sys.stderr)
        return 2
    if model.is_unbounded or (model.is_empty and model.empty_may_be_refused):
        print(f"error: {arguments.input}: nothing that has a mesh", file=sys.stderr)
        return 1
    damage = os.environ.get("FAKE_DAMAGE", "none")
    mesh = mesh_of(_solid(model, damage))
    report = _report(model, mesh)
    if arguments.cells:
        pieces = CELL_DAMAGES.get(damage, lambda cells: cells)(_cells(model))
        report["solid"]["cells"] = len(pieces)
    else:
        mesh = DAMAGES.get(damage, _none)(mesh, report)
        pieces = [mesh]
    for path in arguments.o:
        (write_obj if path.suffix == ".obj" else write_glb)(pieces, path)
    if arguments.report:
        arguments.report.write_text(json.dumps(report))
    return 0


def _solid(model, damage: str) -> manifold3d.Manifold:
    if damage in OPERATION_DAMAGES:
        wrong = SolidTree(model.tree.leaves, OPERATION_DAMAGES[damage](model.tree.nodes))
        return TreeModel(wrong).solid()
    return (
        manifold3d.Manifold.batch_boolean(model.hulls, manifold3d.OpType.Add)
        if hasattr(model, "hulls")
        else model.solid()
    )


def _cells(model) -> list[Mesh]:
    """A grid through all coordinates of a solid of boxes along the axes: each cell of it that lies inside."""
    mesh = mesh_of(_solid(model, "none"))
    axes = [np.unique(np.round(mesh.vertices[:, k], 9)) for k in range(3)]
    solid = manifold_of(mesh) if len(mesh.triangles) else manifold3d.Manifold()
    cells = []
    for x0, x1 in zip(axes[0], axes[0][1:]):
        for y0, y1 in zip(axes[1], axes[1][1:]):
            for z0, z1 in zip(axes[2], axes[2][1:]):
                box = manifold3d.Manifold.cube([x1 - x0, y1 - y0, z1 - z0]).translate([x0, y0, z0])
                if (box ^ solid).volume() > 0.5 * box.volume():
                    cells.append(mesh_of(box))
    return cells


def _report(model, mesh: Mesh) -> dict:
    used = mesh.vertices if len(mesh.triangles) else np.zeros((1, 3))
    return {
        "model": {"brushes": model.brushes, "brush_volume_sum": getattr(model, "brush_volume_sum", None)},
        "solid": {
            "volume": mesh.volume(),
            "area": mesh.area(),
            "centroid": mesh.centroid().tolist() if len(mesh.triangles) else None,
            "min": used.min(0).tolist(),
            "max": used.max(0).tolist(),
            "cells": None,
        },
        "mesh": {
            "vertices": len(mesh.vertices),
            "triangles": len(mesh.triangles),
            "components": mesh.components(),
            "genus": mesh.genus(),
            "watertight": True,
            "manifold": True,
            "volume": mesh.volume(),
        },
        "time_ms": {"total": 0.0},
        "warnings": [] if len(mesh.triangles) else ["nothing is left"],
    }


def _none(mesh: Mesh, report: dict) -> Mesh:
    return mesh


def _removed_triangle(mesh: Mesh, report: dict) -> Mesh:
    return Mesh(mesh.vertices, mesh.triangles[1:])


def _flipped_triangle(mesh: Mesh, report: dict) -> Mesh:
    triangles = mesh.triangles.copy()
    triangles[0] = triangles[0][::-1]
    return Mesh(mesh.vertices, triangles)


def _moved_vertex(mesh: Mesh, report: dict) -> Mesh:
    """Moved by a thousandth of the model's size, which no count and no flag can tell."""
    vertices = mesh.vertices.copy()
    vertices[mesh.triangles[0, 0]] += 1e-3 * (vertices.max(0) - vertices.min(0))
    return Mesh(vertices, mesh.triangles)


def _membrane(mesh: Mesh, report: dict) -> Mesh:
    """Adds a closed sheet without a volume across the model, with a report that tells of it."""
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    middle = 0.5 * (low + high) + 0.01 * (high - low)
    corners = np.array([[low[0], low[1], middle[2]], [high[0], low[1], middle[2]], [middle[0], high[1], middle[2]]])
    base = len(mesh.vertices)
    sheet = base + np.array([[0, 1, 2], [2, 1, 0]])
    return _retold(Mesh(np.concatenate([mesh.vertices, corners]), np.concatenate([mesh.triangles, sheet])), report)


def _bubble(mesh: Mesh, report: dict) -> Mesh:
    """Adds an inverted tetrahedron at one corner of the box and the same outward at another: no volume in sum."""
    low, high = mesh.vertices.min(0), mesh.vertices.max(0)
    corner = np.vstack([np.zeros(3), 0.2 * np.diag(high - low)])
    outward = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    base = len(mesh.vertices)
    vertices = np.concatenate([mesh.vertices, low + corner, low + 0.3 * (high - low) + corner])
    triangles = np.concatenate([mesh.triangles, base + outward, base + 4 + outward[:, ::-1]])
    return _retold(Mesh(vertices, triangles), report)


def _doubled_surface(mesh: Mesh, report: dict) -> Mesh:
    """Every triangle written twice, the vertices once."""
    return _retold(Mesh(mesh.vertices, np.concatenate([mesh.triangles] * 2)), report, topology=False)


def _wrong_report(mesh: Mesh, report: dict) -> Mesh:
    report["solid"]["volume"] *= 1.0 + 1e-8
    return mesh


def _not_watertight(mesh: Mesh, report: dict) -> Mesh:
    report["mesh"]["watertight"] = False
    return mesh


def _retold(mesh: Mesh, report: dict, topology: bool = True) -> Mesh:
    """The mesh, and in the report what can be said of it, except volumes."""
    told = {"vertices": len(mesh.vertices), "triangles": len(mesh.triangles)}
    if topology:
        told |= {"components": mesh.components(), "genus": mesh.genus()}
    report["mesh"] |= told
    report["solid"] |= {"area": mesh.area(), "centroid": mesh.centroid().tolist()}
    return mesh


DAMAGES = {
    "none": _none,
    "removed triangle": _removed_triangle,
    "flipped triangle": _flipped_triangle,
    "moved vertex": _moved_vertex,
    "membrane": _membrane,
    "bubble": _bubble,
    "doubled surface": _doubled_surface,
    "wrong report": _wrong_report,
    "not watertight": _not_watertight,
}


def _without_first(cells: list[Mesh]) -> list[Mesh]:
    return cells[1:]


def _grown(cells: list[Mesh]) -> list[Mesh]:
    """The first cell reaches into its neighbours."""
    first = cells[0]
    middle = first.vertices.mean(0)
    return [Mesh(middle + 1.1 * (first.vertices - middle), first.triangles), *cells[1:]]


def _dented(cells: list[Mesh]) -> list[Mesh]:
    """A corner of the first cell is pushed in."""
    vertices = cells[0].vertices.copy()
    vertices[0] += 0.6 * (vertices.mean(0) - vertices[0])
    return [Mesh(vertices, cells[0].triangles), *cells[1:]]


def _twice(cells: list[Mesh]) -> list[Mesh]:
    return [*cells, cells[-1]]


CELL_DAMAGES = {"missing cell": _without_first, "grown cell": _grown, "dented cell": _dented, "doubled cell": _twice}


def _turned(old: str, new: str):
    """The first operation of one kind becomes another."""

    def turn(nodes: list) -> list:
        at = next(i for i, (kind, _) in enumerate(nodes) if kind == old)
        return [*nodes[:at], (new, nodes[at][1]), *nodes[at + 1 :]]

    return turn


OPERATION_DAMAGES = {
    "union for xor": _turned("xor", "union"),
    "union for difference": _turned("difference", "union"),
    "difference for intersection": _turned("intersection", "difference"),
}


if __name__ == "__main__":
    sys.exit(main())
