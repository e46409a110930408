"""Batches: the same results and bytes on this machine, with Ray and with Dask, also where a worker is killed half-way."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import planecut as pc
import pytest
from workers import Killer, needs_dask, needs_ray, ray_worker

MODEL = {"planecut": 1, "parameters": {"w": 1}, "model": {"box": {"min": [0, 0, 0], "max": ["=w", 1, 1]}}}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.json").write_text(json.dumps(MODEL))
    return tmp_path


def jobs(count: int) -> list[dict[str, Any]]:
    """Boxes of all widths; one of them fails, and one has files in a folder."""
    made: list[dict[str, Any]] = [
        {"id": f"{w}", "command": "build", "input": "box.json", "outputs": [f"{w}.glb"], "options": {"set": {"w": w}}} for w in range(1, count + 1)
    ]
    made.append({"id": "none", "command": "build", "input": "nosuch.json", "outputs": ["none.glb"]})
    made.append({"id": "deep", "command": "build", "input": "box.json", "outputs": ["a/b/deep.obj"], "options": {"mtl": True}})
    return made


def content(out: Path) -> dict[str, bytes]:
    """All outputs by name."""
    return {str(path.relative_to(out)): path.read_bytes() for path in sorted(out.rglob("*")) if path.is_file() and path.name != "results.jsonl"}


def told(results: list[pc.batch.JobResult]) -> list[tuple[str, int, str | None, list[str]]]:
    """What must be the same wherever jobs are done."""
    return [(result.id, result.status, result.error, result.files) for result in results]


def test_jobs_give_the_bytes_of_their_commands(folder: Path) -> None:
    results = pc.batch.run(jobs(3), "out", workers=2)
    assert [result.id for result in results] == ["1", "2", "3", "none", "deep"]
    assert [result.status for result in results] == [0, 0, 0, 2, 0]
    assert results[3].error == "nosuch.json: found no such file, expected a file that can be read"
    assert results[4].files == ["a/b/deep.mtl", "a/b/deep.obj"]
    for w in (1, 2, 3):
        subprocess.run([sys.executable, "-m", "planecut", "build", "box.json", "-o", "alone.glb", f"--set=w={w}"], check=True)
        assert (folder / "out" / f"{w}.glb").read_bytes() == (folder / "alone.glb").read_bytes()
        assert pc.load(folder / "out" / f"{w}.glb").volume == pytest.approx(w, rel=1e-12)
    # up to date: told as they were, but for the one that failed
    again = pc.batch.run(jobs(3), "out")
    assert [one == other for one, other in zip(again, results, strict=True)] == [True, True, True, False, True]


def test_a_manifest_and_a_cache(folder: Path) -> None:
    (folder / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in jobs(4)))
    first = pc.batch.run("jobs.jsonl", "first", cache=folder / "cache")
    second = pc.batch.run(folder / "jobs.jsonl", Path("second"), cache="cache", verify_cache=2)
    assert [result.cached for result in first] == [False] * 6
    assert [result.cached for result in second] == [True, True, True, True, False, True]
    assert told(first) == told(second)
    assert content(folder / "first") == content(folder / "second")


def test_limits_of_a_job(folder: Path) -> None:
    (folder / "slow.json").write_text(json.dumps({"planecut": 1, "model": {"torus": {"radius": 2, "tube": 1, "segments": 1400, "tube_segments": 1400}}}))
    slow = {"id": "slow", "command": "build", "input": "slow.json", "outputs": ["slow.glb"]}
    results = pc.batch.run([slow, *jobs(1)], "out", timeout=2, workers=1)
    assert [result.status for result in results] == [1, 0, 2, 0]
    assert results[0].error is not None and "expected no more (--timeout)" in results[0].error


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"id": "a", "command": "build", "input": "box.json"}, "standard input:1: found 0 outputs"),
        ({"id": "a", "command": "sell", "input": "box.json"}, "standard input:1: found unknown variant `sell`"),
        ({"id": "a", "command": "build", "input": "box.json", "outputs": ["/a.glb"]}, 'found the output "/a.glb"'),
    ],
)
def test_what_is_no_job_is_an_error(folder: Path, job: dict[str, Any], message: str) -> None:
    with pytest.raises(pc.PlanecutError, match=message.replace("(", r"\(")):
        pc.batch.run([job], "out")
    assert not (folder / "out").exists()


def test_another_engine_is_an_error(folder: Path) -> None:
    with pytest.raises(pc.PlanecutError, match="found 'spark', expected 'local', 'ray' or 'dask'"):
        pc.batch.run(jobs(1), "out", engine="spark")  # type: ignore[arg-type]


def has_done(out: Path, count: int) -> bool:
    """Whether this number of jobs is done."""
    results = out / "results.jsonl"
    return results.is_file() and results.read_text().count("\n") >= count


@pytest.fixture
def dask_client() -> Iterator[Any]:
    import distributed

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        yield client


@needs_dask
def test_dask_gives_the_same_though_a_worker_is_killed(folder: Path, dask_client: Any) -> None:
    many = jobs(150)
    local = pc.batch.run(many, "local")

    killer = Killer(lambda: has_done(folder / "dask", 30), lambda: next(iter(dask_client.run(os.getpid).values())))
    results = pc.batch.run(many, "dask", engine="dask")
    killer.assert_killed()
    assert told(results) == told(local)
    assert content(folder / "dask") == content(folder / "local")


@needs_ray
def test_ray_gives_the_same_though_a_worker_is_killed(folder: Path) -> None:
    import ray

    many = jobs(150)
    local = pc.batch.run(many, "local")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        killer = Killer(lambda: has_done(folder / "ray", 30), lambda: ray_worker("carry_out"))
        results = pc.batch.run(many, "ray", engine="ray")
        killer.assert_killed()
    finally:
        ray.shutdown()
    assert told(results) == told(local)
    assert content(folder / "ray") == content(folder / "local")


def test_nobody_else_is_answered(folder: Path) -> None:
    """A process of this machine that does not know the token gets nothing done."""
    import socket

    from planecut.batch._remote import failed
    from planecut.batch._server import Server

    asked: list[dict[str, Any]] = []

    def carry_out(request: dict[str, Any]) -> tuple[dict[str, Any], dict[str, bytes]]:
        asked.append(request)
        return failed("found a test"), {}

    with Server(carry_out) as server:
        host, port = server.address.split(":")
        for token, answers in ((server.token, True), ("", False), ("0" * 32, False)):
            with socket.create_connection((host, int(port)), timeout=20) as connection:
                request = json.dumps({"arguments": [], "folder": str(folder)})
                connection.sendall(f"{token}\n{request}\n".encode())
                try:
                    answer = connection.recv(10_000)
                except ConnectionResetError:
                    answer = b""
                assert bool(answer) == answers
    assert len(asked) == 1
