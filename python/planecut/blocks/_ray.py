"""Blocks as tasks of Ray."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..batch._remote import RETRIES
from ._engines import evaluate_one


class _Ray:
    def __init__(self, ray: Any) -> None:
        self._ray = ray
        self._task = ray.remote(num_cpus=1, max_retries=RETRIES)(evaluate_one)

    def cores(self) -> int:
        return max(1, int(self._ray.cluster_resources().get("CPU", 1)))

    def begin(self, block: bytes) -> Any:
        return self._task.remote(block)

    def wait(self, tasks: list[Any]) -> list[Any]:
        ended: list[Any] = self._ray.wait(tasks, num_returns=1)[0]
        return ended

    def piece(self, task: Any) -> bytes:
        try:
            piece: bytes = self._ray.get(task)
        except self._ray.exceptions.RayTaskError as error:
            # as it was raised, without the text of another process
            raise error.cause from None
        return piece

    def cancel(self, tasks: list[Any]) -> None:
        for task in tasks:
            self._ray.cancel(task)


@contextmanager
def connected(address: str | None) -> Iterator[_Ray]:
    """The cluster at an address; the one that there is, or one that begins on this machine, and stays."""
    # by its name: its types, where it has some, are not complete
    ray: Any = importlib.import_module("ray")

    if not ray.is_initialized():
        ray.init(address=address) if address is not None else ray.init(include_dashboard=False)
    yield _Ray(ray)
