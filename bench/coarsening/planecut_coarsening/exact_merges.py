"""Cells merged as long as that adds nothing, without limits: how many are left, and whether nothing is added."""

from dataclasses import dataclass
from pathlib import Path

from .entrant import Failed, Run, planecut
from .measure import union
from .setting import Setting

NOTHING = 1e-12
"""The most of a solid's volume that may be added or lost."""

_EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
_SLOW = "rook"
_TREES = (
    *("prusa/x-end", "prusa/print-fan-support", "prusa/Einsy-hinges", "prusa/z-screw-cover"),
    *("prusa/heatbed-cable-cover-clip", "prusa/lcd-supports", "prusa/z-axis-top", "prusa/LCD-cover-ORIGINAL-MK3"),
    *("prusa/PSU-cover-MK3", "nopscadlib/carriers"),
)


@dataclass(frozen=True)
class Merged:
    """A model's cells before and after.

    `excess` is planecut's own; `found` is the relative difference from the volume before, which planecut reports, to
    the union of the cells after, which manifold3d finds in the triangles as they are written.
    """

    model: str
    cells_in: int
    cells_out: int
    exact_merges: int
    excess: float
    found: float
    milliseconds: float


def measure_exact_merges(setting: Setting) -> list[Merged]:
    """All examples and ten of OpenSCAD's trees."""
    examples = [path for path in sorted(_EXAMPLES.glob("*.json")) if not (setting.quick and path.stem == _SLOW)]
    models = [(f"examples/{path.stem}", path) for path in examples]
    models += [(tree, setting.data / "csg" / f"{tree}.csg") for tree in _TREES]
    merged = []
    for name, path in models:
        try:
            result = _merged(name, planecut(setting.binary, path, setting.scratch))
        except (Failed, ValueError) as error:
            setting.fail(f"{name}: {error}")
            continue
        print(result, flush=True)
        if not abs(result.excess) <= NOTHING:
            setting.fail(f"{name}: exact merges change the volume by {result.excess:.1e}")
        merged.append(result)
    return merged


def _merged(name: str, run: Run) -> Merged:
    report = run.report
    found = union([body.solid() for body in run.bodies]).volume() / report["volume_in"] - 1.0
    return Merged(
        name,
        report["cells_in"],
        report["cells_out"],
        report["exact_merges"],
        report["excess"],
        found,
        report["time_ms"],
    )
