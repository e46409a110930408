"""Reference models: what the input means, said by code that planecut has no part in."""

from pathlib import Path
from typing import Protocol

import numpy as np

from .brush_union import BrushUnion
from .convex_body import convex_body
from .csg_file import CsgModel
from .lines import Coverage, Lines
from .map_file import read_map
from .model_file import read_model
from .reference import ReferenceSurface, ReferenceVolume
from .tree_model import TreeModel


class ReferenceModel(Protocol):
    """What the checks need from an input; a new file format brings a class like this and a line in `FORMATS`."""

    brushes: int
    """Bodies in the file."""
    counts_brushes: bool
    """Whether planecut's report must have the same number."""
    notes: list[str]
    """What was left out, for the reader of the table."""
    low: np.ndarray
    high: np.ndarray
    """Corners of the bounding box of what lines are drawn through."""
    is_empty: bool
    empty_may_be_refused: bool
    is_unbounded: bool
    """Whether the solid has no end: planecut must refuse to make a mesh of it."""
    box_is_exact: bool
    """Whether `low` and `high` are those of the solid itself."""
    is_generic: bool
    """Whether no faces of two bodies coincide, so that manifold3d's own area counts."""
    is_simple: bool
    """Whether no edge of the solid can have four faces either, so that its genus counts."""

    exact: tuple[float, float] | None
    """Volume and area where they are known without manifold3d."""
    limit: float
    """Largest relative difference of a volume from the one that manifold3d finds."""
    position: float
    """Largest distance of a crossing of a line from its place, relative to the diagonal."""

    def volume(self, candidate: float | None) -> ReferenceVolume:
        """The volume of the solid by manifold3d. Raises `ArithmeticError` where its answers do not settle on one.

        Where its first answer is the `candidate` to 1e-10, no others need be asked.
        """

    def surface(self) -> ReferenceSurface:
        """What manifold3d says of the surface; for generic models."""

    def coverage(self, lines: Lines) -> Coverage:
        """Where the lines cross the solid, from the input's own definition, without any mesh."""


def _load_map(path: Path) -> BrushUnion:
    # Old editors wrote texture and path names in whatever code page they had; only ASCII matters here.
    brushes = read_map(path.read_text(encoding="latin-1"))
    return BrushUnion([convex_body(b.planes) for b in brushes], len(brushes))


def _load_model(path: Path) -> TreeModel:
    return TreeModel(read_model(path))


FORMATS = {".map": _load_map, ".json": _load_model, ".csg": CsgModel.load}
"""File ending to loader."""


def load(path: Path) -> ReferenceModel:
    """The reference model of a file whose ending is in `FORMATS`. Raises `ValueError` where it is not a model."""
    return FORMATS[path.suffix.lower()](path)
