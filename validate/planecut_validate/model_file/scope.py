"""What names mean: parameters, parts and outlines of a document."""

import math

from .expression import evaluate
from .text import ModelError, check_finite, check_list, fail


class Scope:
    """The names of a document, some parameters replaced.

    Replacing one changes those that are written with it: parameters are expressions until they are asked for.
    """

    def __init__(self, document: dict, replaced: dict[str, float], within: tuple[str, ...] = ()):
        self.parameters = document.get("parameters", {})
        self.parts = document.get("parts", {})
        self.outlines = document.get("outlines", {})
        self.document = document
        self.replaced = replaced
        self.within = within
        self._values: dict[str, float] = {}
        self._asked: list[str] = []

    def entered(self, name: str, replaced: dict[str, float]) -> "Scope":
        """The scope inside a part or an outline. Raises `ModelError` where that is already being read."""
        if name in self.within:
            raise ModelError(f"a circle of references through {name!r}")
        return Scope(self.document, self.replaced | replaced, (*self.within, name))

    def parameter(self, name: str) -> float:
        """The value of a parameter."""
        if name in self.replaced:
            return self.replaced[name]
        if name not in self.parameters:
            raise ModelError(f"no parameter {name!r}")
        if name in self._asked:
            raise ModelError(f"a circle of parameters through {name!r}")
        if name not in self._values:
            self._asked.append(name)
            self._values[name] = self.number(self.parameters[name], f"$.parameters.{name}")
            self._asked.pop()
        return self._values[name]

    def number(self, value, path: str) -> float:
        """A number, or what an expression comes to."""
        if isinstance(value, str) and value.startswith("="):
            try:
                return check_finite(evaluate(value[1:], self.parameter), path)
            except (ValueError, ArithmeticError) as error:
                raise ModelError(f"{path}: {error}") from error
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            fail(path, "a number")
        return check_finite(value, path)

    def positive(self, value, path: str, zero: bool = False) -> float:
        """A number above 0, or not below it."""
        number = self.number(value, path)
        if number < 0 or (number == 0 and not zero):
            fail(path, "a number not below 0" if zero else "a number above 0")
        return number

    def whole(self, value, path: str, least: int, most: int) -> int:
        """A whole number."""
        number = self.number(value, path)
        if number != math.floor(number) or not least <= number <= most:
            fail(path, f"a whole number from {least} to {most}")
        return int(number)

    def numbers(self, value, path: str, count: int) -> list[float]:
        """As many numbers in a list."""
        if len(check_list(value, path)) != count:
            fail(path, f"{count} numbers")
        return [self.number(v, f"{path}[{i}]") for i, v in enumerate(value)]

    def segments(self, value: dict, path: str, key: str = "segments") -> int:
        """Into how many parts a circle is cut."""
        return self.whole(value.get(key, 32), f"{path}.{key}", 3, 10_000)
