"""What a glTF file says of itself, without a library: JSON, accessors, where nodes are."""

import base64
import json
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

_TYPES = {5120: "i1", 5121: "u1", 5122: "i2", 5123: "u2", 5125: "u4", 5126: "f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass(frozen=True)
class GltfFile:
    """The JSON part and the one buffer."""

    json: dict
    buffer: bytes

    @classmethod
    def read(cls, path: Path) -> "GltfFile":
        """A .glb, or a .gltf that holds its buffer."""
        data = path.read_bytes()
        if data[:4] != b"glTF":
            document = json.loads(data)
            uri = document.get("buffers", [{}])[0].get("uri", ",")
            return cls(document, base64.b64decode(uri.split(",", 1)[1]))
        length = struct.unpack_from("<I", data, 12)[0]
        return cls(json.loads(data[20 : 20 + length]), data[20 + length + 8 :])

    @property
    def compressed(self) -> bool:
        """Whether the buffer has to be unpacked before accessors can be read."""
        return any("extensions" in view for view in self.json.get("bufferViews", []))

    def placed_meshes(self) -> list[tuple[dict, np.ndarray]]:
        """The meshes of the scene with the matrices that put them into the world."""
        found = []

        def visit(number: int, parent: np.ndarray) -> None:
            node = self.json["nodes"][number]
            matrix = parent @ _local(node)
            if "mesh" in node:
                found.append((self.json["meshes"][node["mesh"]], matrix))
            for child in node.get("children", []):
                visit(child, matrix)

        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            visit(root, np.eye(4))
        return found

    def half_step(self) -> float:
        """Largest distance, along any axis of the world, that rounding to the type of positions can move a vertex."""
        return max((self._half_step(mesh, matrix) for mesh, matrix in self.placed_meshes()), default=0.0)

    def _half_step(self, mesh: dict, matrix: np.ndarray) -> float:
        accessor = self.json["accessors"][mesh["primitives"][0]["attributes"]["POSITION"]]
        scale = float(np.abs(matrix[:3, :3]).sum(axis=1).max())
        if accessor["componentType"] != 5126:
            return 0.5 * scale * _unit(accessor)
        return scale * float(np.max(np.abs([accessor["min"], accessor["max"]]))) * 2.0**-24

    def array(self, number: int) -> np.ndarray:
        """The numbers of an accessor, normalised ones as fractions; a row for each element of more than one."""
        accessor = self.json["accessors"][number]
        values = self._dense(accessor, accessor["count"])
        if "sparse" in accessor:
            sparse, values = accessor["sparse"], values.copy()
            places = self._dense({**sparse["indices"], "type": "SCALAR"}, sparse["count"])
            values[places] = self._dense({**accessor, "byteOffset": 0, **sparse["values"]}, sparse["count"])
        return values * _unit(accessor) if accessor.get("normalized") else values

    def _dense(self, accessor: dict, count: int) -> np.ndarray:
        kind, width = np.dtype("<" + _TYPES[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        shape = (count,) if width == 1 else (count, width)
        if "bufferView" not in accessor:
            return np.zeros(shape, kind)
        view = self.json["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", kind.itemsize * width)
        strides = (stride,) if width == 1 else (stride, kind.itemsize)
        return np.ndarray(shape, kind, self.buffer, start, strides)


def _unit(accessor: dict) -> float:
    """What one step of an accessor's integers stands for."""
    return 1.0 / np.iinfo(_TYPES[accessor["componentType"]]).max if accessor.get("normalized") else 1.0


def _local(node: dict) -> np.ndarray:
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(turn) * node.get("scale", (1.0, 1.0, 1.0))
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix
