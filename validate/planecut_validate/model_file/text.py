"""JSON text to values, and values taken out of them with the place named where one does not fit."""

import json
import math


class ModelError(ValueError):
    """What was found is not what a model file holds; the message names the place as a path."""


def parse(text: str) -> dict:
    """The object in the text. Raises `ValueError` where it is no JSON, repeats a key, or holds a number that is none."""
    return json.loads(text, object_pairs_hook=_object, parse_constant=_refuse)


def _object(pairs: list[tuple]) -> dict:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ModelError("a repeated key")
    return found


def _refuse(name: str):
    raise ModelError(f"{name} is not a number of JSON")


def fail(path: str, wanted: str):
    """Raises `ModelError`."""
    raise ModelError(f"{path}: expected {wanted}")


def check_keys(value, path: str, allowed) -> dict:
    """The object, where it is one and holds no other keys."""
    if not isinstance(value, dict):
        fail(path, "an object")
    for key in value:
        if key not in allowed:
            fail(f"{path}.{key}", f"one of {', '.join(sorted(allowed))}")
    return value


def check_list(value, path: str) -> list:
    """The list, where it is one."""
    if not isinstance(value, list):
        fail(path, "a list")
    return value


def check_finite(value: float, path: str) -> float:
    """The number, where it is one."""
    if not math.isfinite(value):
        fail(path, "a finite number")
    return float(value)
