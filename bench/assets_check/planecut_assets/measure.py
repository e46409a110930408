"""Volumes, and how far one may be from planecut's."""

from dataclasses import dataclass

import numpy as np

ROUNDING = 1e-12
"""Of volumes and lengths: what sums in double precision, here and there, may differ by."""


@dataclass(frozen=True)
class Surface:
    """What triangles measure: the volume within, their area, and the largest of the coordinates."""

    volume: float
    area: float
    extent: float

    @classmethod
    def of(cls, vertices: np.ndarray, triangles: np.ndarray) -> "Surface":
        """In double precision, seen from the middle."""
        if len(triangles) == 0:
            return cls(0.0, 0.0, 0.0)
        vertices = np.asarray(vertices, float)
        middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
        a, b, c = np.moveaxis((vertices - middle)[triangles], 1, 0)
        volume = float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)
        area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)
        return cls(volume, area, float(np.abs(vertices).max()))


@dataclass(frozen=True)
class Volume:
    """A volume that was found, and how it compares with the one that planecut reports.

    `difference` is relative to planecut's, `allowed` the most that it may be.
    """

    where: str
    by: str
    found: float
    difference: float
    allowed: float

    @property
    def amiss(self) -> bool:
        """Whether it is another volume."""
        return not abs(self.difference) <= self.allowed

    def __str__(self) -> str:
        return (
            f"{self.by} finds the volume {self.found:.9g}, off by {self.difference:.1e} where {self.allowed:.1e} may be"
        )


def compare(where: str, by: str, found: Surface, report: dict, half_step: float) -> Volume:
    """The volume beside that of the report.

    `half_step` is the farthest that writing moves a coordinate. A vertex then moves by √3 times that at most, and the
    volume changes by no more than the surface's area times the way (the terms of second order are far below the
    rounding of sums). So a file in single precision is good to area · √3 · largest coordinate · 2⁻²⁴, however large or
    thin the solid is.
    """
    expected = report["mesh"]["volume"]
    allowed = found.area * np.sqrt(3.0) * (half_step + ROUNDING * found.extent) + ROUNDING * abs(expected)
    scale = abs(expected) or 1.0
    return Volume(where, by, found.volume, (found.volume - expected) / scale, float(allowed / scale))
