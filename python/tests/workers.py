"""Worker processes of Ray and Dask, and a thread that kills one of them half-way."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import signal
import threading
import time
from collections.abc import Callable

import pytest

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="Ray is absent")
needs_dask = pytest.mark.skipif(importlib.util.find_spec("distributed") is None, reason="Dask is absent")


class Killer:
    """Kills a process as soon as work has come so far and there is one to kill."""

    def __init__(self, is_half_way: Callable[[], bool], victim: Callable[[], int | None]) -> None:
        self.is_half_way, self.victim = is_half_way, victim
        self.killed: int | None = None
        self.thread = threading.Thread(target=self._wait_and_kill, daemon=True)
        self.thread.start()

    def _wait_and_kill(self) -> None:
        until = time.monotonic() + 120
        while self.killed is None and time.monotonic() < until:
            process = self.victim() if self.is_half_way() else None
            # it may have ended since it was found
            with contextlib.suppress(ProcessLookupError):
                if process is not None:
                    os.kill(process, signal.SIGKILL)
                    self.killed = process
            time.sleep(0.01)

    def assert_killed(self) -> None:
        self.thread.join()
        assert self.killed is not None


def ray_worker(task: str) -> int | None:
    """A process that carries out this task for Ray, which names its workers after what they do, and "ray::IDLE" otherwise."""
    import psutil

    # the words of a process that has just ended are None
    for process in psutil.process_iter(["pid", "cmdline"]):
        words = process.info["cmdline"]
        if words and words[0].startswith(f"ray::{task}"):
            return int(process.info["pid"])
    return None
