"""Jobs as tasks of Ray."""

from __future__ import annotations

import importlib
from typing import Any

from ._remote import RETRIES, Answer, Settings, carry_out
from ._server import CarryOut

def connect(settings: Settings, threads: int) -> tuple[CarryOut, int]:
    """What has a request carried out by a task, and the number of cores; joins the cluster that there is, or begins one on this machine."""
    # by its name: its types, where it has some, are not complete
    ray: Any = importlib.import_module("ray")

    if not ray.is_initialized():
        ray.init(include_dashboard=False)
    task = ray.remote(num_cpus=threads, max_retries=RETRIES)(carry_out)

    def by_task(request: dict[str, Any]) -> Answer:
        answer: Answer = ray.get(task.remote(request, settings))
        return answer

    return by_task, int(ray.cluster_resources().get("CPU", 1))
