"""What manifold3d answers."""

from dataclasses import dataclass, field

import manifold3d

from .leaf import mesh_of

AGREED = 1e-10
"""Relative difference up to which two answers of manifold3d are one."""


@dataclass
class ReferenceVolume:
    """The volume by manifold3d, and every answer it gave on the way, by name of the way."""

    volume: float
    answers: dict[str, float] = field(default_factory=dict)

    def spread(self) -> float:
        """The largest relative difference between two answers."""
        values = self.answers.values()
        return (max(values) - min(values)) / abs(self.volume) if self.volume else 0.0


@dataclass
class ReferenceSurface:
    """The surface by manifold3d: area, number of connected surfaces, and the sum of their genus."""

    area: float
    components: int
    genus: int

    @classmethod
    def of(cls, solid: manifold3d.Manifold) -> "ReferenceSurface":
        """That of the solid."""
        mesh = mesh_of(solid)
        return cls(mesh.area(), mesh.components(), mesh.genus())
