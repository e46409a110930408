"""All figures of a run."""

import json
from dataclasses import asdict, dataclass

from . import machine
from .bullet_engine import BulletRays
from .exact_merges import Merged
from .lowered import Lowered
from .mujoco_engine import MuJoCoCell
from .setting import Row


@dataclass(frozen=True)
class Results:
    """What each part gave back, and the seconds of the run."""

    decompositions: list[Row]
    whole: list[Row]
    exact: list[Merged]
    lowered: list[Lowered]
    mujoco: list[MuJoCoCell]
    bullet: BulletRays
    failures: list[str]
    seconds: float

    def json(self) -> str:
        """As JSON, with where the run was made."""
        run = {"processor": machine.processor(), "others": machine.versions()}
        return json.dumps(run | asdict(self), indent=1) + "\n"
