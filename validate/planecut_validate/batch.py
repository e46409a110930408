"""Many random models at once, each by its own seed."""

import json
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
    """Checks trees of consecutive seeds, in this order; failing ones are made small and kept as files."""
    seeds = range(options.seed, options.seed + count)
    one = partial(_check_tree, most_leaves=most_leaves, options=options)
    for seed, result in zip(seeds, pool.map(one, seeds, chunksize=4)):
        if result.failures:
            _keep_smallest(result, random_document(seed, most_leaves), options, keep / f"seed-{seed}.json")
        yield result


def _check_tree(seed: int, most_leaves: int, options: Options) -> Result:
    result = _check_document(random_document(seed, most_leaves), options)
    result.model = f"seed {seed} ({FAMILIES[seed % len(FAMILIES)]})"
    return result


def _check_document(model: dict, options: Options) -> Result:
    with tempfile.TemporaryDirectory(prefix="planecut-validate-") as folder:
        path = Path(folder) / "tree.json"
        path.write_text(json.dumps(model), encoding="utf-8")
        return check(path, options)


def _keep_smallest(result: Result, model: dict, options: Options, path: Path) -> None:
    """Notes the smallest tree that fails in the same way, by the first words of its first failure."""
    kind = result.failures[0].split(":")[0]

    def fails(node: dict) -> bool:
        return any(f.split(":")[0] == kind for f in _check_document(document(node), options).failures)

    smallest = document(shrink(model["model"], fails))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(smallest) + "\n", encoding="utf-8")
    text = json.dumps(smallest)
    result.notes.append(
        f"{leaves(smallest['model'])} leaves left, in {path}: {text[:_SHOWN]}{'…' * (len(text) > _SHOWN)}"
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
