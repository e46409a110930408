"""`text`: glyphs of a font of this machine as loops."""

import subprocess
from functools import lru_cache

import numpy as np
from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

from .fragments import Resolution
from .regions import Loops
from .text import Node, ScadError
from .values import number

_POINTS = 100.0 / 72.0
"""Em squares per unit of `size`: OpenSCAD takes it for points at 100 per inch."""
_CLOSER = 1000.0 / 1024.0
"""OpenSCAD counts outlines in thousandths, but distances between glyphs and lines in 1024ths."""


def written(node: Node) -> Loops:
    """The glyphs of a text from left to right, outlines as the font turns them. Raises `ScadError` without a font."""
    text, size = node.get("text", 0), number(node.get("size", 1), 10.0)
    if not isinstance(text, str) or not size > 0.0:
        return []
    font = str(node.get("font", 2) or "")
    try:
        face = _face(font)
    except OSError as error:
        raise ScadError(node.line, f"no font for {font!r}: {error}") from error
    steps = max(Resolution.of(node).fragments(size) // 8 + 1, 2)
    scale = size * _POINTS / face.em
    names = face.names(text)
    spacing = number(node.get("spacing"), 1.0)
    loops, at = [], 0.0
    heights = [0.0]
    for k, name in enumerate(names):
        glyph = face.loops(name, steps)
        loops += [loop + [at, 0.0] for loop in glyph]
        heights += [y for loop in glyph for y in (loop[:, 1].min(), loop[:, 1].max())]
        at += (face.advance(name) + (face.kern(name, names[k + 1]) if k + 1 < len(names) else 0.0)) * spacing * _CLOSER
    shift = [_across(node.get("halign"), at), _up(node.get("valign"), max(heights) * _CLOSER, min(heights) * _CLOSER)]
    return [(loop + shift) * scale for loop in loops]


def _across(word, width: float) -> float:
    return {"right": -width, "center": -0.5 * width}.get(word, 0.0)


def _up(word, top: float, bottom: float) -> float:
    return {"top": -top, "center": -0.5 * (top + bottom), "bottom": -bottom}.get(word, 0.0)


@lru_cache
def _face(font: str) -> "_Face":
    """The font that this machine takes for that name. Raises `OSError` where there is none."""
    command = ["fc-match", "--format=%{file}\n%{index}", font]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n")
        return _opened(found[0], int(found[1] or 0))
    except (subprocess.CalledProcessError, IndexError, ValueError) as error:
        raise OSError(str(error)) from error


@lru_cache
def _opened(path: str, index: int) -> "_Face":
    return _Face(TTFont(path, fontNumber=index))


class _Face:
    """A font with what texts need of it, in its own units."""

    def __init__(self, font: TTFont):
        self.em = font["head"].unitsPerEm
        self._glyphs, self._cmap = font.getGlyphSet(), font.getBestCmap()
        self._kern = font["kern"].kernTables[0].kernTable if "kern" in font else {}
        self._outlines: dict = {}

    def names(self, text: str) -> list[str]:
        return [self._cmap.get(ord(c), ".notdef") for c in text]

    def advance(self, name: str) -> float:
        return self._glyphs[name].width

    def kern(self, name: str, after: str) -> float:
        return self._kern.get((name, after), 0)

    def loops(self, name: str, steps: int) -> Loops:
        if (name, steps) not in self._outlines:
            pen = _Pen(self._glyphs, steps)
            self._glyphs[name].draw(pen)
            self._outlines[name, steps] = [np.array(loop, dtype=float) for loop in pen.loops if len(loop) > 2]
        return self._outlines[name, steps]


class _Pen(BasePen):
    """Curves as so many straight pieces each."""

    def __init__(self, glyphs, steps: int):
        super().__init__(glyphs)
        self.loops: list = []
        self._parts = np.arange(1, steps + 1)[:, None] / steps

    def _moveTo(self, point):
        self.loops.append([point])

    def _lineTo(self, point):
        self.loops[-1].append(point)

    def _qCurveToOne(self, control, end):
        a, b, c, t = np.array(self._getCurrentPoint()), np.array(control), np.array(end), self._parts
        self.loops[-1] += map(tuple, (a * (1 - t) ** 2 + 2.0 * b * t * (1 - t) + c * t**2).tolist())

    def _curveToOne(self, first, second, end):
        a, b, c, d = (np.array(p) for p in (self._getCurrentPoint(), first, second, end))
        t = self._parts
        every = a * (1 - t) ** 3 + 3.0 * b * t * (1 - t) ** 2 + 3.0 * c * t**2 * (1 - t) + d * t**3
        self.loops[-1] += map(tuple, every.tolist())
