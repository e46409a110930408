"""Reads the brushes of a Quake-family `.map` as exact integer half-spaces.

A brush is a list of faces `( p0 ) ( p1 ) ( p2 ) texture …` whose plane through the three points has the outward normal
`(p0 − p1) × (p2 − p1)`. Taken are 5 or more trailing numbers, Valve 220 texture axes, and `brushDef` texture matrices,
mixed at will. Patches, `brushDef3` and other primitives are skipped.
"""

import math
import re
from dataclasses import dataclass
from decimal import Decimal

IntPlane = tuple[int, int, int, int]
"""Integers `(a, b, c, d)` of the half-space `a·x + b·y + c·z ≤ d`, without a common factor."""


class MapSyntaxError(ValueError):
    """The text is not a map; the message names the line."""


@dataclass(frozen=True)
class MapBrush:
    """One brush: where it stands, its half-spaces (faces without an area left out), its texture names."""

    line: int
    planes: list[IntPlane]
    textures: list[str]


_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_POINT = rf"\(\s*({_NUMBER})\s+({_NUMBER})\s+({_NUMBER})\s*\)"
_ROW = rf"\(\s*{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}\s*\)"
_AXIS = rf"\[\s*{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}\s*\]"
_TEXTURE = r'("[^"\n]*"|[^\s"]\S*)'

_SKIP = re.compile(r"(?:\s+|//[^\n]*)*")
_POINTS = re.compile(rf"{_POINT}\s*{_POINT}\s*{_POINT}\s*")
_LAYOUTS = (
    re.compile(rf"{_TEXTURE}\s+{_AXIS}\s*{_AXIS}(?:\s+{_NUMBER}){{3,}}(?!\S)"),
    re.compile(rf"\(\s*{_ROW}\s*{_ROW}\s*\)\s*{_TEXTURE}(?:\s+{_NUMBER})*(?!\S)"),
    re.compile(rf"{_TEXTURE}(?:\s+{_NUMBER}){{5,}}(?!\S)"),
)
# A backslash before the last quote of a line ends a path ("c:\quake\"), it does not escape.
_STRING = re.compile(r'"(?:[^"\\\n]|\\"(?!\s*(?:\n|$))|\\)*"')
_WORD = re.compile(r"[^\s{}\"]+")


def read_map(text: str) -> list[MapBrush]:
    """The brushes of all entities, in the order of the file. Raises `MapSyntaxError`."""
    return _Reader(text).entities()


class _Reader:
    """A cursor over the text."""

    def __init__(self, text: str):
        self.text = text
        self.at = 0
        self.brushes: list[MapBrush] = []

    def entities(self) -> list[MapBrush]:
        while self.peek():
            self.expect("{")
            # A brush outside any entity, as editors put it on the clipboard.
            if self.peek() == "(":
                self.brush(self.line())
            else:
                self.entity()
        return self.brushes

    def entity(self) -> None:
        while (mark := self.peek()) != "}":
            if mark == '"':
                self.match(_STRING, "a quoted string")
            elif mark == "{":
                self.at += 1
                self.primitive()
            else:
                raise self.error("a key, a brush or '}'")
        self.at += 1

    def primitive(self) -> None:
        """A brush, or something else in braces inside braces."""
        start = self.line()
        if self.peek() in "({}":
            self.brush(start)
            return
        kind = self.match(_WORD, "a face or the kind of a primitive").group()
        self.expect("{")
        if kind.lower() == "brushdef":
            self.brush(start)
        else:
            self.skip_braces()
        self.expect("}")

    def brush(self, start: int) -> None:
        planes, textures = [], []
        while self.peek() != "}":
            points = self.match(_POINTS, "three points").groups()
            layout = next((m for m in (p.match(self.text, self.at) for p in _LAYOUTS) if m), None)
            if layout is None:
                raise self.error("a texture and its layout")
            self.at = layout.end()
            plane = plane_through([Decimal(p) for p in points])
            if plane is not None:
                planes.append(plane)
                textures.append(layout.group(1).strip('"'))
        self.at += 1
        self.brushes.append(MapBrush(start, planes, textures))

    def skip_braces(self) -> None:
        depth = 1
        while depth:
            mark = self.peek()
            if mark in "{}" and mark:
                depth += 1 if mark == "{" else -1
                self.at += 1
            else:
                self.match(_STRING if mark == '"' else _WORD, "'}'")

    def peek(self) -> str:
        """The next character behind white space and comments; empty at the end."""
        self.at = _SKIP.match(self.text, self.at).end()
        return self.text[self.at : self.at + 1]

    def expect(self, mark: str) -> None:
        if self.peek() != mark:
            raise self.error(f"'{mark}'")
        self.at += 1

    def match(self, pattern: re.Pattern, wanted: str) -> re.Match:
        self.peek()
        found = pattern.match(self.text, self.at)
        if found is None:
            raise self.error(wanted)
        self.at = found.end()
        return found

    def line(self) -> int:
        return self.text.count("\n", 0, self.at) + 1

    def error(self, wanted: str) -> MapSyntaxError:
        found = self.text[self.at : self.at + 20].split("\n")[0] or "the end"
        return MapSyntaxError(f"line {self.line()}: expected {wanted}, found {found!r}")


def plane_through(coordinates: list[Decimal]) -> IntPlane | None:
    """The exact half-space of a face from its nine coordinates, or nothing where the points lie on one line."""
    places = max(0, *(-c.as_tuple().exponent for c in coordinates))
    x = [int(c.scaleb(places)) for c in coordinates]
    p0, p1, p2 = x[0:3], x[3:6], x[6:9]
    normal = cross([a - b for a, b in zip(p0, p1)], [a - b for a, b in zip(p2, p1)])
    if not any(normal):
        return None
    offset = sum(n * p for n, p in zip(normal, p0))
    plane = [n * 10**places for n in normal] + [offset]
    factor = math.gcd(*plane)
    return tuple(value // factor for value in plane)


def cross(a: list[int], b: list[int]) -> list[int]:
    """The cross product of two integer vectors."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
