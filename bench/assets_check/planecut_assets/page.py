"""The tables, on standard output and as the Markdown page in the text of `page.template.md`."""

from collections import defaultdict
from pathlib import Path

from .browser import Shown
from .measure import Volume
from .results import Results
from .silhouette import Silhouette

_TEMPLATE = Path(__file__).resolve().parents[1] / "page.template.md"


def write_page(path: Path, results: Results) -> None:
    """Writes the page."""
    text = _TEMPLATE.read_text(encoding="utf-8")
    for name, part in _parts(results).items():
        text = text.replace("{{" + name + "}}", part)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def summary(results: Results) -> str:
    """The tables of the page, one after another."""
    parts = _parts(results)
    titles = {
        "codes": "glTF validator",
        "volumes": "volumes",
        "shown": "three.js",
        "silhouettes": "silhouettes",
        "sizes": "sizes",
        "million": "a million triangles",
    }
    return "\n\n".join(f"{title}\n{parts[name]}" for name, title in titles.items())


def _parts(results: Results) -> dict[str, str]:
    return {
        "run": f"{results.processor}, shared with other work; {results.versions}; {results.seconds:.0f} s",
        "files": f"{results.files} files of {results.inputs} inputs",
        "validated": str(results.validated),
        "codes": _codes(results),
        "volumes": _volumes(results.volumes),
        "shown": _shown(results.shown),
        "silhouettes": _silhouettes(results.shown),
        "sizes": _sizes(results),
        "million": _million(results),
        "notes": _list(results.notes, "Nothing."),
        "failures": _list(results.failures, "Nothing was amiss."),
    }


def _codes(results: Results) -> str:
    rows = [
        [code.severity, f"`{code.code}`", code.message, str(code.count), str(code.files), code.example]
        for code in results.codes
    ]
    return (
        _table(["severity", "code", "the first of them", "messages", "files", "for one"], rows, left=3)
        if rows
        else "No messages at all."
    )


def _volumes(volumes: list[Volume]) -> str:
    """By format and reader: how many files, and the one that is farthest off for what its precision allows."""
    groups = defaultdict(list)
    for volume in volumes:
        groups[volume.where.rpartition("(")[2].rstrip(")"), volume.by].append(volume)
    rows = []
    for (kind, reader), found in sorted(groups.items()):
        worst = max(found, key=lambda volume: abs(volume.difference))
        tightest = max(found, key=lambda volume: abs(volume.difference) / volume.allowed if volume.allowed else 0.0)
        part = abs(tightest.difference) / tightest.allowed if tightest.allowed else 0.0
        amiss = sum(volume.amiss for volume in found)
        rows.append([kind, reader, str(len(found)), str(amiss), f"{abs(worst.difference):.0e}", f"{100 * part:.2g} %"])
    return _table(["file", "reader", "files", "amiss", "largest difference", "of what may be"], rows, left=2)


def _shown(shown: list[Shown]) -> str:
    groups = defaultdict(list)
    for one in shown:
        if one.facts["triangles"]:
            attributes = ", ".join(f"{name} {kind}" for name, kind in sorted(one.facts["attributes"].items()))
            groups[one.variant, attributes].append(one)
    rows = [
        [variant, attributes, str(len(found)), str(sum(one.facts["triangles"] for one in found))]
        + [str(sum(len(one.facts["materials"]) for one in found)), str(sum(one.facts["textures"] > 0 for one in found))]
        for (variant, attributes), found in groups.items()
    ]
    return _table(["GLB", "attributes", "files", "triangles", "materials", "with textures"], rows, left=2)


def _silhouettes(shown: list[Shown]) -> str:
    """A row for each input: the plain file in full, of the other ways the least overlap."""
    inputs: dict[str, list[Silhouette]] = defaultdict(list)
    for one in shown:
        if one.silhouette:
            inputs[one.input].append(one.silhouette)
    rows = []
    for name, (first, *others) in inputs.items():
        least = f"{min(other.overlap for other in others):.4f}" if others else ""
        rows.append([name, f"{first.overlap:.4f}", str(first.strays), str(first.pixels), least])
    return _table(["input", "overlap", "strays", "pixels", "least of others"], rows, left=1)


def _sizes(results: Results) -> str:
    rows = [[size.variant, f"{size.bytes:,}", f"{100 * size.part:.1f} %"] for size in results.sizes]
    return _table(["file", "bytes", "of the plain GLB"], rows, left=1)


def _million(results: Results) -> str:
    rows = [
        [one.variant, f"{one.triangles:,}", f"{one.bytes:,}", f"{one.export:.2f}", f"{one.seconds:.2f}"]
        + [f"{one.memory / 1e6:,.0f}", f"{one.memory / one.bytes:.1f}"]
        for one in results.million
    ]
    return _table(["GLB", "triangles", "bytes", "s to write", "s in all", "peak MB", "peak / file"], rows, left=1)


def _list(lines: list[str], none: str) -> str:
    return "\n".join(f"- {line}" for line in lines) or none


def _table(head: list[str], rows: list[list[str]], left: int) -> str:
    rules = ["---" if column < left else "---:" for column in range(len(head))]
    lines = ["| " + " | ".join(head) + " |", "|" + "|".join(rules) + "|"]
    return "\n".join(lines + ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows])
