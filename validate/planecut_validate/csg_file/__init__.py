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
| `evaluate` | nodes to a solid |
"""

from pathlib import Path

from .evaluate import Evaluator
from .regions import Grid
from .solids import Held, Manifolds, Trees
from .text import parse


def read_csg(path: Path) -> tuple:
    """The file as a `SolidTree`, and warnings. Raises `ValueError` where it cannot be evaluated."""
    evaluator = Evaluator(Trees(), folder=path.parent)
    solid = evaluator.solid(parse(path.read_text(encoding="utf-8", errors="replace")))
    return None if solid is None else solid.settled(), evaluator.warnings


def evaluate_csg(path: Path, openscad: bool = False) -> tuple[Held | None, list[str]]:
    """The file as a solid of manifold3d, and warnings; with `openscad`, flat shapes on OpenSCAD's own grid."""
    evaluator = Evaluator(Manifolds(), Grid(openscad), path.parent)
    return evaluator.solid(parse(path.read_text(encoding="utf-8", errors="replace"))), evaluator.warnings
