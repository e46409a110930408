"""Jobs as tasks of Dask."""

from __future__ import annotations

import importlib
from typing import Any

from ._remote import RETRIES, Answer, Settings, carry_out
from ._server import CarryOut

def connect(settings: Settings, threads: int) -> tuple[CarryOut, int]:
    """What has a request carried out by a task, and the number of cores; the current client is used, or one begins on this machine."""
    # by its name: its types, where it has some, are not complete
    distributed: Any = importlib.import_module("distributed")

    try:
        client = distributed.default_client()
    except ValueError:
        client = distributed.Client()

    def by_task(request: dict[str, Any]) -> Answer:
        # not pure: the inputs may be others the next time
        answer: Answer = client.submit(carry_out, request, settings, pure=False, retries=RETRIES).result()
        return answer

    return by_task, sum(client.nthreads().values())
