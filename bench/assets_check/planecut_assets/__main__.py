"""`bench/assets [options]`: writes assets, has them read, prints, exits with 1 where something is amiss."""

import argparse
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from . import machine
from .assets import MODELS, Asset, Formats, Written, write_assets
from .browser import show_all
from .figures import measure_million, measure_sizes
from .inputs import all_inputs, write_empty
from .measure import Volume
from .meshes import check_mesh
from .package import check_package
from .page import summary, write_page
from .planecut import Planecut
from .results import Results
from .round_trip import check_round_trip
from .setting import SIZE, Setting
from .validator import validate

_PROJECT = Path(__file__).resolve().parents[3]


def main() -> int:
    """The exit status: 1 where something is amiss, 2 where nothing can be checked."""
    arguments = _arguments()
    if not os.access(arguments.planecut, os.X_OK):
        return _unusable(f"{arguments.planecut}: no such program")
    if not arguments.data.is_dir():
        return _unusable(f"{arguments.data}: no such folder; name the one with the data with --data")
    with tempfile.TemporaryDirectory() as scratch:
        results = _checked(arguments, Path(scratch))
        if arguments.pictures:
            _keep_pictures(Path(scratch), arguments.pictures)
    print("\n" + summary(results))
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        arguments.json.write_text(results.json(), encoding="utf-8")
    if arguments.markdown:
        write_page(arguments.markdown, results)
    print(f"\n{results.files} files of {results.inputs} inputs, {len(results.failures)} amiss, {results.seconds:.0f} s")
    for failure in results.failures:
        print(f"FAIL {failure}")
    return 1 if results.failures else 0


def _checked(arguments: argparse.Namespace, scratch: Path) -> Results:
    begin = time.perf_counter()
    setting = Setting(Planecut(arguments.planecut), scratch, arguments.full)
    chromium = setting.program(("chromium", "chromium-browser"), "chromium", "three.js is")
    openscad = setting.program(("openscad",), "openscad", "reading of trees by it is")
    formats = Formats.probe(setting, arguments.variant)
    written: list[Written] = []
    volumes: list[Volume] = []
    for source in all_inputs(_PROJECT, arguments.data, arguments.quick, arguments.full):
        inputs = write_assets(setting, formats, source)
        if inputs is not None:
            written.append(inputs)
            volumes += _read_again(setting, inputs, openscad)
    validated, codes = validate(setting, [asset for inputs in written for asset in inputs.assets])
    shown = show_all(setting, chromium, written, _empty_preview(setting)) if chromium else []
    return Results(
        processor=machine.processor(),
        versions=machine.versions(chromium, openscad),
        inputs=len(written),
        files=sum(len(inputs.assets) for inputs in written),
        validated=validated,
        codes=codes,
        volumes=volumes + [one.volume for one in shown],
        shown=shown,
        sizes=measure_sizes(setting, formats, arguments.data),
        million=[] if arguments.quick else measure_million(setting, formats),
        notes=setting.notes,
        failures=setting.failures,
        seconds=time.perf_counter() - begin,
    )


def _read_again(setting: Setting, inputs: Written, openscad: str | None) -> list[Volume]:
    """What all readers but three.js find in the files of an input."""
    begin, amiss = time.perf_counter(), len(setting.failures)
    volumes = []
    for asset in inputs.assets:
        for check in _checks(asset, openscad):
            try:
                volumes += check(setting, asset)
            # Whatever a reader throws at a file is a finding.
            except Exception as error:
                setting.fail(asset.where, f"{type(error).__name__}: {error}")
    triangles = inputs.assets[0].report["mesh"]["triangles"]
    verdict = "ok" if len(setting.failures) == amiss else "AMISS"
    seconds = time.perf_counter() - begin
    print(
        f"{inputs.input.name:<52} {triangles:>8} triangles {len(volumes):>3} volumes {seconds:6.1f} s {verdict}",
        flush=True,
    )
    return volumes


def _checks(asset: Asset, openscad: str | None) -> list[Callable[[Setting, Asset], list[Volume]]]:
    """What a file goes through."""
    if asset.ending in MODELS:
        return [partial(check_round_trip, openscad=openscad)]
    return [check_mesh, check_package] if asset.ending == "3mf" else [check_mesh]


def _empty_preview(setting: Setting) -> Path:
    picture = setting.scratch / "empty.png"
    setting.planecut.render(write_empty(setting.scratch), picture, SIZE)
    return picture


def _keep_pictures(scratch: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for picture in scratch.glob("*.png"):
        shutil.copy(picture, folder)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench/assets", description="Has planecut's assets read by others.")
    add = parser.add_argument
    amount = parser.add_mutually_exclusive_group()
    amount.add_argument("--quick", action="store_true", help="few inputs of each kind, no million triangles")
    amount.add_argument("--full", action="store_true", help="all inputs, however large, and OpenSCAD on large trees")
    add("--data", type=Path, default=_PROJECT.parent / "shared/data", help="folder of the inputs (default %(default)s)")
    add("--planecut", type=Path, required=True, help="the program to check (default: built by bench/assets)")
    add(
        "--variant", action="append", default=[], metavar="OPTIONS", help="also write GLB with these options of `build`"
    )
    add("--json", type=Path, help="writes all that was found")
    add("--markdown", type=Path, help="writes the page")
    add("--pictures", type=Path, metavar="FOLDER", help="keeps previews and screenshots")
    return parser.parse_args()


def _unusable(message: str) -> int:
    print(f"error: {message}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
