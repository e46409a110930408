"""Where a run was made."""

import os
import platform
from importlib.metadata import version
from pathlib import Path

_OTHERS = {"CoACD": "coacd", "V-HACD": "vhacdx", "manifold3d": "manifold3d", "MuJoCo": "mujoco", "PyBullet": "pybullet", "pchs": "pchs"}


def processor() -> str:
    """The processor's model and how many of its cores are here."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    fields = dict(map(_field, lines))
    model = fields.get("model name") or platform.machine()
    numbers = [fields.get(name) for name in ("cpu family", "model")]
    known = " (family {}, model {})".format(*numbers) if all(numbers) else ""
    return f"{len(os.sched_getaffinity(0))} cores of {model}{known}"


def versions() -> str:
    """The others and what measures them, as they are installed."""
    return ", ".join(f"{name} {version(package)}" for name, package in _OTHERS.items())


def _field(line: str) -> tuple[str, str]:
    name, _, value = line.partition(":")
    return name.strip(), value.strip()
