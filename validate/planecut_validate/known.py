"""Volumes that are known from elsewhere: `reference.json` beside or above the models, one entry per file."""

import json
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

NAME = "reference.json"
_TWICE = 1e-6
_ONCE = 3e-5
"""Largest relative differences: where two evaluators agree, and where the volume is that of one file of six digits."""


@dataclass(frozen=True)
class Known:
    """A volume, how well it is known, and how long OpenSCAD took for it."""

    volume: float
    limit: float
    openscad_seconds: float | None = None


def known(model: Path, reference: Path | None = None) -> Known | None:
    """The entry of a model, in the file that is named or in the nearest one beside or above it."""
    path = model.resolve()
    files = [reference.resolve()] if reference else [folder / NAME for folder in path.parents]
    for file in files:
        if file.is_file():
            entries = _entries(file)
            inside = path.relative_to(file.parent).as_posix() if path.is_relative_to(file.parent) else path.name
            return entries.get(inside)
    return None


@lru_cache
def _entries(file: Path) -> dict[str, Known]:
    """Entries by file name, of those that say how they were checked."""
    found = json.loads(file.read_text(encoding="utf-8"))
    rows = [row for row in found if isinstance(row, dict)] if isinstance(found, list) else []
    return {
        row["file"]: Known(
            row["volume"], _TWICE if "two evaluators" in row["checked"] else _ONCE, row.get("openscad_seconds")
        )
        for row in rows
        if row.get("checked") and isinstance(row.get("volume"), float)
    }
