"""What bodies are made of, each with the options of `planecut coarsen`."""

import json
import math
import pathlib
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parents[3]
DATA = ROOT.parent / "shared" / "data" / "mesh"

CORNERS = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
# a cube without its lid
TRAY = CORNERS + "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"


@dataclass
class Shape:
    name: str
    input: pathlib.Path
    options: list[str]
    # cells that are boxes, where that is known beforehand
    boxes: int | None = None
    # in cubic metres, where that is known beforehand
    volume: float | None = None
    # whether it is so large that it is written once only
    is_large: bool = False


def shapes(folder: pathlib.Path) -> tuple[list[Shape], list[str]]:
    """The shapes, the small ones written to a folder; and the names of files that are absent."""
    box = {"box": {"min": [0, 0, 0], "max": [0.3, 0.2, 0.1]}}
    c, s = math.cos(0.5), math.sin(0.5)
    turned = {**box, "matrix": [[c, -s, 0, 1], [s, c, 0, -2], [0, 0, 1, 5]]}
    # a table: boxes alone
    leg = [{"box": {"min": [x, y, 0], "max": [x + 0.05, y + 0.05, 0.7]}} for x in (0, 0.95) for y in (0, 0.55)]
    table = {"union": [{"box": {"min": [0, 0, 0.7], "max": [1, 0.6, 0.75]}}, *leg]}
    made = []
    for name, model in (("box", box), ("turned box", turned), ("table & <legs>", table)):
        path = folder / f"{name.split(' &')[0].replace(' ', '_')}.json"
        path.write_text(json.dumps({"planecut": 1, "model": model}))
        made.append((name, path))
    tray = folder / "tray.obj"
    tray.write_text(TRAY)
    legs = 0.6 * 0.05 + 4 * 0.05 * 0.05 * 0.7
    found = [
        Shape("box", made[0][1], [], 1, 0.006),
        Shape("turned box", made[1][1], ["--engine", "physx"], 1, 0.006),
        Shape("table & <legs>", made[2][1], ["--engine", "mujoco", "--name", "leg {} & \"<top>\""], 5, legs),
        Shape("castle", ROOT / "examples" / "castle.json", ["--engine", "bullet", "--max-cells", "12", "--unit", "mm"], is_large=True),
        Shape("open tray", tray, ["--engine", "unity", "--max-cells", "5", "--min-thickness", "0.125", "--unit", "cm"]),
    ]
    absent = []
    for file, options in (("trimesh/featuretype.STL", ["--unit", "in", "--max-cells", "8"]),):
        path = DATA / file
        if path.exists():
            found.append(Shape(path.stem, path, ["--engine", "jolt", *options], is_large=True))
        else:
            absent.append(file)
    return found, absent
