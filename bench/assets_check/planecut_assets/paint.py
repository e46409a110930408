"""Inputs painted all over in one colour that neither the background of previews nor a shadow on it has."""

import json
import re
from pathlib import Path
from typing import Any

ORANGE = [0.9, 0.3, 0.05]
"""Linear red, green, blue; far from the background's bluish grey in any light."""

ORANGE_NAME = "paint847"
"""A texture's name from which planecut derives an orange, as saturated as such colours are."""

FACE = re.compile(rb"^(\s*(?:\([^()]*\)\s*){3})(\"[^\"\r\n]*\"|[^\s()]+)", re.MULTILINE)
"""A face of a map: three points and the texture."""


def painted(source: Path, folder: Path) -> Path:
    """A copy of a model, map or tree in which everything has that colour."""
    data = source.read_bytes()
    copy = folder / f"painted{source.suffix}"
    copy.write_bytes({".json": _model, ".map": _map, ".csg": _tree}[source.suffix](data))
    return copy


def _model(data: bytes) -> bytes:
    model = _without_materials(json.loads(data))
    model["materials"] = {"paint": {"color": ORANGE}}
    model["model"]["material"] = "paint"
    return json.dumps(model).encode()


def _without_materials(value: Any) -> Any:
    """The same JSON value where nothing has a material."""
    if isinstance(value, list):
        return [_without_materials(item) for item in value]
    if isinstance(value, dict):
        kept = {key: item for key, item in value.items() if key not in ("material", "materials")}
        return {key: _without_materials(item) for key, item in kept.items()}
    return value


def _map(data: bytes) -> bytes:
    return FACE.sub(rb"\1" + ORANGE_NAME.encode(), data)


def _tree(data: bytes) -> bytes:
    """Colours of the tree are taken out: which of two within one another counts is a matter of its own."""
    display = ", ".join(f"{channel ** (1 / 2.2):.3f}" for channel in ORANGE)
    return b"color([%s, 1]) {\n%s\n}\n" % (display.encode(), re.sub(rb"\bcolor\([^()]*\)", b"group()", data))
