"""What is built."""

import json
import math
from dataclasses import dataclass
from pathlib import Path

LARGE = 700_000
"""Bytes of an input above which it is left to full runs."""

TREES = 30
"""How many of OpenSCAD's trees are built, spread evenly over all of them."""

QUICK = 4
"""How many of each kind are built in a quick run."""


@dataclass(frozen=True)
class Input:
    """A file with a name that is short and no other's."""

    name: str
    path: Path


def all_inputs(project: Path, data: Path, quick: bool, full: bool) -> list[Input]:
    """Examples, maps and trees, in this order."""
    examples = sorted((project / "examples").glob("*.json"))
    maps = _of_size(data / "map", "*.map", full)
    trees = _of_size(data / "csg", "*.csg", full)
    numbers = (QUICK, QUICK, QUICK) if quick else (math.inf, math.inf, math.inf if full else TREES)
    kinds = [_spread(files, number) for files, number in zip((examples, maps, trees), numbers, strict=True)]
    return [Input(f"{path.parent.name}/{path.name}", path) for kind in kinds for path in kind]


def write_empty(folder: Path) -> Path:
    """A model of nothing: its preview is the background."""
    boxes = [{"box": {"min": [x, 0, 0], "max": [x + 1, 1, 1]}} for x in (0, 2)]
    return _write(folder / "empty.json", {"intersection": boxes})


def write_million(folder: Path) -> Path:
    """A thousand balls of a thousand triangles each."""
    array = {"of": {"sphere": {"radius": 1, "segments": 32}}, "count": [10, 10, 10], "step": [3, 3, 3]}
    return _write(folder / "million.json", {"array": array})


def _write(path: Path, model: dict) -> Path:
    path.write_text(json.dumps({"planecut": 1, "model": model}), encoding="utf-8")
    return path


def _of_size(folder: Path, pattern: str, full: bool) -> list[Path]:
    return sorted(path for path in folder.rglob(pattern) if full or path.stat().st_size <= LARGE)


def _spread(files: list[Path], number: float) -> list[Path]:
    """A number of them at even distances, the last one among them."""
    if len(files) <= number:
        return files
    return [files[((i + 1) * len(files) - 1) // int(number)] for i in range(int(number))]
