"""Which files are written of each input."""

from dataclasses import dataclass
from pathlib import Path

from .inputs import Input
from .paint import painted
from .planecut import Refused
from .setting import SIZE, Setting

PLAIN = "plain"
MESHES = ("glb", "gltf", "obj", "stl", "ply", "3mf")
SINGLE_PRECISION = ("glb", "gltf", "stl")
MODELS = ("map", "csg")

MAX_CELLS = 2000
"""Brushes above which the cells of an input are not written."""


@dataclass(frozen=True)
class Variant:
    """A way to write a format that is not the plain one."""

    name: str
    ending: str
    options: tuple[str, ...]


def _variant(name: str, ending: str, options: str) -> Variant:
    return Variant(name, ending, tuple(options.split()))


VARIANTS = (
    _variant("quantized", "glb", "--quantize"),
    _variant("meshopt", "glb", "--meshopt"),
    _variant("quantized meshopt", "glb", "--quantize --meshopt"),
    _variant("cells", "glb", "--cells"),
    _variant("textured", "glb", "--uv source --tangents"),
    _variant("all", "glb", "--uv box --tangents --smooth 30 --vertex-colors --ids"),
    _variant("all packed", "glb", "--uv box --tangents --smooth 30 --vertex-colors --ids --quantize --meshopt"),
    _variant("textured smooth", "obj", "--uv source --smooth 30"),
    _variant("textured smooth", "ply", "--uv source --smooth 30"),
    _variant("text", "ply", "--text"),
    _variant("text", "stl", "--text"),
)


@dataclass(frozen=True)
class Asset:
    """A file, of which input it is, what planecut reports of it, and how it was asked for."""

    input: str
    variant: str
    path: Path
    report: dict
    options: tuple[str, ...] = ()

    @property
    def ending(self) -> str:
        """The file's format."""
        return self.path.suffix[1:]

    @property
    def keeps_topology(self) -> bool:
        """Whether the file tells which vertices are one; glTF does by `EXT_mesh_manifold`, which trimesh does not know.

        PLY has one number for a corner's place and all else, so that vertices are split where they have a normal.
        """
        return self.ending in ("obj", "3mf", "glb", "gltf") or (self.ending == "ply" and "--smooth" not in self.options)

    @property
    def where(self) -> str:
        """What to call it in messages."""
        return f"{self.input} ({self.ending}{'' if self.variant == PLAIN else ', ' + self.variant})"


@dataclass(frozen=True)
class Written:
    """All files of an input, and its preview, painted, if there is one."""

    input: Input
    assets: list[Asset]
    preview: Path | None


@dataclass(frozen=True)
class Formats:
    """What the program can write."""

    meshes: list[str]
    models: list[str]
    variants: list[Variant]

    def ways_of_glb(self) -> list[Variant]:
        """Those that are GLB."""
        return [variant for variant in self.variants if variant.ending == "glb"]

    @classmethod
    def probe(cls, setting: Setting, extra: list[str]) -> "Formats":
        """Tries every ending and every way; notes those that are refused."""
        variants = [*VARIANTS, *(_variant(options, "glb", options) for options in extra)]

        def known(ending: str, *options: str) -> bool:
            accepted = setting.planecut.accepts(ending, *options)
            if not accepted:
                setting.note(f"this planecut does not write .{ending}{' with ' * bool(options)}{' '.join(options)}")
            return accepted

        return cls(
            meshes=[ending for ending in MESHES if known(ending)],
            models=[ending for ending in MODELS if known(ending)],
            variants=[variant for variant in variants if known(variant.ending, *variant.options)],
        )


def write_assets(setting: Setting, formats: Formats, source: Input) -> Written | None:
    """All files of an input; nothing, with a note, where planecut refuses it."""
    stem = setting.scratch / source.name.replace("/", "__")
    # The report is of the first: of a format in double precision, where planecut writes any.
    endings = sorted(formats.meshes, key=lambda ending: ending in SINGLE_PRECISION)
    plain = [stem.with_name(f"{stem.name}.{ending}") for ending in endings]
    try:
        report, _ = setting.planecut.build(source.path, plain)
    except Refused as refused:
        setting.note(f"{source.name} is left out: {str(refused).replace(str(source.path.parent) + '/', '')}")
        return None
    assets = [Asset(source.name, PLAIN, path, report) for path in plain]
    further: list[tuple[str, str, tuple[str, ...]]] = [(PLAIN, ending, ()) for ending in formats.models]
    further += [(variant.name, variant.ending, variant.options) for variant in formats.variants]
    for name, ending, options in further:
        if name == "cells" and report["model"]["brushes"] > MAX_CELLS and not setting.full:
            continue
        path = stem.with_name(f"{stem.name}.{name.replace(' ', '_')}.{ending}")
        try:
            report, _ = setting.planecut.build(source.path, [path], *options)
        except Refused as refused:
            setting.fail(f"{source.name} ({ending}, {name})", refused)
        else:
            assets.append(Asset(source.name, name, path, report, options))
    return Written(source, assets, _preview(setting, source, stem.with_name(stem.name + ".preview.png")))


def _preview(setting: Setting, source: Input, picture: Path) -> Path | None:
    try:
        setting.planecut.render(painted(source.path, setting.scratch), picture, SIZE)
    except Refused as refused:
        setting.note(f"{source.name} cannot be painted, its silhouettes are left out: {refused}")
        return None
    return picture
