"""Numbers written as expressions: `=width / 2 - sin(30)`."""

import math
import re
from collections.abc import Callable

from ..angles import cosine, sine
from .text import ModelError

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)|(?P<mark>[-+*/%^(),]))"
)


def _tangent(angle: float) -> float:
    return sine(angle) / cosine(angle)


def _round(value: float) -> float:
    """Halves away from zero."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


def _degrees(function: Callable) -> Callable:
    return lambda *values: math.degrees(function(*values))


_FUNCTIONS: dict[str, tuple[int | None, Callable]] = {
    "sqrt": (1, math.sqrt), "abs": (1, abs), "floor": (1, math.floor), "ceil": (1, math.ceil), "round": (1, _round),
    "min": (None, min), "max": (None, max), "sin": (1, sine), "cos": (1, cosine), "tan": (1, _tangent),
    "asin": (1, _degrees(math.asin)), "acos": (1, _degrees(math.acos)), "atan": (1, _degrees(math.atan)),
    "atan2": (2, _degrees(math.atan2)),
}  # fmt: skip


def evaluate(text: str, parameter: Callable[[str], float]) -> float:
    """The value of an expression; `parameter` gives that of a name. Raises `ModelError`."""
    reader = _Reader(text, parameter)
    value = reader.sum()
    if reader.token is not None:
        raise ModelError(f"{text!r}: unexpected {reader.token!r}")
    return float(value)


class _Reader:
    """Recursive descent, one token ahead."""

    def __init__(self, text: str, parameter: Callable[[str], float]):
        self.text = text
        self.parameter = parameter
        self.at = 0
        self.token: str | None = None
        self.kind: str | None = None
        self.next()

    def next(self) -> None:
        """Moves to the next token; nothing at the end."""
        if not self.text[self.at :].strip():
            self.token = self.kind = None
            return
        found = _TOKEN.match(self.text, self.at)
        if found is None:
            raise ModelError(f"{self.text!r}: cannot be read from {self.text[self.at :]!r}")
        self.at = found.end()
        self.kind = found.lastgroup
        self.token = found.group(found.lastgroup)

    def take(self, mark: str) -> None:
        if self.token != mark:
            raise ModelError(f"{self.text!r}: expected {mark!r}, found {self.token!r}")
        self.next()

    def sum(self) -> float:
        value = self.product()
        while self.token in ("+", "-"):
            add = self.token == "+"
            self.next()
            other = self.product()
            value = value + other if add else value - other
        return value

    def product(self) -> float:
        value = self.signed()
        while self.token in ("*", "/", "%"):
            mark = self.token
            self.next()
            other = self.signed()
            value = value * other if mark == "*" else value / other if mark == "/" else value % other
        return value

    def signed(self) -> float:
        if self.token not in ("+", "-"):
            return self.power()
        minus = self.token == "-"
        self.next()
        value = self.signed()
        return -value if minus else value

    def power(self) -> float:
        base = self.primary()
        if self.token != "^":
            return base
        self.next()
        result = base ** self.signed()
        if isinstance(result, complex):
            raise ModelError(f"{self.text!r}: a root of a negative number")
        return result

    def primary(self) -> float:
        token, kind = self.token, self.kind
        self.next()
        if kind == "number":
            return float(token)
        if token == "(":
            value = self.sum()
            self.take(")")
            return value
        if kind == "name" and self.token == "(":
            return self.call(token)
        if kind == "name":
            return math.pi if token == "pi" else self.parameter(token)
        raise ModelError(f"{self.text!r}: expected a number, found {token!r}")

    def call(self, name: str) -> float:
        if name not in _FUNCTIONS:
            raise ModelError(f"{self.text!r}: no function {name!r}")
        count, function = _FUNCTIONS[name]
        self.take("(")
        values = [self.sum()]
        while self.token == ",":
            self.next()
            values.append(self.sum())
        self.take(")")
        if count not in (None, len(values)):
            raise ModelError(f"{self.text!r}: {name} takes {count} numbers")
        # `min` and `max` of one number are no call of Python's.
        return float(values[0] if count is None and len(values) == 1 else function(*values))
