"""Closed meshes into few hulls, by planecut, CoACD and V-HACD."""

from pathlib import Path

from .bodies import write_bodies
from .entrant import Failed, library
from .measure import Reference
from .meshes import read_mesh
from .setting import Row, Setting, planecut_rows, row_of

MESHES = {
    "SnowFlake": "convex/coacd/SnowFlake.obj",
    "torus": "mesh/vhacd/torus1.obj",
    "cow": "mesh/vhacd/cow-nonormals.obj",
    "lamp": "mesh/vhacd/lamp.obj",
    "112932": "mesh/ember/112932.stl",
    "65004": "mesh/ember/65004.stl",
    "88566": "mesh/ember/88566.stl",
}
"""Files of the data, by the name that tables and plots have for them."""
_COUNTS = (4, 8, 16, 32, 64)
_COUNTS_QUICK = (16, 64)

LIBRARIES = {
    "CoACD": ("coacd", "max_convex_hull", [{"threshold": threshold} for threshold in (0.05, 0.02)]),
    "V-HACD": ("vhacd", "maxConvexHulls", [{"resolution": voxels} for voxels in (400_000, 4_000_000)]),
}
"""Name in `worker`, what limits the number of hulls, and the other settings to try: the library's own ones first."""


def measure_whole_meshes(setting: Setting) -> list[Row]:
    """All three at all numbers of hulls, for each mesh; with `--quick`, for the first two."""
    names = list(MESHES)[:2] if setting.quick else list(MESHES)
    return [row for name in names for row in _measure_whole_mesh(setting, name)]


def _measure_whole_mesh(setting: Setting, name: str) -> list[Row]:
    source = setting.data / MESHES[name]
    mesh = read_mesh(source)
    reference = Reference.of_mesh(mesh)
    written = setting.scratch / "mesh.obj"
    write_bodies(written, [mesh])
    rows = []
    for count in _COUNTS_QUICK if setting.quick else _COUNTS:
        rows += planecut_rows(setting, name, source, count, reference)
        for entrant in LIBRARIES:
            found = _all(setting, entrant, name, written, count, reference)
            rows += sorted(found, key=lambda row: row.measure.union_excess + row.measure.missing)[:1]
    return rows


def _all(setting: Setting, entrant: str, mesh: str, path: Path, count: int, reference: Reference) -> list[Row]:
    """One for each of the settings that lead to as few hulls; with `--quick`, for the first that does."""
    name, limit, variants = LIBRARIES[entrant]
    found = []
    for variant in variants:
        if found and setting.quick:
            break
        text = ", ".join(f"{key} {value}" for key, value in variant.items())
        try:
            run = library(name, path, setting.scratch, **{limit: count}, **variant)
        except Failed as error:
            print(f"{mesh} at {count}, {entrant}, {text}: {error}", flush=True)
            continue
        if len(run.bodies) <= count:
            found.append(row_of(mesh, entrant, text, count, run, reference))
    return found
