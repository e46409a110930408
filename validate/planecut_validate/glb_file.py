"""Reads the triangles of a binary glTF with the standard library and numpy."""

import json
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .mesh import Mesh

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TRIANGLES = 4


@dataclass
class GlbScene:
    """`mesh`: all primitives in place, nothing merged. `nodes`: the same by mesh nodes.

    `manifolds`: the merged meshes of `EXT_mesh_manifold`, if any.
    """

    mesh: Mesh
    nodes: list[Mesh]
    manifolds: list[Mesh]


def read_glb(path: Path) -> GlbScene:
    """The default scene of the file. Raises `ValueError` where it is no such file or uses what is not read here."""
    document, binary = _chunks(path.read_bytes())
    reader = _Reader(document, binary)
    scene = document["scenes"][document.get("scene", 0)]
    for node in scene.get("nodes", []):
        reader.node(node, np.eye(4))
    return GlbScene(_joined(reader.nodes), reader.nodes, reader.manifolds)


def _chunks(data: bytes) -> tuple[dict, bytes]:
    magic, version, length = struct.unpack_from("<4sII", data)
    if magic != b"glTF" or version != 2 or length != len(data):
        raise ValueError("not a binary glTF 2.0 of the length it names")
    chunks = {}
    at = 12
    while at < length:
        size, kind = struct.unpack_from("<I4s", data, at)
        if size % 4 or at + 8 + size > length:
            raise ValueError("a chunk that is not aligned or passes the end")
        chunks[kind] = data[at + 8 : at + 8 + size]
        at += 8 + size
    return json.loads(chunks[b"JSON"]), chunks.get(b"BIN\0", b"")


def _joined(meshes: list[Mesh]) -> Mesh:
    if not meshes:
        return Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    bases = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    vertices = np.concatenate([m.vertices for m in meshes])
    return Mesh(vertices, np.concatenate([m.triangles + base for m, base in zip(meshes, bases)]))


class _Reader:
    """Walks the nodes and collects meshes in world coordinates."""

    def __init__(self, document: dict, binary: bytes):
        self.document = document
        self.binary = binary
        self.nodes: list[Mesh] = []
        self.manifolds: list[Mesh] = []

    def node(self, index: int, parent: np.ndarray) -> None:
        node = self.document["nodes"][index]
        world = parent @ _matrix(node)
        if "mesh" in node:
            mesh = self.document["meshes"][node["mesh"]]
            self.nodes.append(_joined([self.primitive(p, world) for p in mesh["primitives"]]))
            extension = mesh.get("extensions", {}).get("EXT_mesh_manifold")
            if extension:
                self.manifolds.append(self.primitive(extension["manifoldPrimitive"], world))
        for child in node.get("children", []):
            self.node(child, world)

    def primitive(self, primitive: dict, world: np.ndarray) -> Mesh:
        if primitive.get("mode", _TRIANGLES) != _TRIANGLES:
            raise ValueError(f"a primitive of mode {primitive['mode']}, expected triangles")
        points = self.accessor(primitive["attributes"]["POSITION"]).astype(float)
        if "indices" in primitive:
            indices = self.accessor(primitive["indices"]).astype(np.int64).ravel()
        else:
            indices = np.arange(len(points))
        if len(indices) % 3 or (indices >= len(points)).any():
            raise ValueError("indices that are no triples or pass the last vertex")
        return Mesh(points @ world[:3, :3].T + world[:3, 3], indices.reshape(-1, 3))

    def accessor(self, index: int) -> np.ndarray:
        """`(count, width)`, sparse values put in."""
        accessor = self.document["accessors"][index]
        count, width = accessor["count"], _WIDTHS[accessor["type"]]
        if "bufferView" in accessor:
            values = self.view(accessor, accessor["componentType"], count, width).copy()
        else:
            values = np.zeros((count, width), dtype=_COMPONENTS[accessor["componentType"]])
        if sparse := accessor.get("sparse"):
            where = self.view(sparse["indices"], sparse["indices"]["componentType"], sparse["count"], 1).ravel()
            values[where] = self.view(sparse["values"], accessor["componentType"], sparse["count"], width)
        return values

    def view(self, source: dict, component: int, count: int, width: int) -> np.ndarray:
        view = self.document["bufferViews"][source["bufferView"]]
        dtype = np.dtype(_COMPONENTS[component])
        start = source.get("byteOffset", 0)
        stride = view.get("byteStride", dtype.itemsize * width)
        if count and start + stride * (count - 1) + dtype.itemsize * width > view["byteLength"]:
            raise ValueError("an accessor passes the end of its buffer view")
        shape, strides = (count, width), (stride, dtype.itemsize)
        return np.ndarray(shape, dtype, self.binary, view.get("byteOffset", 0) + start, strides)


def _matrix(node: dict) -> np.ndarray:
    """The node's local transform, 4 × 4."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0.0, 0.0, 0.0, 1.0])
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", [1.0, 1.0, 1.0]))
    matrix[:3, 3] = node.get("translation", [0.0, 0.0, 0.0])
    return matrix
