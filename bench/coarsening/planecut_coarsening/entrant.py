"""Runs of planecut, CoACD, V-HACD and pchs, each in a process of its own."""

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from .bodies import Body, read_bodies

TIMEOUT = 1800
"""Seconds after which a run counts as hung."""


class Failed(Exception):
    """A run that ended without a result."""


@dataclass(frozen=True)
class Run:
    """The cells that a run has written, its seconds, and planecut's report."""

    bodies: list[Body]
    seconds: float
    report: dict


def planecut(binary: Path, source: Path, folder: Path, *options: str) -> Run:
    """`planecut coarsen`; the seconds are those of the whole process. Raises `Failed`."""
    output, report = folder / "cells.obj", folder / "report.json"
    command = [binary, "coarsen", source, "-o", output, "--report", report, "--quiet", *options]
    begin = time.perf_counter()
    _run(command)
    seconds = time.perf_counter() - begin
    return Run(read_bodies(output), seconds, json.loads(report.read_text(encoding="utf-8"))["coarsen"])


def planecut_files(binary: Path, source: Path, folder: Path, *options: str) -> list[Path]:
    """`planecut coarsen` with a file for each cell. Raises `Failed`."""
    _run([binary, "coarsen", source, "-o", folder / "cell_{}.obj", "--quiet", *options])
    return sorted(folder.glob("cell_*.obj"), key=lambda path: int(path.stem.split("_")[1]))


def library(name: str, source: Path, folder: Path, **settings: float) -> Run:
    """One of `worker`'s libraries; the seconds are those of the call alone, the report what it tells of its phases. Raises `Failed`."""
    output = folder / "hulls.obj"
    module = f"{__package__}.worker"
    said = _run([sys.executable, "-m", module, name, source, output, json.dumps(settings)])
    # The libraries may have said something before.
    seconds, *phases = said.splitlines()[-1].split()
    return Run(read_bodies(output), float(seconds), {name: float(value) for name, _, value in (p.partition("=") for p in phases)})


def lowered(binary: Path, source: Path, faces: int, folder: Path) -> tuple[Body, float, float]:
    """The example `fewer_faces`: the body, and the seconds of the hull and of the call of the library alone. Raises `Failed`."""
    output = folder / "lowered.obj"
    hull, seconds = map(float, _run([binary, source, faces, output]).split())
    (body,) = read_bodies(output)
    return body, hull, seconds


def _run(command: list) -> str:
    """What the process says on standard output."""
    try:
        done = subprocess.run(
            [str(word) for word in command], capture_output=True, text=True, timeout=TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise Failed(f"no end within {TIMEOUT} s") from error
    if done.returncode != 0:
        raise Failed(f"exit status {done.returncode}: {done.stderr.strip()[-200:]}")
    return done.stdout
