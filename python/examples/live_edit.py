"""A live model: one side of a brush is dragged through a level in 200 steps, then all of it is undone.

Each step says which faces it changed, and how long it took.

python examples/live_edit.py [output folder] [map file] [number of the brush] [distance]
"""

import sys
import time
from pathlib import Path

import numpy as np
import planecut as pc

SIZE = 8.0


def level(rooms=8):
    """Rooms in a square cut into rock, open above, with doors between them and a pillar in each."""
    reach = rooms * SIZE
    places = [(x * SIZE, y * SIZE) for x in range(rooms) for y in range(rooms)]
    holes = [pc.box([x + 0.5, y + 0.5, 0], [x + SIZE - 0.5, y + SIZE - 0.5, 5], material="plaster") for x, y in places]
    doors = [pc.box([x - 1, y + 3, 0], [x + 1, y + 5, 2.5], material="wood") for x, y in places if x > 0]
    doors += [pc.box([x + 3, y - 1, 0], [x + 5, y + 1, 2.5], material="wood") for x, y in places if y > 0]
    pillars = [
        pc.cylinder(3, 0.7, segments=12, material="marble").translate([x + SIZE / 2, y + SIZE / 2, 0])
        for x, y in places
    ]
    rock = pc.box([-1, -1, -1], [reach + 1, reach + 1, 4], material="rock")
    # the last one is dragged: a beam that will reach through rooms, walls and pillars
    beam = pc.box([SIZE, 1.45 * SIZE, 1], [1.2 * SIZE, 1.55 * SIZE, 2], material="steel")
    return pc.union([pc.difference(rock, holes + doors), *pillars, beam])


def side(live, brush):
    """The plane of a brush that faces +x most: its number and its offset."""
    planes = live.planes(brush)
    plane = max(planes, key=lambda number: planes[number][0] / np.linalg.norm(planes[number][:3]))
    return plane, planes[plane][3]


def drag(live, brush, plane, start, step, count):
    """Moves a plane `count` times by a step; returns for each how many faces went and came, and the time in seconds."""
    log = []
    for number in range(1, count + 1):
        begin = time.perf_counter()
        with live.edit() as edit:
            edit.move_plane(brush, plane, start + number * step)
        seconds = time.perf_counter() - begin
        log.append((len(live.change.removed), len(live.change.added), seconds))
    return log


def main(folder=".", path=None, brush=-1, reach=5 * SIZE, steps=200):
    """Drags and undoes.

    Returns the live model, the log, the volumes before, dragged and after, the dragged solid, and the time of an undo.
    """
    solid = level() if path is None else pc.load(path, allow_loss=True)
    live = pc.Live(solid)
    before = live.volume
    brush = int(live.brushes[int(brush)])
    plane, start = side(live, brush)
    log = drag(live, brush, plane, start, float(reach) / steps, steps)
    dragged, moved = live.volume, live.to_solid()
    moved.save(Path(folder) / "live_edit.png", size=(1200, 900), elevation=45)
    begin = time.perf_counter()
    for _ in range(steps):
        live.undo()
    seconds = (time.perf_counter() - begin) / steps
    return live, log, (before, dragged, live.volume), moved, seconds


if __name__ == "__main__":
    live, log, volumes, moved, undo_seconds = main(*sys.argv[1:5])
    for number, (removed, added, seconds) in enumerate(log, start=1):
        if number % 20 == 0:
            print(f"step {number:3}: {removed:3} faces removed, {added:3} added, {1e3 * seconds:.3f} ms")
    median = np.median([seconds for *_, seconds in log])
    print(f"{live}: median {1e3 * median:.3f} ms a step, {1e3 * undo_seconds:.3f} ms an undo")
    print("volume before, dragged and after:", volumes)
