"""Where a run was made, and with what."""

import json
import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path

_MODULES = Path(__file__).resolve().parents[1] / "node_modules"
_LIBRARIES = {"trimesh": "trimesh", "manifold3d": "manifold3d", "lib3mf": "lib3mf"}
_SCRIPTS = {"glTF validator": "gltf-validator", "three.js": "three"}


def processor() -> str:
    """The processor's model and how many of its cores are here."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return f"{len(os.sched_getaffinity(0))} cores of {models[0] if models else platform.machine()}"


def versions(chromium: str | None, openscad: str | None) -> str:
    """All that read planecut's files, as they are installed."""
    found = {name: _module(module) for name, module in _SCRIPTS.items()}
    found |= {name: version(package) for name, package in _LIBRARIES.items()}
    found |= {name: _program(path) for name, path in {"Chromium": chromium, "OpenSCAD": openscad}.items() if path}
    return ", ".join(f"{name} {number}" for name, number in found.items())


def _module(name: str) -> str:
    return json.loads((_MODULES / name / "package.json").read_text(encoding="utf-8"))["version"]


def _program(path: str) -> str:
    done = subprocess.run([path, "--version"], capture_output=True, text=True, check=False)
    words = (done.stdout + done.stderr).split()
    return next((word for word in words if word[0].isdigit() and "." in word), "unknown")
