"""Reads the native model file as `docs/model-file.md` describes it, into a tree of bodies.

| module | what it holds |
|---|---|
| `text` | JSON without repeated keys, and what every value is taken out with |
| `expression` | numbers that are written as expressions |
| `scope` | parameters, parts and outlines by name |
| `affine` | matrices and transform steps |
| `node` | a NODE to a tree |
| `shapes` | points of the convex primitives |
| `sweep` | meshes of torus, extrusion and revolution |
| `hulls` | hull and Minkowski sum |
| `outline` | an OUTLINE to loops |
| `arrangement` | set operations on polygons, with exact crossings |
| `offset` | growing and shrinking outlines |
| `sections` | slices and shadows of solids |
"""

import sys
from pathlib import Path

from ..solid_tree import SolidTree
from .node import read_document
from .text import parse

_DEEP = 200_000
"""Levels of recursion that are allowed; none of them takes memory of the machine's stack."""


def read_model(path: Path) -> SolidTree:
    """The solid that the file describes. Raises `ValueError` where it describes none."""
    sys.setrecursionlimit(max(sys.getrecursionlimit(), _DEEP))
    try:
        return read_document(parse(path.read_text(encoding="utf-8")))
    except (OverflowError, ZeroDivisionError) as error:
        raise ValueError(f"a number out of range: {error}") from error
