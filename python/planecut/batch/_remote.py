"""What a worker of a cluster does: a job in a process of its own, which is kept, and whose outputs go back as bytes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

RETRIES = 3
"""How often a job is begun again whose worker was lost."""

Answer = tuple[dict[str, Any], dict[str, bytes]]
"""What became of a request, and the files that it made, by their names."""


@dataclass(frozen=True)
class Settings:
    """What holds for all jobs."""

    folder: str
    """The working folder, from which the names of inputs are taken."""
    timeout: float | None
    """Most seconds that a job may take."""
    memory: int | None
    """Most megabytes that a job may take."""


# of each thread: a worker may have several
_kept = threading.local()


def _process(settings: Settings) -> subprocess.Popen[bytes]:
    process: subprocess.Popen[bytes] | None = getattr(_kept, "process", None)
    if process is None or process.poll() is not None or _kept.settings != settings:
        command = [sys.executable, "-m", "planecut", "batch", "--worker"]
        environment = dict(os.environ)
        if settings.memory is not None:
            command.append(f"--memory={settings.memory}")
            # the allocator takes address space ahead of need: that counts as taken unless it is told so
            environment["MIMALLOC_ARENA_EAGER_COMMIT"] = "0"
        pipe, folder = subprocess.PIPE, settings.folder
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, cwd=folder, env=environment)
        _kept.process, _kept.settings = process, settings
    return process


def failed(message: str) -> dict[str, Any]:
    """The answer of a job that could not be done."""
    return {"status": 1, "seconds": 0.0, "error": message, "warnings": [], "text": "", "read": [], "is_last": False}


def carry_out(request: dict[str, Any], settings: Settings) -> Answer:
    """Has a command line carried out, and gives its answer and its outputs."""
    process = _process(settings)
    assert process.stdin is not None and process.stdout is not None
    with tempfile.TemporaryDirectory() as name:
        there, here = request["folder"], str(Path(name) / "out")
        for folder in request.get("folders", [""]):
            (Path(here) / folder).mkdir(parents=True, exist_ok=True)
        asked = {"arguments": [argument.replace(there, here) for argument in request["arguments"]], "folder": here}
        timer = threading.Timer(settings.timeout or threading.TIMEOUT_MAX, process.kill)
        timer.daemon = True
        timer.start()
        try:
            process.stdin.write(json.dumps(asked).encode() + b"\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except OSError:
            line = b""
        finally:
            timer.cancel()
        if not line:
            process.kill()
            process.wait()
            return failed("found its process ended, expected an answer: it took too long, too much memory, or has a bug"), {}
        answer: dict[str, Any] = json.loads(line)
        if answer["error"] is not None:
            answer["error"] = answer["error"].replace(here, there)
        answer["warnings"] = [warning.replace(here, there) for warning in answer["warnings"]]
        made = [path for path in sorted(Path(here).rglob("*")) if path.is_file()]
        return answer, {str(path.relative_to(here)): path.read_bytes() for path in made}
