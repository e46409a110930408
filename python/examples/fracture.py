"""A Voronoi fracture of any closed mesh or solid: pieces that fit without a gap. Writes fracture.glb and fracture.png.

python examples/fracture.py [output folder] [mesh file] [number of pieces]
"""

import sys
from math import fsum
from pathlib import Path

import numpy as np
import planecut as pc

STONES = ["granite", "marble", "slate", "basalt", "sand", "chalk"]


def sites_in(solid, count, rng):
    """Points within a solid, shape (count, 3), evenly distributed."""
    low, high = solid.bounds
    points = np.zeros((0, 3))
    while len(points) < count:
        more = rng.uniform(low, high, (4 * count, 3))
        points = np.concatenate([points, more[solid.contains(more)]])
    return points[:count]


def fracture(solid, sites):
    """The parts of a solid that are nearest to each of the sites, shape (n, 3)."""
    squares = np.sum(sites**2, axis=1)
    pieces = []
    for number in range(len(sites)):
        # nearer to the site s than to another t: (t - s) · x <= (t · t - s · s) / 2
        planes = np.column_stack([sites - sites[number], (squares - squares[number]) / 2])
        planes = np.delete(planes, number, axis=0)
        # a neighbour has the same plane with opposite signs, to the last bit: pieces leave no gap and do not overlap
        pieces.append(solid & pc.halfspaces(planes[used(planes)]))
    return pieces


def used(planes):
    """Which planes carry a face of the body that all of them bound; the others are not needed."""
    body = pc.Polytope(planes)
    return np.isin(body.plane_ids, body.face_planes)


def apart(pieces, factor):
    """Pieces moved away from their common center."""
    centers = np.array([piece.centroid for piece in pieces])
    shifts = factor * (centers - centers.mean(axis=0))
    # as one body a piece is its mesh: how it was cut out of the whole is not worked out again
    bodies = [piece.as_one_body().translate(shift) for piece, shift in zip(pieces, shifts)]
    return pc.union([body.with_material(STONES[number % len(STONES)]) for number, body in enumerate(bodies)])


def main(folder=".", mesh=None, count=24, seed=1):
    """Fractures the solid in a file, by default a vase; returns the whole and its pieces."""
    whole = vase() if mesh is None else pc.load(mesh)
    pieces = fracture(whole, sites_in(whole, int(count), np.random.default_rng(seed)))
    pieces = [piece for piece in pieces if not piece.is_empty]
    moved = apart(pieces, 0.35)
    moved.save(Path(folder) / "fracture.glb")
    moved.save(Path(folder) / "fracture.png", size=(1200, 900), elevation=20)
    return whole, pieces


def vase(segments=48):
    """A vase with a wall of even thickness."""
    z = np.linspace(0, 10, 21)
    radius = 2.2 + 1.1 * np.sin(z * 0.62) - 0.05 * z
    wall = np.concatenate([np.column_stack([radius, z]), np.column_stack([radius - 0.35, np.maximum(z, 0.5)])[::-1]])
    return pc.revolve(np.concatenate([[[0, 0]], wall, [[0, 0.5]]]), segments=segments)


if __name__ == "__main__":
    solid, parts = main(*sys.argv[1:4])
    total = fsum(piece.volume for piece in parts)
    difference = abs(total / solid.volume - 1)
    print(
        f"{len(parts)} pieces: {total:.15g} in all, the whole {solid.volume:.15g}, relative difference {difference:.1e}"
    )
