"""A view of a solid that can be turned, for notebooks and pages: self-contained HTML."""

from __future__ import annotations

import base64
import html
import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._planecut import Coarsened, Mesh, Solid

_TEMPLATE = Path(__file__).with_name("view.html")
_COLORS = np.array([
    [0.62, 0.56, 0.48], [0.27, 0.42, 0.58], [0.62, 0.34, 0.20], [0.34, 0.47, 0.28], [0.48, 0.36, 0.52], [0.68, 0.54, 0.20],
])  # fmt: skip
"""Of materials without a colour, and of cells, in turn: red, green and blue."""
_SHARP = np.cos(np.radians(25.0))
"""Edges between faces are drawn where these turn by more."""


class _Triangles(NamedTuple):
    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    normals: NDArray[np.float64]
    colors: NDArray[np.float64]


class View:
    """A solid, mesh or set of cells that turns under the mouse: drag to turn, wheel to zoom, double click to begin again. It needs no network.

    Args:
        subject: A Solid, a Mesh, or a Coarsened, each cell of which has a colour of its own.
        size: Width and height in pixels.
    """

    def __init__(self, subject: Solid | Mesh | Coarsened, size: tuple[int, int] = (640, 480)) -> None:
        if isinstance(subject, Coarsened):
            self._triangles = _of_cells(subject)
        else:
            self._triangles = _of_mesh(subject if isinstance(subject, Mesh) else subject.mesh())
        self._size = (int(size[0]), int(size[1]))

    def to_html(self) -> str:
        """A page of its own."""
        vertices, triangles, normals, colors = self._triangles
        used = vertices[triangles.ravel()] if len(triangles) else np.zeros((1, 3))
        middle, size = (used.min(0) + used.max(0)) / 2.0, float(np.linalg.norm(np.ptp(used, axis=0))) or 1.0
        places = (vertices - middle) / size
        data = {
            "triangles": _packed(places[triangles]),
            "normals": _packed(np.repeat(normals[:, None, :], 3, axis=1)),
            "colors": _packed(np.repeat(colors[:, None, :], 3, axis=1)),
            "lines": _packed(places[_edges(triangles, normals)]),
        }
        return _TEMPLATE.read_text(encoding="utf-8").replace("/*DATA*/", json.dumps(data))

    def _repr_html_(self) -> str:
        width, height = self._size
        page = html.escape(self.to_html(), quote=True)
        return f'<iframe srcdoc="{page}" width="{width}" height="{height}" style="border: 0" sandbox="allow-scripts"></iframe>'

    def save(self, path: str | Path) -> None:
        """Writes the page to a file."""
        Path(path).write_text(self.to_html(), encoding="utf-8")


def _of_mesh(mesh: Mesh) -> _Triangles:
    own = np.nan_to_num(mesh.material_colors, nan=-1.0)
    derived = _COLORS[np.arange(len(own)) % len(_COLORS)]
    colors = np.where(own[:, :1] < 0.0, derived, own)
    return _Triangles(
        mesh.vertices, mesh.triangles.astype(np.int64), mesh.face_normals[mesh.face_ids], colors[mesh.material_ids]
    )


def _of_cells(cells: Coarsened) -> _Triangles:
    vertices, triangles, colors, count = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], [], 0
    for number, cell in enumerate(cells.cells):
        vertices.append(cell.vertices)
        triangles.append(cell.triangles.astype(np.int64) + count)
        colors.append(np.tile(_COLORS[number % len(_COLORS)], (len(cell.triangles), 1)))
        count += len(cell.vertices)
    places, corners = np.concatenate(vertices), np.concatenate(triangles)
    a, b, c = (places[corners[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return _Triangles(places, corners, normals / np.where(lengths > 0.0, lengths, 1.0), np.concatenate([np.zeros((0, 3)), *colors]))


def _packed(array: NDArray[np.float64]) -> str:
    return base64.b64encode(np.ascontiguousarray(array, dtype="<f4").tobytes()).decode("ascii")


def _edges(triangles: NDArray[np.int64], normals: NDArray[np.float64]) -> NDArray[np.int64]:
    """The edges where a surface is sharp, or open, shape (e, 2)."""
    if len(triangles) == 0:
        return np.zeros((0, 2), dtype=np.int64)
    edges = np.concatenate([np.sort(triangles[:, [k, (k + 1) % 3]], axis=1) for k in range(3)])
    sides = np.tile(normals, (3, 1))
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, sides = edges[order], sides[order]
    # of a closed mesh each edge comes twice, in a row
    is_flat = np.zeros(len(edges), dtype=bool)
    is_flat[:-1] = (edges[:-1] == edges[1:]).all(axis=1) & ((sides[:-1] * sides[1:]).sum(axis=1) > _SHARP)
    return np.unique(edges[~(is_flat | np.roll(is_flat, 1))], axis=0)
