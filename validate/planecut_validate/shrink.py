"""Makes a failing tree smaller for as long as it still fails."""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor

_LISTS = ("union", "intersection", "difference", "xor")


def shrink(tree, fails: Callable, pool: Executor, seconds: float = 120.0, smaller=None, size=None):
    """The smallest tree found in this time that still fails; several candidates are tried at once.

    `smaller`: all trees that are one step smaller; `size`: what is to become less; those of a NODE where none are named.
    """
    smaller, size = smaller or smaller_nodes, size or leaves
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        candidates = sorted(smaller(tree), key=size)
        found = None
        for at in range(0, len(candidates), _AT_ONCE):
            several = candidates[at : at + _AT_ONCE]
            found = next((c for c, failed in zip(several, pool.map(fails, several)) if failed), None)
            if found is not None or time.monotonic() >= end:
                break
        if found is None:
            break
        tree = found
    return tree


_AT_ONCE = 16


def leaves(node: dict) -> int:
    """Bodies in a node."""
    operands = _operands(node)
    return sum(map(leaves, operands)) if operands else 1


def _operands(node: dict) -> list[dict]:
    for kind in _LISTS:
        if kind in node:
            return node[kind]
    return [node["complement"]] if "complement" in node else []


def smaller_nodes(node: dict) -> Iterator[dict]:
    """Trees with one node replaced by one of its operands, one operand less, or one transform less."""
    yield from _operands(node)
    # The complement of a complement is not bounded by itself.
    for inner in _operands(node) if "complement" in node else []:
        yield from _operands(inner)
    if "transform" in node:
        yield {key: value for key, value in node.items() if key != "transform"}
        for i in range(len(node["transform"])):
            yield node | {"transform": node["transform"][:i] + node["transform"][i + 1 :]}
    if "complement" in node:
        for inner in smaller_nodes(node["complement"]):
            yield {"complement": inner}
    for kind in _LISTS:
        operands = node.get(kind, [])
        if len(operands) > 1:
            yield from ({kind: operands[:i] + operands[i + 1 :]} for i in range(len(operands)))
        for i, operand in enumerate(operands):
            yield from ({kind: [*operands[:i], inner, *operands[i + 1 :]]} for inner in smaller_nodes(operand))
