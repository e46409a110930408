"""Many random models at once, each by its own seed."""

import json
import re
import tempfile
from collections.abc import Iterator
from concurrent.futures import Executor
from functools import partial
from pathlib import Path

from .checks import check
from .identities import check_identity
from .random_trees import FAMILIES, document, random_document
from .result import Options, Result
from .shrink import leaves, shrink


def check_random(count: int, most_leaves: int, options: Options, keep: Path, pool: Executor) -> Iterator[Result]:
    """Checks trees of consecutive seeds, in this order. The smallest that fails in each way is made smaller still."""
    seeds = range(options.seed, options.seed + count)
    one = partial(_check_tree, most_leaves=most_leaves, options=options)
    worst: dict[str, tuple[dict, Result]] = {}
    for seed, result in zip(seeds, pool.map(one, seeds, chunksize=2)):
        if result.failures:
            tree = random_document(seed, most_leaves)["model"]
            kind = _kind(result)
            if kind not in worst or leaves(tree) < leaves(worst[kind][0]):
                worst[kind] = tree, result
        yield result
    for kind, (tree, result) in worst.items():
        _keep_smallest(kind, tree, result.model, options, keep, pool)


def _check_tree(seed: int, most_leaves: int, options: Options) -> Result:
    result = _check_document(random_document(seed, most_leaves), options)
    result.model = f"seed {seed} ({FAMILIES[seed % len(FAMILIES)]})"
    return result


def _check_document(model: dict, options: Options) -> Result:
    with tempfile.TemporaryDirectory(prefix="planecut-validate-") as folder:
        path = Path(folder) / "tree.json"
        path.write_text(json.dumps(model), encoding="utf-8")
        return check(path, options)


def _kind(result: Result) -> str:
    """The first failure without what differs from tree to tree."""
    words = re.sub(r"\S*tree\.json\S*|-?\d+(\.\d+)?(e-?\d+)?", "", result.failures[0])
    return re.sub(r"\s+", " ", words)[:60].strip(" :")


def _fails(node: dict, kind: str, options: Options) -> bool:
    result = _check_document(document(node), options)
    return bool(result.failures) and _kind(result) == kind


def _keep_smallest(kind: str, tree: dict, name: str, options: Options, keep: Path, pool: Executor) -> None:
    """Writes and prints the smallest tree found that fails in this way."""
    smallest = shrink(tree, partial(_fails, kind=kind, options=options), pool)
    keep.mkdir(parents=True, exist_ok=True)
    path = keep / (re.sub(r"\W+", "-", name).strip("-") + ".json")
    text = json.dumps(document(smallest))
    path.write_text(text + "\n", encoding="utf-8")
    shown = text[:_SHOWN] + "…" * (len(text) > _SHOWN)
    print(f"smallest found with {kind!r}, from {name}: {leaves(smallest)} leaves, in {path}\n    {shown}", flush=True)


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
