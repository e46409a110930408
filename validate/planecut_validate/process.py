"""Runs of the `planecut` command line."""

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

TIMEOUT = 600
"""Seconds after which a run counts as hung."""


class Refused(Exception):
    """planecut said no, by its rules: exit status 1 or 2 and one line that starts with `error:`."""


class Broken(Exception):
    """planecut broke its own rules: a crash, a hang, an error without a message, an output that is not there."""


@dataclass
class Build:
    """What one `planecut build` left: the mesh files, the report, and what it said on standard error."""

    obj: Path
    glb: Path
    report: dict
    said: str


def build(binary: str, model: Path, folder: Path, cells: bool = False) -> Build:
    """Runs `planecut build` into `folder`, of cells on demand. Raises `Refused` or `Broken`."""
    name = "cells" if cells else "out"
    obj, glb, report = (folder / f"{name}{ending}" for ending in (".obj", ".glb", ".report.json"))
    command = [binary, "build", str(model), "-o", str(obj), "-o", str(glb), "--report", str(report), "--quiet"]
    try:
        done = subprocess.run(
            command + ["--cells"] * cells, capture_output=True, text=True, timeout=TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise Broken(f"no end within {TIMEOUT} s") from error
    # 3: written, with something left out: what is there is compared all the same
    if done.returncode not in (0, 3):
        errors = [line for line in done.stderr.splitlines() if line.startswith("error:")]
        left = [p.name for p in (obj, glb, report) if p.exists()]
        if done.returncode not in (1, 2) or len(errors) != 1 or left:
            raise Broken(f"exit status {done.returncode}, left {left}, said {done.stderr.strip()[-300:]!r}")
        raise Refused(errors[0])
    missing = [p.name for p in (obj, glb, report) if not p.exists()]
    if missing:
        raise Broken(f"exit status 0 but no {', '.join(missing)}")
    return Build(obj, glb, json.loads(report.read_text(encoding="utf-8")), done.stderr)
