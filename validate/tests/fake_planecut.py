"""Stands in for `planecut build`, with manifold3d's union as the mesh, so that the checks can be tried on known damage.

`FAKE_DAMAGE` names what to do to the mesh before it is written; see `DAMAGES`.
"""

import argparse
import json
import os
import struct
import sys
from pathlib import Path

import manifold3d
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from planecut_validate.mesh import Mesh  # noqa: E402
from planecut_validate.model import load  # noqa: E402


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("command", choices=["build"])
    parser.add_argument("input", type=Path)
    parser.add_argument("-o", action="append", type=Path, default=[])
    parser.add_argument("--report", type=Path)
    parser.add_argument("--threads", type=int)
    parser.add_argument("--quiet", action="store_true")
    arguments = parser.parse_args()
    try:
        model = load(arguments.input)
    except ValueError as error:
        print(f"error: {arguments.input}: {error}", file=sys.stderr)
        return 2
    if model.is_empty:
        print(f"error: {arguments.input}: no solid brush", file=sys.stderr)
        return 1
    union = manifold3d.Manifold.batch_boolean(model.hulls, manifold3d.OpType.Add).to_mesh64()
    mesh = Mesh(np.array(union.vert_properties)[:, :3], _merged(union))
    report = _report(model, mesh)
    mesh = DAMAGES[os.environ.get("FAKE_DAMAGE", "none")](mesh, report)
    for path in arguments.o:
        (_write_obj if path.suffix == ".obj" else _write_glb)(mesh, path)
    if arguments.report:
        arguments.report.write_text(json.dumps(report))
    return 0


def _merged(union) -> np.ndarray:
    merged = np.arange(len(union.vert_properties))
    merged[np.array(union.merge_from_vert, dtype=np.int64)] = np.array(union.merge_to_vert, dtype=np.int64)
    return merged[np.array(union.tri_verts, dtype=np.int64)]


def _report(model, mesh: Mesh) -> dict:
    return {
        "model": {"brushes": model.brushes, "brush_volume_sum": model.brush_volume_sum},
        "solid": {
            "volume": mesh.volume(),
            "area": mesh.area(),
            "centroid": mesh.centroid().tolist(),
            "min": model.low.tolist(),
            "max": model.high.tolist(),
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


def _write_obj(mesh: Mesh, path: Path) -> None:
    lines = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in mesh.vertices.tolist()]
    lines += [f"f {a} {b} {c}\n" for a, b, c in (mesh.triangles + 1).tolist()]
    path.write_text("".join(lines))


def _write_glb(mesh: Mesh, path: Path) -> None:
    """Two primitives that share no vertex, Y up by the node's rotation, merged again by `EXT_mesh_manifold`."""
    used, flat = np.unique(mesh.triangles, return_inverse=True)
    flat = flat.reshape(-1)
    half = 3 * (len(mesh.triangles) // 2)
    split = flat + np.where(np.arange(len(flat)) < half, 0, len(used))
    points = np.tile(mesh.vertices[used].astype("<f4"), (2, 1))
    where = np.arange(half, len(flat), dtype="<u4")
    pieces = [points.tobytes(), split.astype("<u4").tobytes(), where.tobytes(), flat[half:].astype("<u4").tobytes()]
    starts = np.cumsum([0] + [len(p) for p in pieces]).tolist()
    indices = {"bufferView": 1, "componentType": 5125, "type": "SCALAR"}
    sparse = {
        "count": len(where),
        "indices": {"bufferView": 2, "componentType": 5125},
        "values": {"bufferView": 3},
    }
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "rotation": [-(0.5**0.5), 0, 0, 0.5**0.5]}, {"mesh": 0}],
        "meshes": [{
            "primitives": [{"attributes": {"POSITION": 0}, "indices": i} for i in (1, 2)],
            "extensions": {"EXT_mesh_manifold": {
                "manifoldPrimitive": {"attributes": {"POSITION": 0}, "indices": 3}, "mergeIndices": 4, "mergeValues": 5,
            }},
        }],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(points)},
            indices | {"count": half},
            indices | {"count": len(flat) - half, "byteOffset": 4 * half},
            indices | {"count": len(flat), "sparse": sparse},
            indices | {"count": len(where), "bufferView": 2},
            indices | {"count": len(where), "bufferView": 3},
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, pieces)],
        "buffers": [{"byteLength": starts[-1]}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(pieces)
    length = 12 + 8 + len(text) + 8 + len(binary)
    header = struct.pack("<4sII", b"glTF", 2, length)
    chunks = [(b"JSON", text), (b"BIN\0", binary)]
    path.write_bytes(header + b"".join(struct.pack("<I4s", len(data), kind) + data for kind, data in chunks))


if __name__ == "__main__":
    sys.exit(main())
