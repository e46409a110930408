"""The reference model of an OpenSCAD tree."""

from pathlib import Path

from ..solid_tree import SolidTree
from ..tree_model import TreeModel
from .evaluate import Evaluator
from .solids import Trees
from .text import parse


class CsgModel(TreeModel):
    """A tree in numbers of six digits: faces that were meant to be one differ by what they lack, and may be made one."""

    limit = 1e-6
    position = 1e-5

    @classmethod
    def load(cls, path: Path) -> "CsgModel":
        """The model of a file. Raises `ValueError` where it cannot be evaluated."""
        evaluator = Evaluator(Trees(), folder=path.parent)
        solid = evaluator.solid(parse(path.read_text(encoding="utf-8", errors="replace")))
        return cls(SolidTree.nothing() if solid is None else solid.settled(), evaluator.warnings)
