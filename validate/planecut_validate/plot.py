"""A plot of differences as SVG."""

import html
import math

from .result import SAME, Result
from .table import short

_KINDS = (
    ("volume, against manifold3d", "#1b6ca8", ("OBJ volume", "volume")),
    ("area", "#e07a1f", ("area", "area by cells of a grid")),
    ("cells, against the skin", "#2e8b57", ("sum of cells",)),
    ("volume after import", "#8a4fbe", ("volume as manifold3d takes it",)),
    ("line crossings, of the diagonal", "#777777", ()),
)
"""Name, colour and differences of each kind of dot."""

_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _BOTTOM = 1000, 380, 60, 10, 40, 30
_LOWEST, _HIGHEST = -17, -5


def differences_plot(results: list[Result]) -> str:
    """Relative differences on a logarithmic scale, models from left to right."""
    parts = [f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" xmlns="http://www.w3.org/2000/svg" font-family="sans-serif">']
    for power in range(_LOWEST + 1, _HIGHEST + 1, 2):
        parts += _level(10.0**power, f"1e{power}", 'stroke="#e4e4e4"')
    parts += _level(SAME, "", 'stroke="#b00020" stroke-dasharray="6 4"')
    parts += _level(0.0, "0", 'stroke="#e4e4e4"')
    for number, (name, color, keys) in enumerate(_KINDS):
        x = _LEFT + 185 * number
        parts.append(_dot(x, 16, 4, color) + "</circle>" + _text(x + 9, 20, name, "start"))
        parts += _dots(results, color, keys)
    return "\n".join(parts) + "\n</svg>"


def _level(value: float, name: str, stroke: str) -> list[str]:
    y = _y(value)
    return [f'<path d="M{_LEFT} {y:.1f}H{_WIDTH - _RIGHT}" {stroke}/>', _text(_LEFT - 8, y + 4, name, "end")]


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="12" text-anchor="{anchor}">{html.escape(text)}</text>'


def _dot(x: float, y: float, radius: float, color: str) -> str:
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}" fill="{color}" fill-opacity="0.7">'


def _dots(results: list[Result], color: str, keys: tuple[str, ...]) -> list[str]:
    step = (_WIDTH - _LEFT - _RIGHT) / max(1, len(results))
    radius = max(1.2, min(4.0, step / 3.0))
    dots = []
    for number, result in enumerate(results):
        values = [result.differences[key] for key in keys if key in result.differences]
        if not keys and "deviation" in result.lines:
            values = [result.lines["deviation"]]
        for value in values:
            title = html.escape(f"{short(result.model)}: {value:.1e}")
            place = _dot(_LEFT + step * (number + 0.5), _y(value), radius, color)
            dots.append(f"{place}<title>{title}</title></circle>")
    return dots


def _y(value: float) -> float:
    power = math.log10(value) if value > 0.0 else _LOWEST
    part = (min(max(power, _LOWEST), _HIGHEST) - _LOWEST) / (_HIGHEST - _LOWEST)
    return _HEIGHT - _BOTTOM - part * (_HEIGHT - _BOTTOM - _TOP)
