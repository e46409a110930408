"""The Khronos glTF validator on every glTF file."""

import json
import subprocess
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from .assets import Asset
from .setting import Setting

_PROGRAM = Path(__file__).resolve().parents[1] / "javascript" / "validate.js"

TIMEOUT = 1800
"""Seconds for all files together."""


@dataclass
class Code:
    """A kind of message: how often, in how many files, and one of them."""

    severity: str
    code: str
    message: str
    count: int = 0
    files: int = 0
    example: str = ""


def validate(setting: Setting, assets: list[Asset]) -> tuple[int, list[Code]]:
    """How many files were validated, and all kinds of messages; errors, warnings and hints go to `setting`."""
    by_path = {str(asset.path): asset for asset in assets if asset.ending in ("glb", "gltf")}
    done = subprocess.run(
        ["node", _PROGRAM], input="\n".join(by_path), capture_output=True, text=True, timeout=TIMEOUT, check=True
    )
    codes: dict[tuple[str, str, str], Code] = {}
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    for answer in answers:
        asset = by_path[answer["path"]]
        kinds = defaultdict(list)
        for message in answer["messages"]:
            # Of an extension that the validator does not know, its name is part of the kind.
            text = message["message"] if message["code"] == "UNSUPPORTED_EXTENSION" else ""
            kinds[message["severity"], message["code"], text].append(message)
        for kind, messages in kinds.items():
            severity, name, _ = kind
            code = codes.setdefault(kind, Code(severity, name, messages[0]["message"], example=asset.where))
            code.count += len(messages)
            code.files += 1
            if severity != "info":
                first = messages[0]
                setting.fail(asset.where, f"{severity} {name} ×{len(messages)}: {first['message']} ({first['place']})")
    if len(answers) != len(by_path):
        setting.fail("glTF validator", f"{len(answers)} answers for {len(by_path)} files")
    return len(answers), sorted(codes.values(), key=lambda code: (code.severity, code.code))
