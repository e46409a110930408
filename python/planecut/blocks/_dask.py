"""Blocks as tasks of Dask."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..batch._remote import RETRIES
from ._engines import evaluate_one


class _Dask:
    def __init__(self, distributed: Any, client: Any) -> None:
        self._distributed, self._client = distributed, client

    def cores(self) -> int:
        threads: dict[str, int] = self._client.nthreads()
        return max(1, sum(threads.values()))

    def begin(self, block: bytes) -> Any:
        # the bytes are part of the task: data that a worker held would be lost with it
        return self._client.submit(evaluate_one, block, pure=False, retries=RETRIES)

    def wait(self, tasks: list[Any]) -> list[Any]:
        return list(self._distributed.wait(tasks, return_when="FIRST_COMPLETED").done)

    def piece(self, task: Any) -> bytes:
        piece: bytes = task.result()
        return piece

    def cancel(self, tasks: list[Any]) -> None:
        self._client.cancel(tasks)


@contextmanager
def connected(address: str | None) -> Iterator[_Dask]:
    """The cluster at an address; the one that there is, or one that begins on this machine, and stays."""
    # by its name: its types, where it has some, are not complete
    distributed: Any = importlib.import_module("distributed")
    config: Any = importlib.import_module("dask.config")

    # that a task brings many bytes along is meant so
    with config.set({"distributed.admin.large-graph-warning-threshold": "1 TiB"}):
        if address is not None:
            with distributed.Client(address, set_as_default=False) as client:
                yield _Dask(distributed, client)
            return
        try:
            client = distributed.default_client()
        except ValueError:
            client = distributed.Client()
        yield _Dask(distributed, client)
