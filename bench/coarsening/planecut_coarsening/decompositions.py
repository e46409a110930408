"""Decompositions made coarser: the number of cells against the volume that is added."""

from .bodies import read_bodies
from .greedy import greedy_merges
from .measure import Reference, union
from .setting import Row, Setting, planecut_rows, row_of_bodies

INPUTS = {
    "lego": "convex/bullet3/lego_vhacd.obj",
    "chassis": "convex/bullet3/chassis_vhacd.obj",
    "cup": "convex/bullet3/cup_vhacd.obj",
    "SnowFlake": "convex/coacd/SnowFlake_coacd.obj",
}
_CAPS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 32, 40, 50, 64)
_CAPS_QUICK = (1, 5, 10, 20, 40)

KNOWN = {
    "greedy, whole union": {40: 0.125, 20: 0.43, 10: 0.82, 5: 1.28},
    "greedy, another": {40: 0.128, 20: 0.49, 10: 0.87, 5: 1.40},
}
"""Union excess of lego, measured once and elsewhere: by greedy merging that scores each pair against the whole union,
in 129 s, and by another program's plain greedy merging, in 0.6 s."""


def measure_decompositions(setting: Setting) -> list[Row]:
    """Each input at all caps, by planecut and by plain greedy merging."""
    rows = []
    for name, path in INPUTS.items():
        bodies = read_bodies(setting.data / path)
        reference = Reference.of(union([body.hull() for body in bodies]), bodies)
        below = [cap for cap in (_CAPS_QUICK if setting.quick else _CAPS) if cap < len(bodies)]
        caps = [*below, len(bodies)]
        for cap in caps:
            rows += planecut_rows(setting, name, setting.data / path, cap, reference)
        greedy = greedy_merges(bodies, set(caps))
        rows += [row_of_bodies(name, "greedy", greedy[cap], reference) for cap in caps]
    return rows
