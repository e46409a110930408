"""The process in which CoACD, V-HACD or pchs runs: `worker NAME INPUT OUTPUT SETTINGS` prints the seconds of the call, and of its phases."""

import json
import sys
import time
from pathlib import Path

import numpy as np

from .bodies import Body, read_bodies, write_bodies


def main() -> None:
    """Reads one body, runs, writes the hulls."""
    name, source, output, settings = sys.argv[1:]
    (body,) = read_bodies(Path(source))
    hulls, seconds, *phases = _ENTRANTS[name](body, json.loads(settings))
    write_bodies(Path(output), [Body(np.asarray(corners), np.asarray(triangles)) for corners, triangles in hulls])
    print(seconds, *(f"{phase}={value}" for told in phases for phase, value in told.items()))


def _coacd(body: Body, settings: dict) -> tuple[list, float]:
    import coacd

    coacd.set_log_level("error")
    begin = time.perf_counter()
    hulls = coacd.run_coacd(coacd.Mesh(body.corners, body.triangles.astype(np.int32)), **settings)
    return hulls, time.perf_counter() - begin


def _vhacd(body: Body, settings: dict) -> tuple[list, float]:
    import vhacdx

    begin = time.perf_counter()
    hulls = vhacdx.compute_vhacd(body.corners, body.triangles.astype(np.uint32), **settings)
    return hulls, time.perf_counter() - begin


def _pchs(body: Body, settings: dict) -> tuple[list, float, dict]:
    import pchs

    corners = np.asfortranarray(body.corners)
    triangles = np.asfortranarray(body.triangles.astype(np.int32))
    begin = time.perf_counter()
    simplification = pchs.ConvexHullSimplification(corners, triangles)
    simplification.simplify_to(settings["target"])
    seconds = time.perf_counter() - begin
    places, corner_numbers, ends = simplification.get_primal_mesh()
    polygons = [corner_numbers[start:end] for start, end in zip(ends[:-1], ends[1:])]
    fans = [[polygon[0], *pair] for polygon in polygons for pair in zip(polygon[1:], polygon[2:])]
    return [(places, fans)], seconds, {"hull": simplification.stats().t_primal_hull}


_ENTRANTS = {"coacd": _coacd, "vhacd": _vhacd, "pchs": _pchs}

if __name__ == "__main__":
    main()
