"""three.js in headless Chromium: what it makes of glTF files, and pictures as planecut's previews see them."""

import json
import math
import subprocess
from dataclasses import dataclass
from pathlib import Path

from .assets import PLAIN, Asset, Written
from .gltf_file import GltfFile
from .measure import Surface, Volume, compare
from .meshes import check_count
from .setting import SIZE, Setting
from .silhouette import Silhouette, background_of, compare_masks, mask_of_preview, mask_of_screenshot

_PROGRAM = Path(__file__).resolve().parents[1] / "javascript" / "view.js"

VIEW = ("-62", "32")
"""Azimuth and elevation of planecut's previews unless others are asked for."""

ATTRIBUTES = {"--uv": "uv", "--tangents": "tangent", "--vertex-colors": "color"}
"""What an option gives, as three.js names it."""

STRAYS = 1e-4
"""The part of the pixels that may lie away from the edges of the other mask.

On `bracket.json` a camera off by one degree strays by 3 times that (elevation) or 30 times (azimuth). The overlap tells
less: it is 0.99 then, and 0.83 for a model of wires a pixel wide where all is well.
"""

TIMEOUT = 3600
"""Seconds for all files together."""


@dataclass(frozen=True)
class Shown:
    """What three.js found in a file."""

    input: str
    where: str
    variant: str
    bytes: int
    facts: dict
    volume: Volume
    silhouette: Silhouette | None


def show_all(setting: Setting, chromium: str, written: list[Written], empty: Path) -> list[Shown]:
    """All GLB files and what they look like; what is amiss goes to `setting`."""
    shown, background = [], background_of(empty)
    jobs = [(inputs, asset) for inputs in written for asset in inputs.assets if asset.ending == "glb"]
    for (inputs, asset), answer in zip(jobs, _answers(chromium, [asset for _, asset in jobs]), strict=False):
        for said in answer["said"]:
            setting.fail(asset.where, f"three.js says: {said}")
        if "error" in answer:
            setting.fail(asset.where, f"three.js: {answer['error']}")
            continue
        facts = answer["facts"]
        silhouette = None
        if facts["triangles"] > 0 and inputs.preview:
            silhouette = compare_masks(mask_of_preview(inputs.preview, background), mask_of_screenshot(_picture(asset)))
        found = Surface(facts["volume"], facts["area"], _extent(facts))
        step = GltfFile.read(asset.path).half_step()
        volume = compare(asset.where, "three.js", found, asset.report, step)
        check_count(setting, asset, "three.js", facts["triangles"], step)
        one = Shown(asset.input, asset.where, asset.variant, asset.path.stat().st_size, facts, volume, silhouette)
        _check(setting, asset, one)
        shown.append(one)
    if len(shown) < len(jobs) and not setting.failures:
        setting.fail("three.js", f"{len(shown)} answers for {len(jobs)} files")
    return shown


def _check(setting: Setting, asset: Asset, shown: Shown) -> None:
    facts, expected = shown.facts, asset.report["mesh"]["triangles"]
    if shown.volume.amiss:
        setting.fail(asset.where, shown.volume)
    asked = ["normal", *(name for option, name in ATTRIBUTES.items() if option in asset.options)]
    missing = [name for name in asked if expected and name not in facts["attributes"]]
    if missing:
        setting.fail(asset.where, f"three.js finds no {', '.join(missing)} on all meshes")
    if facts["normals_against"] > 0.0:
        part = facts["normals_against"]
        setting.fail(asset.where, f"normals on {part:.1e} of the area look away from the side that triangles face")
    seen = shown.silhouette
    if seen and seen.strays > STRAYS * seen.pixels:
        setting.fail(asset.where, f"three.js draws another silhouette: {seen}")
    materials = asset.report["model"]["materials"]
    if asset.variant == PLAIN and expected and not 1 <= len(facts["materials"]) <= max(materials, 1):
        setting.fail(asset.where, f"three.js finds {len(facts['materials'])} materials, planecut reports {materials}")


def _answers(chromium: str, assets: list[Asset]) -> list[dict]:
    jobs = [json.dumps(_job(asset)) for asset in assets]
    command = ["node", str(_PROGRAM), chromium, "{}x{}".format(*SIZE), *VIEW]
    done = subprocess.run(command, input="\n".join(jobs), capture_output=True, text=True, timeout=TIMEOUT, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{_PROGRAM.name} ended with exit status {done.returncode}: {done.stderr[-500:]}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def _job(asset: Asset) -> dict:
    """A triangle that is turned over by rounding is no higher than what two points may move towards one another."""
    sliver = 2.0 * math.sqrt(3.0) * GltfFile.read(asset.path).half_step()
    return {"path": str(asset.path), "picture": str(_picture(asset)), "sliver": sliver}


def _picture(asset: Asset) -> Path:
    return asset.path.with_name(asset.path.name + ".three.png")


def _extent(facts: dict) -> float:
    return max((abs(value) for corner in facts["box"] or () for value in corner), default=0.0)
