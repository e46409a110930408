"""What all parts are given, and what has gone wrong so far."""

import shutil
from dataclasses import dataclass, field
from pathlib import Path

from .planecut import Planecut

SIZE = (1280, 960)
"""Pixels of all pictures."""


@dataclass
class Setting:
    """The program, a folder for what is written on the way, and what was found amiss or left out."""

    planecut: Planecut
    scratch: Path
    full: bool
    failures: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def fail(self, where: str, message: object) -> None:
        """Something that makes the exit status 1."""
        self.failures.append(f"{where}: {_line(message)}")
        print(f"FAIL {self.failures[-1]}", flush=True)

    def note(self, message: str) -> None:
        """Something that was left out; said once."""
        if (line := _line(message)) not in self.notes:
            self.notes.append(line)
            print(f"note: {line}", flush=True)

    def program(self, names: tuple[str, ...], package: str, use: str) -> str | None:
        """The first of the programs that is here; a note where there is none."""
        found = next(filter(None, map(shutil.which, names)), None)
        if found is None:
            self.note(f"{names[0]} is missing, {use} left out; Debian has it: apt-get install {package}")
        return found


def _line(message: object) -> str:
    return " ".join(str(message).split())
