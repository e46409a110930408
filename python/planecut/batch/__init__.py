"""Many jobs, each in a process with its limits: on this machine, or on the workers of Ray or Dask.

>>> import json, pathlib, tempfile
>>> import planecut as pc
>>> folder = pathlib.Path(tempfile.mkdtemp())
>>> model = {"planecut": 1, "parameters": {"w": 1}, "model": {"box": {"min": [0, 0, 0], "max": ["=w", 1, 1]}}}
>>> _ = (folder / "box.json").write_text(json.dumps(model))
>>> jobs = [
...     {"id": f"box-{w}", "command": "build", "input": str(folder / "box.json"), "outputs": [f"box-{w}.glb"], "options": {"set": {"w": w}}}
...     for w in (2, 3)
... ]
>>> [(result.id, result.status, result.files) for result in pc.batch.run(jobs, folder / "out")]
[('box-2', 0, ['box-2.glb']), ('box-3', 0, ['box-3.glb'])]
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from .._planecut import PlanecutError

__all__ = ["JobResult", "run"]


@dataclass(frozen=True)
class JobResult:
    """What became of a job: a line of `results.jsonl`."""

    id: str
    """The name that the job has in the manifest."""
    status: int
    """0 done; 1 failed, or over its limits; 2 unusable input; 3 done, but a solid that the input states was left out."""
    seconds: float
    """How long it took when it was done."""
    cached: bool
    """Whether it was taken from the cache."""
    error: str | None
    """Why it failed."""
    warnings: list[str]
    """What the command warned of."""
    files: list[str]
    """The files that were written, by their names in the folder of outputs."""


def run(
    jobs: Iterable[Mapping[str, Any]] | str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    engine: Literal["local", "ray", "dask"] = "local",
    cache: str | os.PathLike[str] | None = None,
    cache_size: int | None = None,
    verify_cache: int = 0,
    workers: int | None = None,
    timeout: float | None = None,
    memory: int | None = None,
    threads: int | None = None,
) -> list[JobResult]:
    """Does jobs, and gives what became of each, in their order.

    What is up to date in `out` from an earlier run, or in the cache, is not made again; a run that was killed goes on where it was. The same jobs give the same bytes with every engine.

    Args:
        jobs: Mappings with `id`, `command`, `input`, `outputs` and `options`, as in a manifest of `planecut batch`, or the name of a manifest.
        out: The folder for outputs and `results.jsonl`; it is made where it is missing.
        engine: Where jobs are done: in processes of this machine, by tasks of Ray (`planecut[ray]`), or of Dask (`planecut[dask]`), whose client is the current one, or one of this
            machine. Workers must see the inputs under the same names; outputs come back to this process.
        cache: A folder of results by the content of inputs, which other processes and machines may share.
        cache_size: Megabytes that the cache is cut down to in the end.
        verify_cache: How many results found in the cache are made again, to compare the bytes.
        workers: Number of jobs at a time; by default as many as there are cores, or cores of the cluster.
        timeout: Most seconds that a job may take.
        memory: Most megabytes that a job may take (on Unix).
        threads: Number of threads of each job.

    Raises:
        PlanecutError: Jobs that are none, and a folder that cannot be written. A job that fails is a result.
    """
    arguments = ["--out", os.fspath(out), "--quiet"]
    given = {"cache": cache, "cache-size": cache_size, "timeout": timeout, "memory": memory, "threads": threads}
    arguments += [f"--{name}={os.fspath(value) if isinstance(value, os.PathLike) else value}" for name, value in given.items() if value is not None]
    if cache is not None:
        arguments.append(f"--verify-cache={verify_cache}")
    if isinstance(jobs, (str, os.PathLike)):
        manifest, text = os.fspath(jobs), b""
    else:
        manifest, text = "-", b"".join(json.dumps(dict(job)).encode() + b"\n" for job in jobs)
    arguments.insert(0, manifest)
    program = [sys.executable, "-m", "planecut"]
    if engine == "local":
        arguments += [f"--worker-command={word}" for word in program]
        return _results([*program, "batch", *arguments, *_count(workers)], text, out, {})
    from ._remote import Settings
    from ._server import Server

    settings = Settings(os.getcwd(), timeout, memory)
    if engine == "ray":
        from ._ray import connect
    elif engine == "dask":
        from ._dask import connect
    else:
        raise PlanecutError(f"engine: found {engine!r}, expected 'local', 'ray' or 'dask'")
    carry_out, cores = connect(settings, threads or 1)
    with Server(carry_out) as server:
        arguments += [f"--worker-address={server.address}", *_count(workers or max(1, cores // (threads or 1)))]
        if threads is None:
            arguments.append("--threads=1")
        return _results([*program, "batch", *arguments], text, out, {"PLANECUT_BATCH_TOKEN": server.token})


def _count(workers: int | None) -> list[str]:
    return [] if workers is None else [f"--jobs={workers}"]


def _results(command: list[str], manifest: bytes, out: str | os.PathLike[str], more: dict[str, str]) -> list[JobResult]:
    ended = subprocess.run(command, input=manifest, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env={**os.environ, **more}, check=False)
    said = ended.stderr.decode(errors="replace").strip().removeprefix("error: ")
    path = Path(out) / "results.jsonl"
    # with exit status 1 jobs have failed, which the results tell, or there are none
    if ended.returncode not in (0, 1, 3) or (ended.returncode == 1 and not said.startswith(f"{path}: found ")):
        raise PlanecutError(said or f"found an end with exit status {ended.returncode}, expected results")
    names = JobResult.__dataclass_fields__
    lines = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return [JobResult(**{"warnings": [], "files": [], **{name: value for name, value in line.items() if name in names}}) for line in lines]
