"""What a check leaves: differences, failures and notes of one model."""

import math
from dataclasses import dataclass, field
from pathlib import Path

SAME = 1e-9
"""Largest relative difference between two ways to one number."""
CELLS_SAME = 1e-12
"""The same between the skin and the sum of the cells, beside what rounded coordinates explain."""


@dataclass(frozen=True)
class Options:
    """How models are checked: the program, random lines per model and their seed, whether cells are built too, and a
    file of known volumes where it does not lie beside or above the model."""

    binary: str
    lines: int = 20_000
    seed: int = 1
    cells: bool = True
    reference: Path | None = None


@dataclass
class Result:
    """The row of one model. `failures` is empty where everything agrees; the other fields are what the table shows."""

    model: str
    status: str = "ok"
    failures: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    brushes: int = 0
    cells: int | None = None
    reference_volume: float = math.nan
    differences: dict[str, float] = field(default_factory=dict)
    triangles: int = 0
    lines: dict = field(default_factory=dict)
    cell_lines: dict = field(default_factory=dict)
    seconds: float = 0.0

    def same(
        self,
        name: str,
        value: float | None,
        expected: float,
        scale: float | None = None,
        rounding: float | None = None,
        limit: float = SAME,
    ) -> None:
        """Notes the relative difference of two numbers, and a failure where it is too large or a number is missing.

        With `rounding`, an absolute difference that rounding alone explains, the limit beside it is `CELLS_SAME`.
        """
        if value is None:
            self.failures.append(f"{name}: not in the report")
            return
        scale = abs(expected) if scale is None else scale
        difference = abs(value - expected) / scale if scale else abs(value - expected)
        self.differences[name] = difference
        if rounding is not None:
            limit = CELLS_SAME + rounding / (scale or 1.0)
        if not difference <= limit:
            self.failures.append(f"{name}: {value!r}, expected {expected!r} (relative difference {difference:.1e})")

    def equal(self, name: str, value, expected) -> None:
        """Notes a failure where two things are not the same."""
        if value != expected:
            self.failures.append(f"{name}: {value!r}, expected {expected!r}")
