"""Reads OpenSCAD's evaluated trees (`.csg`) and evaluates them as OpenSCAD 2021.01 does.

| module | what it holds |
|---|---|
| `text` | nodes with their arguments and lines |
| `values` | arguments as numbers |
| `fragments` | how many pieces circles and twists have |
| `primitives`, `polyhedron` | the bodies and regions that have a name |
| `regions` | set operations, offsets and sums in the plane |
| `extrude` | regions drawn out or turned around |
| `writing` | text by a font of the machine |
| `mesh_files` | meshes that are imported |
| `solids` | solids as manifold3d's, or as trees of leaves |
| `sections` | plane sections of meshes |
| `affine` | matrices and sizes that nodes name |
| `operations` | operations on whatever children a node has |
| `evaluate` | nodes to a solid |
| `printing` | nodes back to text |
| `random_files` | random trees, and smaller ones |
| `model` | the tree as a reference model |
"""

from pathlib import Path

from .evaluate import Evaluator
from .model import CsgModel
from .regions import Grid
from .solids import Manifolds
from .text import Node, parse

__all__ = ["CsgModel", "evaluator", "parsed"]


def parsed(path: Path) -> list[Node]:
    """The nodes of a file. Raises `ValueError` where it cannot be read."""
    return parse(path.read_text(encoding="utf-8", errors="replace"))


def evaluator(path: Path, openscad: bool = False) -> Evaluator:
    """Evaluates nodes of that file to solids of manifold3d; with `openscad`, flat shapes on OpenSCAD's own grid."""
    return Evaluator(Manifolds(), Grid(openscad), path.parent)
