"""Many random models at once, each by its own seed."""

import json
import re
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from .checks import check
from .csg_file import random_files
from .csg_file.printing import printed
from .identities import check_identity
from .random_trees import FAMILIES, document, random_document
from .result import Options, Result
from .shrink import leaves, shrink, smaller_nodes


@dataclass(frozen=True)
class Source:
    """Random trees of one file format: `make(seed, most leaves)`, their text, and how they become smaller."""

    suffix: str
    families: tuple[str, ...]
    make: Callable
    text: Callable[[object], str]
    smaller: Callable
    leaves: Callable[[object], int]


def _model_text(node: dict) -> str:
    return json.dumps(document(node)) + "\n"


def _model_node(seed: int, most_leaves: int) -> dict:
    return random_document(seed, most_leaves)["model"]


MODELS = Source(".json", FAMILIES, _model_node, _model_text, smaller_nodes, leaves)
CSG = Source(
    ".csg", random_files.FAMILIES, random_files.random_nodes, printed, random_files.smaller, random_files.leaves
)


def check_random(
    source: Source, count: int, most_leaves: int, options: Options, keep: Path, pool: Executor
) -> Iterator[Result]:
    """Checks trees of consecutive seeds, in this order. The smallest that fails in each way is made smaller still."""
    seeds = range(options.seed, options.seed + count)
    one = partial(_check_tree, source=source, most_leaves=most_leaves, options=options)
    worst: dict[str, tuple[object, Result]] = {}
    for seed, result in zip(seeds, pool.map(one, seeds, chunksize=2)):
        if result.failures:
            tree = source.make(seed, most_leaves)
            kind = _kind(result)
            if kind not in worst or source.leaves(tree) < source.leaves(worst[kind][0]):
                worst[kind] = tree, result
        yield result
    for kind, (tree, result) in worst.items():
        _keep_smallest(source, kind, tree, result.model, options, keep, pool)


def _check_tree(seed: int, source: Source, most_leaves: int, options: Options) -> Result:
    result = _check_text(source, source.text(source.make(seed, most_leaves)), options)
    result.model = f"seed {seed} ({source.families[seed % len(source.families)]})"
    return result


def _check_text(source: Source, text: str, options: Options) -> Result:
    with tempfile.TemporaryDirectory(prefix="planecut-validate-") as folder:
        path = Path(folder) / f"tree{source.suffix}"
        path.write_text(text, encoding="utf-8")
        return check(path, options)


def _kind(result: Result) -> str:
    """The first failure without what differs from tree to tree."""
    words = re.sub(r"\S*tree\.(json|csg)\S*|-?\d+(\.\d+)?(e-?\d+)?", "", result.failures[0])
    return re.sub(r"\s+", " ", words)[:60].strip(" :")


def _fails(tree, source: Source, kind: str, options: Options) -> bool:
    result = _check_text(source, source.text(tree), options)
    return bool(result.failures) and _kind(result) == kind


def _keep_smallest(source: Source, kind: str, tree, name: str, options: Options, keep: Path, pool: Executor) -> None:
    """Writes and prints the smallest tree found that fails in this way."""
    fails = partial(_fails, source=source, kind=kind, options=options)
    smallest = shrink(tree, fails, pool, smaller=source.smaller, size=source.leaves)
    keep.mkdir(parents=True, exist_ok=True)
    path = keep / (re.sub(r"\W+", "-", name).strip("-") + source.suffix)
    text = source.text(smallest)
    path.write_text(text, encoding="utf-8")
    shown = text[:_SHOWN].rstrip() + "…" * (len(text) > _SHOWN)
    print(
        f"smallest found with {kind!r}, from {name}: {source.leaves(smallest)} leaves, in {path}\n{shown}", flush=True
    )


_SHOWN = 1500
"""Characters of a tree that are printed."""


def check_many_identities(
    count: int, most_leaves: int, options: Options, keep: Path, pool: Executor
) -> Iterator[Result]:
    """Checks identities of consecutive seeds, over solids of a fifth of the leaves; failing ones are kept as files."""
    seeds = range(options.seed, options.seed + count)
    one = partial(check_identity, most_leaves=max(1, most_leaves // 5), options=options)
    for seed, (result, sides) in zip(seeds, pool.map(one, seeds, chunksize=4)):
        if result.failures:
            keep.mkdir(parents=True, exist_ok=True)
            for side, model in sides.items():
                (keep / f"identity-{seed}-{side}.json").write_text(json.dumps(model) + "\n", encoding="utf-8")
            result.notes.append(f"both sides in {keep}/identity-{seed}-*.json")
        yield result
