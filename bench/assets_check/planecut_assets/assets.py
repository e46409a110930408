"""Which files are written of each input."""

from dataclasses import dataclass
from pathlib import Path

from .inputs import Input
from .planecut import Refused
from .setting import SIZE, Setting

PLAIN = "plain"
MESHES = ("glb", "gltf", "obj", "stl", "ply", "3mf")
MODELS = ("map", "csg")

MAX_CELLS = 2000
"""Brushes above which the cells of an input are not written."""


@dataclass(frozen=True)
class Variant:
    """A way to write GLB."""

    name: str
    options: tuple[str, ...]


@dataclass(frozen=True)
class Asset:
    """A file, of which input it is, and what planecut reports of it."""

    input: str
    variant: str
    path: Path
    report: dict

    @property
    def ending(self) -> str:
        """The file's format."""
        return self.path.suffix[1:]

    @property
    def where(self) -> str:
        """What to call it in messages."""
        return f"{self.input} ({self.ending}{'' if self.variant == PLAIN else ', ' + self.variant})"


@dataclass(frozen=True)
class Written:
    """All files of an input, and its preview."""

    input: Input
    assets: list[Asset]
    preview: Path


@dataclass(frozen=True)
class Formats:
    """What the program can write."""

    meshes: list[str]
    models: list[str]
    variants: list[Variant]

    @classmethod
    def probe(cls, setting: Setting, extra: list[str]) -> "Formats":
        """Tries every ending and every way; notes those that are refused."""
        variants = [Variant("quantized", ("--quantize",)), Variant("meshopt", ("--meshopt",))]
        variants += [Variant("quantized meshopt", ("--quantize", "--meshopt")), Variant("cells", ("--cells",))]
        variants += [Variant(options, tuple(options.split())) for options in extra]

        def known(ending: str, *options: str) -> bool:
            accepted = setting.planecut.accepts(ending, *options)
            if not accepted:
                setting.note(f"this planecut does not write .{ending}{''.join(' with ' + word for word in options)}")
            return accepted

        return cls(
            meshes=[ending for ending in MESHES if known(ending)],
            models=[ending for ending in MODELS if known(ending)],
            variants=[variant for variant in variants if known("glb", *variant.options)],
        )


def write_assets(setting: Setting, formats: Formats, source: Input) -> Written | None:
    """All files of an input; nothing, with a note, where planecut refuses it."""
    stem = setting.scratch / source.name.replace("/", "__")
    preview = stem.with_name(stem.name + ".preview.png")
    drawing = ("--preview", preview, "--preview-size", "{}x{}".format(*SIZE))
    plain = [stem.with_name(f"{stem.name}.{ending}") for ending in formats.meshes]
    try:
        report, _ = setting.planecut.build(source.path, plain, *drawing)
    except Refused as refused:
        setting.note(f"{source.name} is left out: {str(refused).replace(str(source.path.parent) + '/', '')}")
        return None
    assets = [Asset(source.name, PLAIN, path, report) for path in plain]
    further = [(PLAIN, ending, ()) for ending in formats.models]
    further += [(variant.name, "glb", variant.options) for variant in formats.variants]
    for name, ending, options in further:
        if name == "cells" and report["model"]["brushes"] > MAX_CELLS and not setting.full:
            continue
        path = stem.with_name(f"{stem.name}.{name.replace(' ', '_')}.{ending}")
        try:
            report, _ = setting.planecut.build(source.path, [path], *options)
        except Refused as refused:
            setting.fail(f"{source.name} ({ending}, {name})", refused)
        else:
            assets.append(Asset(source.name, name, path, report))
    return Written(source, assets, preview)
