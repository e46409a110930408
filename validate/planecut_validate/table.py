"""Results as rows on standard output."""

import math
from collections.abc import Iterable, Iterator
from pathlib import Path

from .result import Result

_ROW = "{:<{w}} {:>7} {:>7} {:>16} {:>8} {:>8} {:>8} {:>9} {:>6} {:>7} {:>5}  {}"
_HEAD = ("model", "bodies", "cells", "volume", "solid", "mesh", "all", "triangles", "lines", "redrawn", "s", "status")
_SINGLE_PRECISION = "GLB volume"


def rows(results: Iterable[Result], names: list[str]) -> Iterator[Result]:
    """Prints each result when it comes, below a head.

    Columns `solid`, `mesh`, `all`: relative volume difference of report and OBJ, and the largest of all differences.
    """
    width = min(44, max(len(short(name)) for name in names))
    print(_ROW.format(*_HEAD, w=width))
    for result in results:
        _print(result, width)
        yield result


def short(name: str) -> str:
    """File and folder."""
    return "/".join(Path(name).parts[-2:])


def largest(result: Result) -> float | None:
    """The largest relative difference that is not single precision's."""
    return max((value for name, value in result.differences.items() if name != _SINGLE_PRECISION), default=None)


def _print(result: Result, width: int) -> None:
    difference = result.differences
    every = largest(result)
    print(
        _ROW.format(
            short(result.model)[-width:],
            result.brushes,
            "" if result.cells is None else result.cells,
            "" if math.isnan(result.reference_volume) else f"{result.reference_volume:.6f}"[:16],
            f"{difference['solid.volume']:.0e}" if "solid.volume" in difference else "",
            f"{difference['OBJ volume']:.0e}" if "OBJ volume" in difference else "",
            "" if every is None else f"{every:.0e}",
            result.triangles,
            result.lines.get("mismatches", ""),
            result.lines.get("redrawn", ""),
            f"{result.seconds:.1f}",
            "; ".join([result.status, *result.notes]),
            w=width,
        ),
        flush=True,
    )
    for failure in result.failures:
        print(f"    {failure}", flush=True)


def summed(results: Iterable[Result]) -> list[Result]:
    """Prints failures as they come, and then one line per kind of difference, the worst first."""
    kept = []
    for result in results:
        kept.append(result)
        if result.failures:
            print(f"FAIL {result.model}", *result.notes, sep="\n    ")
            print(*(f"    {failure}" for failure in result.failures), sep="\n", flush=True)
    states: dict[str, int] = {}
    worst: dict[str, tuple[float, str, int]] = {}
    for result in kept:
        states[result.status] = states.get(result.status, 0) + 1
        for name, value in result.differences.items():
            old, where, count = worst.get(name, (-1.0, "", 0))
            worst[name] = (value, result.model, count + 1) if value > old else (old, where, count + 1)
    print(f"{len(kept)}: " + ", ".join(f"{count} {state}" for state, count in sorted(states.items())))
    for name, (value, where, count) in sorted(worst.items(), key=lambda item: -item[1][0]):
        print(f"    {name:<28} {count:>6} compared, largest relative difference {value:.1e} ({where})")
    return kept
