"""Identities of set algebra over random solids, through the program itself: both sides must be one solid."""

import json
import tempfile
from pathlib import Path

import numpy as np

from . import line_oracle, process
from .mesh import Mesh
from .mesh_lines import TriangleTree
from .model import load
from .obj_file import read_obj
from .random_trees import FAMILIES, document, random_node
from .result import Options, Result

_NOTHING = {"intersection": [{"box": {"min": [k, 0, 0], "max": [k + 1, 1, 1]}} for k in (0, 2)]}
_ROOM = {"box": {"min": [-20, -21, -22], "max": [30, 31, 32]}}


def _u(*nodes):
    return {"union": list(nodes)}


def _d(*nodes):
    return {"difference": list(nodes)}


def _i(*nodes):
    return {"intersection": list(nodes)}


def _x(*nodes):
    return {"xor": list(nodes)}


def _c(node):
    return {"complement": node}


IDENTITIES = {
    "A∪A = A": lambda a, b, c: (_u(a, a), a),
    "A∩A = A": lambda a, b, c: (_i(a, a), a),
    "A−A = ∅": lambda a, b, c: (_d(a, a), _NOTHING),
    "A⊕A = ∅": lambda a, b, c: (_x(a, a), _NOTHING),
    "¬¬A = A": lambda a, b, c: (_c(_c(a)), a),
    "A−B−B = A−B": lambda a, b, c: (_d(_d(a, b), b), _d(a, b)),
    "¬(A∪B) = ¬A∩¬B": lambda a, b, c: (_i(_ROOM, _c(_u(a, b))), _i(_ROOM, _i(_c(a), _c(b)))),
    "¬(A∩B) = ¬A∪¬B": lambda a, b, c: (_i(_ROOM, _c(_i(a, b))), _i(_ROOM, _u(_c(a), _c(b)))),
    "A⊕B = (A−B)∪(B−A)": lambda a, b, c: (_x(a, b), _u(_d(a, b), _d(b, a))),
    "A⊕B = (A∪B)−(A∩B)": lambda a, b, c: (_x(a, b), _d(_u(a, b), _i(a, b))),
    "A−(B∪C) = (A−B)∩(A−C)": lambda a, b, c: (_d(a, _u(b, c)), _i(_d(a, b), _d(a, c))),
    "A−(B∩C) = (A−B)∪(A−C)": lambda a, b, c: (_d(a, _i(b, c)), _u(_d(a, b), _d(a, c))),
    "(A∩B)∪(A−B) = A": lambda a, b, c: (_u(_i(a, b), _d(a, b)), a),
    "A∪(A∩B) = A": lambda a, b, c: (_u(a, _i(a, b)), a),
    "A∩(B∪C) = (A∩B)∪(A∩C)": lambda a, b, c: (_i(a, _u(b, c)), _u(_i(a, b), _i(a, c))),
    "(A⊕B)⊕B = A": lambda a, b, c: (_x(_x(a, b), b), a),
    "A∪B = B∪A": lambda a, b, c: (_u(a, b), _u(b, a)),
}
"""Name to the two sides, of three solids."""


def check_identity(seed: int, most_leaves: int, options: Options) -> tuple[Result, dict]:
    """One identity over three random solids with a maximum number of leaves each, and the model whose sides differ."""
    name = list(IDENTITIES)[seed % len(IDENTITIES)]
    random = np.random.default_rng(seed)
    family = FAMILIES[int(random.integers(len(FAMILIES)))]
    solids = [random_node(3 * seed + k, int(random.integers(1, most_leaves + 1)), family) for k in range(3)]
    left, right = IDENTITIES[name](*solids)
    result = Result(f"{name} #{seed}")
    with tempfile.TemporaryDirectory(prefix="planecut-validate-") as folder:
        try:
            _compare(result, left, right, Path(folder), options)
        except (process.Refused, process.Broken, ValueError, KeyError) as fault:
            result.failures.append(str(fault))
    if result.failures:
        result.status = "FAIL"
    return result, {"left": document(left), "right": document(right)}


def _compare(result: Result, left: dict, right: dict, folder: Path, options: Options) -> None:
    meshes, paths = [], []
    for side, node in (("left", left), ("right", right)):
        path = folder / f"{side}.json"
        path.write_text(json.dumps(document(node)), encoding="utf-8")
        (folder / side).mkdir()
        build = process.build(options.binary, path, folder / side)
        meshes.append(read_obj(build.obj))
        paths.append(path)
        result.same(f"{side} solid.volume", build.report["solid"]["volume"], meshes[-1].volume())
    first, second = meshes
    result.triangles = len(first.triangles)
    result.reference_volume = second.volume()
    result.same("volume", first.volume(), second.volume())
    result.same("area", first.area(), second.area())
    result.equal("connected surfaces", first.components(), second.components())
    # The reference says which lines are too near to an edge; the two meshes are held against each other.
    drawn = line_oracle.draw(load(paths[0]), options.lines, options.seed)
    drawn.coverage.crossings = _crossings(second, drawn)
    drawn.coverage.endless[:] = False
    report = line_oracle.compare(drawn, first)
    result.lines = {"mismatches": report.mismatches, "redrawn": report.redrawn}
    if report.mismatches:
        result.failures.append(f"{report.mismatches} of {report.lines} lines differ; {report.examples[0]}")


def _crossings(mesh: Mesh, drawn: line_oracle.Drawn):
    return TriangleTree(mesh).crossings(drawn.lines) if len(mesh.triangles) else line_oracle.no_crossings()
