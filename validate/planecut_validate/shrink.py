"""Makes a failing tree smaller for as long as it still fails."""

import time
from collections.abc import Callable, Iterator

_LISTS = ("union", "intersection", "difference", "xor")


def shrink(node: dict, fails: Callable[[dict], bool], seconds: float = 120.0) -> dict:
    """The smallest NODE found in this time that still fails."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for smaller in sorted(_smaller(node), key=leaves):
            if time.monotonic() >= end:
                break
            if fails(smaller):
                node = smaller
                break
        else:
            break
    return node


def leaves(node: dict) -> int:
    """Bodies in a node."""
    operands = _operands(node)
    return sum(map(leaves, operands)) if operands else 1


def _operands(node: dict) -> list[dict]:
    for kind in _LISTS:
        if kind in node:
            return node[kind]
    return [node["complement"]] if "complement" in node else []


def _smaller(node: dict) -> Iterator[dict]:
    """Trees with one node replaced by one of its operands, one operand less, or one transform less."""
    yield from _operands(node)
    if "transform" in node:
        yield {key: value for key, value in node.items() if key != "transform"}
        for i in range(len(node["transform"])):
            yield node | {"transform": node["transform"][:i] + node["transform"][i + 1 :]}
    if "complement" in node:
        for inner in _smaller(node["complement"]):
            yield {"complement": inner}
    for kind in _LISTS:
        operands = node.get(kind, [])
        if len(operands) > 1:
            yield from ({kind: operands[:i] + operands[i + 1 :]} for i in range(len(operands)))
        for i, operand in enumerate(operands):
            yield from ({kind: [*operands[:i], inner, *operands[i + 1 :]]} for inner in _smaller(operand))
