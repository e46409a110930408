"""Lines, and where they cross a solid: what the line oracle's two sides have in common."""

from dataclasses import dataclass

import numpy as np

TOUCHING = 1e-9
"""Bodies closer than this along a line, relative to the model's diagonal, count as touching."""
SURELY_TOUCHING = 1e-12
"""What rounding alone explains. A gap between the two values makes a line unclear."""
CLOSE = 1e-7
"""Planes of a body that a line meets within this distance (relative to the diagonal): too near an edge or a corner."""
POSITION = 1e-6
"""Largest distance of a crossing from its place, relative to the model's diagonal."""
GRAZING = 1e-4
"""Cosine to the normal of a face below which the line is taken to graze it."""


@dataclass(frozen=True)
class Lines:
    """Points `origins` `(n, 3)` and unit `directions` `(n, 3)`."""

    origins: np.ndarray
    directions: np.ndarray

    def __len__(self) -> int:
        return len(self.origins)

    def __getitem__(self, which) -> "Lines":
        return Lines(self.origins[which], self.directions[which])

    def near(self, center: np.ndarray, radius: float) -> np.ndarray:
        """The numbers of the lines that pass the point no farther away than `radius`."""
        offset = self.origins - center
        along = np.einsum("ij,ij->i", offset, self.directions)
        return np.nonzero(np.einsum("ij,ij->i", offset, offset) - along * along <= radius * radius)[0]


@dataclass
class Crossings:
    """Where lines enter (`sign` −1) and leave (`sign` +1) a solid, sorted by line, then by `t` along the line."""

    line: np.ndarray
    t: np.ndarray
    sign: np.ndarray

    def of(self, line: int) -> "Crossings":
        """Those of one line."""
        begin, end = np.searchsorted(self.line, [line, line + 1])
        return Crossings(self.line[begin:end], self.t[begin:end], self.sign[begin:end])


@dataclass
class Coverage:
    """Crossings with a solid, and per line whether they hang on less than floating point can tell.

    `unclear` lines come close to an edge or a corner, graze a face, or meet a gap that may be one or not. `endless` lines
    do not leave the solid at one end or both.
    """

    crossings: Crossings
    unclear: np.ndarray
    endless: np.ndarray
