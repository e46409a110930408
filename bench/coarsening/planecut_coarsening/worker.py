"""The process in which CoACD or V-HACD runs: `worker NAME INPUT OUTPUT SETTINGS` prints the seconds of the call."""

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
    hulls, seconds = _ENTRANTS[name](body, json.loads(settings))
    write_bodies(Path(output), [Body(np.asarray(corners), np.asarray(triangles)) for corners, triangles in hulls])
    print(seconds)


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


_ENTRANTS = {"coacd": _coacd, "vhacd": _vhacd}

if __name__ == "__main__":
    main()
