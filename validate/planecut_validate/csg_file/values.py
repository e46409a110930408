"""Arguments as numbers, the way OpenSCAD takes what is not quite what it asks for."""

import math


def number(value, default: float) -> float:
    """A number; anything else is the default."""
    return value if isinstance(value, float) else default


def flag(value, default: bool = False) -> bool:
    """`true` or `false`; anything else is the default."""
    return value if isinstance(value, bool) else default


def vector(value, count: int) -> list[float] | None:
    """A list of exactly this many numbers, else None."""
    fits = isinstance(value, list) and len(value) == count and all(isinstance(v, float) for v in value)
    return value if fits else None


def sizes(value, count: int) -> list[float]:
    """A number for all axes, or one per axis; else ones."""
    return [value] * count if isinstance(value, float) else vector(value, count) or [1.0] * count


def point(value, shortest: int, count: int) -> list[float] | None:
    """A list of `shortest` to `count` finite numbers with zeros for those that are missing, else nothing."""
    if not isinstance(value, list) or not shortest <= len(value) <= count:
        return None
    if not all(isinstance(v, float) and math.isfinite(v) for v in value):
        return None
    return value + [0.0] * (count - len(value))


def indices(value) -> list[int]:
    """Whole numbers of a list; what is no number is left out."""
    if not isinstance(value, list):
        return []
    return [int(v) for v in value if isinstance(v, float) and math.isfinite(v) and v >= 0.0]
