"""Lines over the number of cells, as SVG."""

import html
import math
from collections.abc import Iterator
from dataclasses import dataclass

_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _BOTTOM = 960, 460, 78, 236, 80, 58
_APART = 24.0
"""Least distance of two marks on the axis of cells."""
_BELOW = 0.05
"""What may lie below the lowest level, as a part of a step."""
_INK, _QUIET, _GRID = "#1f2630", "#5b6673", "#e6eaef"


@dataclass(frozen=True)
class Line:
    """Points `(cells, part)` under a name; of a colour, dashed or not; without a line between them where `loose`."""

    name: str
    color: str
    points: list[tuple[int, float]]
    dashed: bool = False
    loose: bool = False


def plot(title: str, lines: list[Line]) -> str:
    """Numbers of cells from left to right, logarithmic; parts upwards as percents."""
    axes = _Axes.of(lines)
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" '
        f'viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" height="{_HEIGHT}">',
        f"<title>{html.escape(title)}</title>",
        "<style>text { font-family: Helvetica, Arial, 'Liberation Sans', sans-serif; font-size: 14px }</style>",
        f'<rect x="0.5" y="0.5" width="{_WIDTH - 1}" height="{_HEIGHT - 1}" rx="10" fill="#ffffff" stroke="#d3d9e1"/>',
        _text(_LEFT, 38, title, "start", _INK, ' font-weight="bold" style="font-size: 17px"'),
        *axes.drawn(),
    ]
    for line in lines:
        parts += _drawn(line, axes)
    return "\n".join([*parts, *_legend(lines), "</svg>"]) + "\n"


@dataclass(frozen=True)
class _Axes:
    """`counts`: the numbers of cells that occur; `step`, and the numbers of the lowest and the highest level: of the parts."""

    counts: list[int]
    step: float
    bottom: int
    top: int

    @classmethod
    def of(cls, lines: list[Line]) -> "_Axes":
        counts = sorted({count for line in lines for count, _ in line.points})
        parts = [part for line in lines for _, part in line.points]
        # Cells that miss much of a solid have less volume than it.
        lowest, highest = min(0.0, *parts), max(parts)
        steps = [base * 10.0**power for power in range(-4, 4) for base in (1.0, 2.0, 5.0)]
        step = next(step for step in steps if (highest - lowest) / step <= 7.0)
        return cls(counts, step, math.floor(lowest / step + _BELOW), math.ceil(highest / step))

    def x(self, count: int) -> float:
        part = math.log(count / self.counts[0]) / math.log(self.counts[-1] / self.counts[0])
        return _LEFT + 14 + part * (_WIDTH - _LEFT - _RIGHT - 28)

    def y(self, part: float) -> float:
        above = (part / self.step - self.bottom) / (self.top - self.bottom)
        return _HEIGHT - _BOTTOM - above * (_HEIGHT - _TOP - _BOTTOM)

    def drawn(self) -> Iterator[str]:
        """Levels with their percents, numbers of cells with their marks, and the names of both."""
        for number in range(self.bottom, self.top + 1):
            y = self.y(number * self.step)
            color = _GRID if number else _QUIET
            yield f'<path d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}" stroke="{color}"/>'
            yield _text(_LEFT - 10, y + 5, f"{100.0 * number * self.step:g} %", "end", _QUIET)
        foot = _HEIGHT - _BOTTOM
        last = -math.inf
        for count in self.counts:
            x = self.x(count)
            # The last one always has its mark.
            if count == self.counts[-1] or min(x - last, self.x(self.counts[-1]) - x) >= _APART:
                last = x
                yield f'<path d="M{x:.1f} {foot}v6" stroke="{_QUIET}"/>'
                yield _text(x, foot + 22, str(count), "middle", _QUIET)
        yield _text((_LEFT + _WIDTH - _RIGHT) / 2, foot + 44, "convex cells", "middle", _INK)
        yield _text(_LEFT, _TOP - 16, "volume added", "start", _INK)


def _drawn(line: Line, axes: _Axes) -> Iterator[str]:
    places = [(axes.x(count), axes.y(part)) for count, part in sorted(line.points)]
    if not line.loose:
        path = " L".join(f"{x:.1f} {y:.1f}" for x, y in places)
        yield f'<path d="M{path}" {_stroke(line)}/>'
    for (x, y), (count, part) in zip(places, sorted(line.points)):
        told = html.escape(f"{line.name}: {count} cells, {100.0 * part:.1f} %")
        yield f"{_mark(x, y, line)}<title>{told}</title></path>"


def _stroke(line: Line) -> str:
    dashes = ' stroke-dasharray="6 4"' if line.dashed else ""
    return f'fill="none" stroke="{line.color}" stroke-width="2.2" stroke-linejoin="round"{dashes}'


def _mark(x: float, y: float, line: Line) -> str:
    """A dot on a line, hollow on a dashed one, a diamond where there is no line."""
    if line.loose:
        shape = f"M{x - 6.0:.1f} {y:.1f}l6 -6l6 6l-6 6Z"
    else:
        shape = f"M{x - 3.5:.1f} {y:.1f}a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0Z"
    fill = "#ffffff" if line.dashed else line.color
    return f'<path d="{shape}" fill="{fill}" stroke="{line.color}" stroke-width="1.5">'


def _legend(lines: list[Line]) -> Iterator[str]:
    """Beside the axes."""
    left = _WIDTH - _RIGHT + 22
    for number, line in enumerate(lines):
        y = _TOP + 6 + 26 * number
        if not line.loose:
            yield f'<path d="M{left} {y}h30" {_stroke(line)}/>'
        yield f"{_mark(left + 15, y, line)}</path>"
        yield _text(left + 40, y + 5, line.name, "start", _INK)


def _text(x: float, y: float, text: str, anchor: str, color: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{color}"{more}>{html.escape(text)}</text>'
