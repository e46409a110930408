"""`text`: glyphs of a font of this machine as loops, by the library that OpenSCAD uses for them (FreeType).

OpenSCAD asks for glyphs of 100,000 64ths of a point at 100 dots per inch, hinted as for a screen of that size, and takes what
it gets, in 64ths of a pixel, for parts of `size`: 100,000 of them for outlines, 102,400 for distances between glyphs and lines.
Advances alone are not hinted.
"""

import subprocess
from functools import lru_cache

import freetype
import numpy as np

from .fragments import Resolution
from .regions import Loops
from .text import Node, ScadError
from .values import number

_UNIT, _DISTANCE, _PIXEL = 100_000, 102_400, 64


def written(node: Node) -> Loops:
    """The glyphs of a text from left to right, outlines as the font turns them. Raises `ScadError` without a font."""
    text, size = node.get("text", 0), number(node.get("size", 1), 10.0)
    if not isinstance(text, str) or not size > 0.0:
        return []
    font = str(node.get("font", 2) or "")
    try:
        path, index = _file(font)
        face = _opened(path, index)
    except (OSError, freetype.FT_Exception) as error:
        raise ScadError(node.line, f"no font for {font!r}: {error}") from error
    steps = max(Resolution.of(node).fragments(size) // 8 + 1, 2)
    kerned = str(node.get("script") or "latn")[:4].lower() in _KERNED
    loops = _line(face, text, steps, number(node.get("spacing"), 1.0), node.get("halign"), node.get("valign"), kerned)
    return [size * loop for loop in loops]


_KERNED = {"latn", "cyrl", "grek", "armn", "geor"}
"""Scripts whose letters are moved together in pairs. Of a script that there is not (`Lati` in some files) none are."""


def _line(face: "_Face", text: str, steps: int, spacing: float, across, up, kerned: bool) -> Loops:
    glyphs = [face.glyph(character) for character in text]
    kerns = [face.kern(*pair) if kerned else 0.0 for pair in zip(text, text[1:])] + [0.0]
    ends = np.cumsum([0.0] + [(g.advance + kern) * spacing / _DISTANCE for g, kern in zip(glyphs, kerns)])
    above = max([0.0] + [g.top / _DISTANCE for g in glyphs])
    below = max([0.0] + [-g.bottom / _DISTANCE for g in glyphs])
    x = {"right": -ends[-1], "center": -0.5 * ends[-1]}.get(across, 0.0)
    y = {"top": -above, "center": 0.5 * (below - above), "bottom": below}.get(up, 0.0)
    return [loop + [x + end, y] for glyph, end in zip(glyphs, ends) for loop in glyph.loops(steps)]


@lru_cache
def _file(font: str) -> tuple[str, int]:
    """The file that this machine takes for the name of a font, and the face in it. Raises `OSError` where there is none."""
    command = ["fc-match", "--format=%{file}\n%{index}", font]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split("\n")
        return found[0], int(found[1] or 0)
    except (subprocess.CalledProcessError, IndexError, ValueError) as error:
        raise OSError(str(error)) from error


@lru_cache
def _opened(path: str, index: int) -> "_Face":
    return _Face(path, index)


class _Face:
    """A font in the size that OpenSCAD asks for."""

    def __init__(self, path: str, index: int):
        self._face = freetype.Face(path, index)
        self._face.set_char_size(0, _UNIT, 100, 100)
        self._glyphs: dict[str, _Glyph] = {}

    def glyph(self, character: str) -> "_Glyph":
        """The glyph of a character, or that of a font's missing ones."""
        if character not in self._glyphs:
            self._glyphs[character] = _Glyph(self._face, self._face.get_char_index(character))
        return self._glyphs[character]

    def kern(self, first: str, second: str) -> float:
        """What is added between two glyphs, in 64ths of a pixel."""
        return float(self._face.get_kerning(first, second, freetype.FT_KERNING_UNFITTED).x)


class _Glyph:
    """A glyph in 64ths of a pixel: its advance, its height in whole pixels, and its curves."""

    def __init__(self, face: freetype.Face, index: int):
        face.load_glyph(index, freetype.FT_LOAD_NO_HINTING)
        self.advance = float(face.glyph.advance.x)
        face.load_glyph(index, freetype.FT_LOAD_DEFAULT)
        heights = [y for _, y in face.glyph.outline.points] or [0]
        self.top, self.bottom = -(-max(heights) // _PIXEL) * _PIXEL, min(heights) // _PIXEL * _PIXEL
        self._curves: list[list[list[tuple[int, int]]]] = []
        self._loops: dict[int, Loops] = {}
        take = [lambda a, _: self._curves.append([[(a.x, a.y)]])]
        take += [lambda *points: self._curves[-1].append([(p.x, p.y) for p in points[:-1]])] * 3
        face.glyph.outline.decompose(None, *take)

    def loops(self, steps: int) -> Loops:
        """The outline with a number of straight pieces for each curve."""
        if steps not in self._loops:
            pieces = [_straight(curves, steps) for curves in self._curves]
            self._loops[steps] = [loop / _UNIT for loop in pieces if len(loop) > 2]
        return self._loops[steps]


def _straight(curves: list, steps: int) -> np.ndarray:
    """The points of one contour: a start, and of each further piece the control points and the end."""
    points = [np.array(curves[0], dtype=float)]
    t = np.arange(1, steps + 1)[:, None] / steps
    for piece in curves[1:]:
        controls = np.array([points[-1][-1], *piece], dtype=float)
        if len(piece) == 1:
            points.append(controls[1:])
            continue
        # De Casteljau's scheme, at all parameters at once.
        level = [np.broadcast_to(c, (steps, 2)) for c in controls]
        while len(level) > 1:
            level = [(1.0 - t) * a + t * b for a, b in zip(level, level[1:])]
        points.append(level[0])
    return np.concatenate(points)
