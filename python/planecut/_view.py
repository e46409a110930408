"""A view of a solid that can be turned, for notebooks and pages: self-contained HTML."""

from __future__ import annotations

import base64
import html
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._planecut import Mesh, Solid

_TEMPLATE = Path(__file__).with_name("view.html")
_COLORS = ((0.80, 0.76, 0.70), (0.55, 0.67, 0.78), (0.80, 0.62, 0.50), (0.62, 0.72, 0.56), (0.74, 0.64, 0.76), (0.84, 0.76, 0.50))
"""Of the materials, in turn: red, green and blue."""


class View:
    """A solid or mesh that turns under the mouse: drag to turn, wheel to zoom, double click to begin again. It needs no network."""

    def __init__(self, subject: Solid | Mesh, size: tuple[int, int] = (640, 480)) -> None:
        """A view of a solid or a mesh; `size` is width and height in pixels."""
        self._mesh: Mesh = subject if hasattr(subject, "triangles") else subject.mesh()  # type: ignore[assignment]
        self._size = (int(size[0]), int(size[1]))

    def to_html(self) -> str:
        """A page of its own."""
        mesh = self._mesh
        corners = mesh.vertices[mesh.triangles]
        low, high = (corners.min((0, 1)), corners.max((0, 1))) if len(corners) else (np.zeros(3), np.ones(3))
        size = float(np.linalg.norm(high - low)) or 1.0
        places = ((corners - (low + high) / 2.0) / size).astype("<f4")
        # flat faces have one normal, and an edge between two triangles of one face is no line
        normals = np.repeat(mesh.face_normals[mesh.face_ids].astype("<f4")[:, None, :], 3, axis=1)
        colors = np.array(_COLORS, dtype="<f4")[mesh.material_ids % len(_COLORS)]
        data = {
            "triangles": _packed(places),
            "normals": _packed(normals),
            "colors": _packed(np.repeat(colors[:, None, :], 3, axis=1)),
            "lines": _packed(_lines(mesh, (low + high) / 2.0, size)),
        }
        page = _TEMPLATE.read_text(encoding="utf-8")
        return page.replace("/*DATA*/", json.dumps(data))

    def _repr_html_(self) -> str:
        width, height = self._size
        page = html.escape(self.to_html(), quote=True)
        return f'<iframe srcdoc="{page}" width="{width}" height="{height}" style="border: 0" sandbox="allow-scripts"></iframe>'

    def save(self, path: str | Path) -> None:
        """Writes the page to a file."""
        Path(path).write_text(self.to_html(), encoding="utf-8")


def _packed(array: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(array, dtype="<f4").tobytes()).decode("ascii")


def _lines(mesh: Mesh, middle: NDArray[np.float64], size: float) -> NDArray[np.float64]:
    """The edges between faces, shape (e, 2, 3)."""
    triangles = mesh.triangles.astype(np.int64)
    if len(triangles) == 0:
        return np.zeros((0, 2, 3))
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    faces = np.tile(mesh.face_ids, 3)
    key = np.sort(edges, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    key, faces = key[order], faces[order]
    # of a closed mesh each edge comes twice, in a row
    is_pair = np.zeros(len(key), dtype=bool)
    is_pair[:-1] = (key[:-1] == key[1:]).all(axis=1) & (faces[:-1] == faces[1:])
    is_inner = is_pair | np.roll(is_pair, 1)
    lines: NDArray[np.float64] = (mesh.vertices[np.unique(key[~is_inner], axis=0)] - middle) / size
    return lines
