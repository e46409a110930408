"""All that a run has found."""

import json
from dataclasses import asdict, dataclass

from .browser import Shown
from .figures import Million, Size
from .measure import Volume
from .validator import Code


@dataclass(frozen=True)
class Results:
    """What each part gave back, what was left out, what is amiss, and where and how long the run was."""

    processor: str
    versions: str
    inputs: int
    files: int
    validated: int
    codes: list[Code]
    volumes: list[Volume]
    shown: list[Shown]
    sizes: list[Size]
    million: list[Million]
    notes: list[str]
    failures: list[str]
    seconds: float

    def json(self) -> str:
        """As JSON."""
        return json.dumps(asdict(self), indent=1) + "\n"
