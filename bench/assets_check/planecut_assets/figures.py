"""How large files are, and what writing a million triangles takes."""

from dataclasses import dataclass
from pathlib import Path

from .assets import Formats
from .inputs import write_million
from .setting import Setting

SIZED = "romero/e1m1.map"
PACKED = ("quantized", "meshopt", "quantized meshopt")


@dataclass(frozen=True)
class Size:
    """Bytes of a file, and what it has of the plain one's."""

    input: str
    variant: str
    bytes: int
    part: float


@dataclass(frozen=True)
class Million:
    """A large mesh as GLB.

    `export` is the part of the seconds that writing took, `memory` the most that was held at once.
    """

    variant: str
    triangles: int
    bytes: int
    seconds: float
    export: float
    memory: int


def measure_sizes(setting: Setting, formats: Formats, data: Path) -> list[Size]:
    """A level in all formats, and in all ways of writing GLB."""
    source = data / "map" / SIZED
    if not source.exists():
        setting.note(f"{SIZED} is not there: no sizes")
        return []
    outputs = [setting.scratch / f"sized.{ending}" for ending in formats.meshes]
    setting.planecut.build(source, outputs)
    sizes = {path.suffix[1:]: path.stat().st_size for path in outputs}
    for variant in formats.ways_of_glb():
        setting.planecut.build(source, outputs[:1], *variant.options)
        sizes[f"glb, {variant.name}"] = outputs[0].stat().st_size
    return [Size(source.name, name, size, size / sizes["glb"]) for name, size in sizes.items()]


def measure_million(setting: Setting, formats: Formats) -> list[Million]:
    """Plain and packed."""
    source, output = write_million(setting.scratch), setting.scratch / "million.glb"
    measured = []
    ways = [(way.name, way.options) for way in formats.variants if way.name in PACKED]
    for name, options in [("plain", ()), *ways]:
        report, run = setting.planecut.build(source, [output], *options)
        seconds = report["time_ms"]["export"] / 1000.0
        size, triangles = output.stat().st_size, report["mesh"]["triangles"]
        measured.append(Million(name, triangles, size, run.seconds, seconds, run.memory))
        output.unlink()
    return measured
