"""A model of a dungeon: rooms on a grid with doors, corridors, columns and stairs, as game levels are built of brushes."""

from __future__ import annotations

import argparse
import json
import random
from pathlib import Path

PITCH = 16.0
"""From one room's corner to the next one's."""
WALL = 0.5
DOOR = (2.0, 3.0)
"""Width and height of a door."""
PASSAGE = 0.4
"""How likely a room has a corridor to the next one."""


def box(low: tuple[float, ...], high: tuple[float, ...]) -> dict:
    """A box from one corner to the opposite one."""
    return {"box": {"min": list(low), "max": list(high)}}


def wall(axis: int, along: tuple[float, float], across: float, base: float, top: float, door: float | None) -> list[dict]:
    """A wall along an axis, in three pieces where it has a door whose middle is given."""

    def piece(start: float, end: float, low: float, high: float) -> dict:
        near, far = [0.0, 0.0, low], [0.0, 0.0, high]
        near[axis], far[axis] = start, end
        near[1 - axis], far[1 - axis] = across, across + WALL
        return box(tuple(near), tuple(far))

    if door is None:
        return [piece(*along, base, top)]
    left, right = door - DOOR[0] / 2, door + DOOR[0] / 2
    return [
        piece(along[0], left, base, top),
        piece(right, along[1], base, top),
        piece(left, right, base + DOOR[1], top),
    ]


def corridor(axis: int, along: tuple[float, float], across: float, base: float) -> list[dict]:
    """Floor, ceiling and both walls of a passage whose middle is at `across`."""

    def piece(side: tuple[float, float], low: float, high: float) -> dict:
        near, far = [0.0, 0.0, low], [0.0, 0.0, high]
        near[axis], far[axis] = along
        near[1 - axis], far[1 - axis] = side
        return box(tuple(near), tuple(far))

    half = DOOR[0] / 2
    outer = half + WALL
    return [
        piece((across - outer, across + outer), base - WALL, base),
        piece((across - outer, across + outer), base + DOOR[1], base + DOOR[1] + WALL),
        piece((across - outer, across - half), base, base + DOOR[1]),
        piece((across + half, across + outer), base, base + DOOR[1]),
    ]


def room(chance: random.Random, column: int, row: int, columns: int, rows: int, doors: dict) -> list[dict]:
    """A room at a place of the grid, and the corridors to its neighbours in the east and north; `doors` are the places of those already made."""
    x, y = column * PITCH, row * PITCH
    wide, deep = chance.uniform(9, 12), chance.uniform(9, 12)
    high = chance.uniform(4, 7)
    solids = [
        box((x, y, -WALL), (x + wide, y + deep, 0)),
        box((x, y, high), (x + wide, y + deep, high + WALL)),
    ]
    east = y + chance.uniform(3, 6) if column + 1 < columns and chance.random() < PASSAGE else None
    north = x + chance.uniform(3, 6) if row + 1 < rows and chance.random() < PASSAGE else None
    doors["west", column + 1, row], doors["south", column, row + 1] = east, north
    solids += wall(1, (y, y + deep), x, 0, high, doors.get(("west", column, row)))
    solids += wall(1, (y, y + deep), x + wide - WALL, 0, high, east)
    solids += wall(0, (x + WALL, x + wide - WALL), y, 0, high, doors.get(("south", column, row)))
    solids += wall(0, (x + WALL, x + wide - WALL), y + deep - WALL, 0, high, north)
    if east is not None:
        solids += corridor(0, (x + wide, x + PITCH), east, 0)
    if north is not None:
        solids += corridor(1, (y + deep, y + PITCH), north, 0)
    for corner in chance.sample([(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)], chance.choice((0, 0, 0, 2, 4))):
        prism = {"height": high, "radius": chance.uniform(0.3, 0.6), "sides": chance.randint(8, 12)}
        place = [x + corner[0] * wide, y + corner[1] * deep, 0]
        solids.append({"prism": prism, "transform": [{"translate": place}]})
    if chance.random() < 0.125:
        steps = chance.randint(4, 8)
        for step in range(steps):
            low = (x + WALL + 0.6 * step, y + WALL, 0)
            solids.append(box(low, (low[0] + 0.6, low[1] + 1.5, 0.3 * (step + 1))))
    return solids


def model(rooms: int, seed: int = 1) -> dict:
    """A model of about as many rooms, in a grid that is about square."""
    chance = random.Random(seed)
    columns = max(1, round(rooms**0.5))
    rows = max(1, round(rooms / columns))
    doors: dict = {}
    solids = []
    for row in range(rows):
        for column in range(columns):
            solids += room(chance, column, row, columns, rows, doors)
    return {"planecut": 1, "model": {"union": solids}}


def main() -> None:
    """Writes a model file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--rooms", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    arguments.file.write_text(json.dumps(model(arguments.rooms, arguments.seed)))


if __name__ == "__main__":
    main()
