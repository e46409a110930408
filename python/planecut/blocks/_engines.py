"""Blocks evaluated by the tasks of a cluster: the bytes of a block go out, those of its piece come back."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol

from .._planecut import PlanecutError, Plan, evaluate_block

Progress = Callable[[int, int], object]
"""Is told how many blocks of how many are done."""


class Engine(Protocol):
    """What a cluster does for a plan."""

    def cores(self) -> int:
        """How many cores it has."""

    def begin(self, block: bytes) -> Any:
        """Begins a task."""

    def wait(self, tasks: list[Any]) -> list[Any]:
        """Waits for tasks; gives those that have ended, one at least."""

    def piece(self, task: Any) -> bytes:
        """What a task gave; raises what it raised."""

    def cancel(self, tasks: list[Any]) -> None:
        """Ends tasks of which nobody wants anything any more."""


def evaluate_one(block: bytes) -> bytes:
    """A task: a block on one core."""
    return evaluate_block(block, threads=1)


def evaluate(plan: Plan, engine: str, workers: int | None, address: str | None, progress: Progress | None) -> None:
    """Has the blocks evaluated whose pieces are not there."""
    connected: Callable[[str | None], AbstractContextManager[Engine]]
    if engine == "ray":
        from . import _ray

        connected = _ray.connected
    elif engine == "dask":
        from . import _dask

        connected = _dask.connected
    else:
        raise PlanecutError(f"engine: found {engine!r}, expected 'local', 'ray' or 'dask'")
    with connected(address) as cluster:
        _carry_out(plan, cluster, workers, progress)


def _carry_out(plan: Plan, cluster: Engine, workers: int | None, progress: Progress | None) -> None:
    count, done = len(plan.blocks), 0
    # the bytes of a block are with its task alone: this process holds a number
    running: dict[Any, int] = {}

    def tell() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, count)

    def collect() -> None:
        for task in cluster.wait(list(running)):
            plan._store(running.pop(task), cluster.piece(task))
            tell()

    try:
        for number in range(count):
            block = plan._missing(number)
            if block is None:
                tell()
                continue
            running[cluster.begin(block)] = number
            while len(running) >= (workers or 2 * cluster.cores()):
                collect()
        while running:
            collect()
    finally:
        cluster.cancel(list(running))
