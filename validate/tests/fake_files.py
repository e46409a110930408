"""Writes meshes as `planecut` does: OBJ with one object, GLB with one mesh node per piece."""

import json
import stat
import struct
import sys
from pathlib import Path

import numpy as np

from planecut_validate.mesh import Mesh


def write_obj(pieces: list[Mesh], path: Path) -> None:
    """One object per piece."""
    lines, base = [], 1
    for number, mesh in enumerate(pieces):
        lines += [f"o piece {number}\n"] + [f"v {x!r} {y!r} {z!r}\n" for x, y, z in mesh.vertices.tolist()]
        lines += [f"f {a} {b} {c}\n" for a, b, c in (mesh.triangles + base).tolist()]
        base += len(mesh.vertices)
    path.write_text("".join(lines))


def write_glb(pieces: list[Mesh], path: Path) -> None:
    """One mesh node per piece; a single one with merged topology."""
    pieces = [mesh for mesh in pieces if len(mesh.triangles)]
    if len(pieces) == 1:
        _write_skin(pieces[0], path)
    else:
        _write_pieces(pieces, path)


def _write_pieces(pieces: list[Mesh], path: Path) -> None:
    """One mesh node each, Y up by the node above them."""
    views, accessors = [], []
    for mesh in pieces:
        views += [mesh.vertices.astype("<f4").tobytes(), mesh.triangles.astype("<u4").tobytes()]
        accessors += [
            {"bufferView": len(accessors), "componentType": 5126, "type": "VEC3", "count": len(mesh.vertices)},
            {"bufferView": len(accessors) + 1, "componentType": 5125, "type": "SCALAR", "count": mesh.triangles.size},
        ]
    count = len(pieces)
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": list(range(1, count + 1)), "rotation": [-(0.5**0.5), 0, 0, 0.5**0.5]}]
        + [{"mesh": i} for i in range(count)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 2 * i}, "indices": 2 * i + 1}]} for i in range(count)],
        "accessors": accessors,
    }
    _pack(document, views, path)


def _pack(document: dict, pieces: list[bytes], path: Path) -> None:
    starts = np.cumsum([0] + [len(p) for p in pieces]).tolist()
    document["bufferViews"] = [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, pieces)]
    document["buffers"] = [{"byteLength": starts[-1]}]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(pieces)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary))
    chunks = [(b"JSON", text), (b"BIN\0", binary)]
    path.write_bytes(header + b"".join(struct.pack("<I4s", len(data), kind) + data for kind, data in chunks))


def _write_skin(mesh: Mesh, path: Path) -> None:
    """Two primitives that share no vertex, Y up by the node's rotation, merged again by `EXT_mesh_manifold`."""
    used, flat = np.unique(mesh.triangles, return_inverse=True)
    flat = flat.reshape(-1)
    half = 3 * (len(mesh.triangles) // 2)
    split = flat + np.where(np.arange(len(flat)) < half, 0, len(used))
    points = np.tile(mesh.vertices[used].astype("<f4"), (2, 1))
    where = np.arange(half, len(flat), dtype="<u4")
    pieces = [points.tobytes(), split.astype("<u4").tobytes(), where.tobytes(), flat[half:].astype("<u4").tobytes()]
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
        "meshes": [
            {
                "primitives": [{"attributes": {"POSITION": 0}, "indices": i} for i in (1, 2)],
                "extensions": {
                    "EXT_mesh_manifold": {
                        "manifoldPrimitive": {"attributes": {"POSITION": 0}, "indices": 3},
                        "mergeIndices": 4,
                        "mergeValues": 5,
                    }
                },
            }
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(points)},
            indices | {"count": half},
            indices | {"count": len(flat) - half, "byteOffset": 4 * half},
            indices | {"count": len(flat), "sparse": sparse},
            indices | {"count": len(where), "bufferView": 2},
            indices | {"count": len(where), "bufferView": 3},
        ],
    }
    _pack(document, pieces, path)


def fake_program(folder: Path) -> Path:
    """A program in the folder that takes planecut's command line and writes what manifold3d makes of the model."""
    program = folder / "planecut"
    program.write_text(f"#!/bin/sh\nexec '{sys.executable}' '{Path(__file__).with_name('fake_planecut.py')}' \"$@\"\n")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    return program
