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

_WIDTH, _HEIGHT, _LEFT, _TOP, _BOTTOM = 1000, 380, 70, 40, 30
_LOWEST, _HIGHEST = -17, -5


def differences_plot(results: list[Result]) -> str:
    """Relative differences on a logarithmic scale, models from left to right."""
    parts = [
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" xmlns="http://www.w3.org/2000/svg" font-family="sans-serif" font-size="12">'
    ]
    for power in range(_LOWEST + 1, _HIGHEST + 1, 2):
        y = _y(10.0**power)
        parts.append(
            f'<path d="M{_LEFT} {y:.1f}H{_WIDTH}" stroke="#e4e4e4"/><text x="{_LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">1e{power}</text>'
        )
    parts.append(f'<path d="M{_LEFT} {_y(SAME):.1f}H{_WIDTH}" stroke="#b00020" stroke-dasharray="6 4"/>')
    parts.append(f'<text x="{_LEFT - 8}" y="{_y(0.0) + 4:.1f}" text-anchor="end">0</text>')
    for number, (name, color, keys) in enumerate(_KINDS):
        x = _LEFT + 185 * number
        parts.append(f'<circle cx="{x}" cy="16" r="4" fill="{color}"/><text x="{x + 9}" y="20">{name}</text>')
        parts += _dots(results, color, keys)
    return "\n".join(parts) + "\n</svg>"


def _dots(results: list[Result], color: str, keys: tuple[str, ...]) -> list[str]:
    step = (_WIDTH - _LEFT) / max(1, len(results))
    radius = max(1.2, min(4.0, step / 3.0))
    dots = []
    for number, result in enumerate(results):
        values = [result.differences[key] for key in keys if key in result.differences]
        if not keys and "deviation" in result.lines:
            values = [result.lines["deviation"]]
        title = html.escape(short(result.model))
        for value in values:
            x = _LEFT + step * (number + 0.5)
            dots.append(
                f'<circle cx="{x:.1f}" cy="{_y(value):.1f}" r="{radius:.1f}" fill="{color}" fill-opacity="0.7"><title>{title}: {value:.1e}</title></circle>'
            )
    return dots


def _y(value: float) -> float:
    power = math.log10(value) if value > 0.0 else _LOWEST
    part = (min(max(power, _LOWEST), _HIGHEST) - _LOWEST) / (_HIGHEST - _LOWEST)
    return _HEIGHT - _BOTTOM - part * (_HEIGHT - _BOTTOM - _TOP)
