"""One closed mesh into few hulls, by planecut, CoACD and V-HACD."""

from .bodies import read_bodies
from .entrant import Failed, library
from .measure import Reference
from .setting import Row, Setting, planecut_rows, row_of

NAME = "SnowFlake.obj"
_PATH = "convex/coacd/SnowFlake.obj"
_COUNTS = (4, 8, 16, 32, 64)
_COUNTS_QUICK = (16, 64)

LIBRARIES = {
    "CoACD": ("coacd", "max_convex_hull", [{"threshold": threshold} for threshold in (0.05, 0.02, 0.01, 0.1)]),
    "V-HACD": ("vhacd", "maxConvexHulls", [{"resolution": voxels} for voxels in (400_000, 4_000_000)]),
}
"""Name in `worker`, what limits the number of hulls, and the other settings to try: the library's own ones first."""


def measure_whole_mesh(setting: Setting) -> list[Row]:
    """All three at all numbers of hulls."""
    bodies = read_bodies(setting.data / _PATH)
    reference = Reference.of(bodies[0].solid(), bodies)
    rows = []
    for count in _COUNTS_QUICK if setting.quick else _COUNTS:
        rows += planecut_rows(setting, NAME, setting.data / _PATH, count, reference)
        for entrant in LIBRARIES:
            found = _all(setting, entrant, count, reference)
            rows += sorted(found, key=lambda row: row.measure.union_excess)[:1]
    return rows


def _all(setting: Setting, entrant: str, count: int, reference: Reference) -> list[Row]:
    """One for each of the settings that lead to as few hulls; with `--quick`, for the first that does."""
    name, limit, variants = LIBRARIES[entrant]
    found = []
    for variant in variants:
        if found and setting.quick:
            break
        text = ", ".join(f"{key} {value}" for key, value in variant.items())
        try:
            run = library(name, setting.data / _PATH, setting.scratch, **{limit: count}, **variant)
        except Failed as error:
            print(f"{NAME} at {count}, {entrant}, {text}: {error}", flush=True)
            continue
        if len(run.bodies) <= count:
            found.append(row_of(NAME, entrant, text, count, run, reference))
    return found
