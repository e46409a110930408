"""Answers that do not come from planecut: numpy, scipy, manifold3d and fractions."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import planecut as pc
import pytest

DATA = Path(__file__).resolve().parents[2] / ".." / "shared" / "data"
SEED = int(os.environ.get("PLANECUT_SEED", "28"))
"""Another one tries other random cases."""


def data(*parts: str) -> Path:
    """A file of the shared data; the test is skipped where it is absent."""
    path = DATA.joinpath(*parts)
    if not path.exists():
        pytest.skip(f"{path} is absent")
    return path


def generator(number: int = 0) -> np.random.Generator:
    """Random numbers that can be had again; the seed is printed, which pytest shows for a test that fails."""
    print(f"PLANECUT_SEED={SEED}, case {number}")
    return np.random.default_rng([SEED, number])


def box_points(low: Any, high: Any) -> np.ndarray:
    """The corners of a box, shape (8, 3)."""
    corners = np.array(np.meshgrid(*zip(low, high), indexing="ij"), dtype=float)
    return corners.reshape(3, -1).T


def random_affine(rng: np.random.Generator) -> np.ndarray:
    """An affine map of shape (3, 4) that is far from singular; it may mirror."""
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return np.column_stack([turn * rng.uniform(0.5, 1.5, size=3), rng.normal(size=3) * 0.3])


class Tree:
    """A random expression that planecut, manifold3d and numpy each read in their own way."""

    def __init__(self, rng: np.random.Generator, leaves: int, with_moves: bool = True) -> None:
        self.matrix = random_affine(rng) if with_moves and rng.random() < 0.4 else None
        self.operands: list[Tree] = []
        if leaves == 1:
            self.operation = "hull"
            count = int(rng.integers(4, 14))
            points = rng.normal(size=(count, 3)) if rng.random() < 0.6 else box_points(rng.uniform(-1, 0, 3), rng.uniform(0.2, 1, 3))
            self.points = points + rng.normal(size=3) * 0.4
        else:
            self.operation = str(rng.choice(["or", "sub", "and", "xor"], p=[0.4, 0.3, 0.15, 0.15]))
            first = int(rng.integers(1, leaves))
            self.operands = [Tree(rng, first), Tree(rng, leaves - first)]

    def solid(self) -> pc.Solid:
        if self.operation == "hull":
            solid = pc.hull(self.points)
        else:
            a, b = (operand.solid() for operand in self.operands)
            solid = {"or": a.__or__, "sub": a.__sub__, "and": a.__and__, "xor": a.__xor__}[self.operation](b)
        return solid if self.matrix is None else solid.transform(self.matrix)

    def manifold(self) -> Any:
        import manifold3d

        if self.operation == "hull":
            body = manifold3d.Manifold.hull_points(self.points)
        else:
            a, b = (operand.manifold() for operand in self.operands)
            body = {"or": lambda: a + b, "sub": lambda: a - b, "and": lambda: a ^ b, "xor": lambda: (a - b) + (b - a)}[self.operation]()
        return body if self.matrix is None else body.transform(self.matrix)

    def contains(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Whether each point is inside, and how far it is from the planes of the bodies, at least."""
        from scipy.spatial import ConvexHull

        if self.matrix is not None:
            points = np.linalg.solve(self.matrix[:, :3], (points - self.matrix[:, 3]).T).T
        if self.operation == "hull":
            planes = ConvexHull(self.points).equations
            sides = points @ planes[:, :3].T + planes[:, 3]
            return (sides <= 0.0).all(axis=1), np.abs(sides).min(axis=1)
        (a, clear), (b, also) = (operand.contains(points) for operand in self.operands)
        inside = {"or": a | b, "sub": a & ~b, "and": a & b, "xor": a ^ b}[self.operation]
        return inside, np.minimum(clear, also)


def voxel_tree(rng: np.random.Generator, leaves: int, size: int) -> tuple[pc.Solid, np.ndarray]:
    """An expression of boxes with whole coordinates, and the voxels that it fills."""
    if leaves == 1:
        low = rng.integers(0, size - 1, 3)
        high = rng.integers(low + 1, size + 1)
        voxels = np.zeros((size, size, size), bool)
        voxels[tuple(slice(a, b) for a, b in zip(low, high))] = True
        return pc.box(low, high), voxels
    first = int(rng.integers(1, leaves))
    (a, of_a), (b, of_b) = voxel_tree(rng, first, size), voxel_tree(rng, leaves - first, size)
    match rng.integers(5):
        case 0:
            return a - b, of_a & ~of_b
        case 1:
            return a & b, of_a & of_b
        case 2:
            return a ^ b, of_a ^ of_b
        case 3:
            return a & ~b, of_a & ~of_b
        case _:
            return a | b, of_a | of_b


def first_hits(vertices: np.ndarray, triangles: np.ndarray, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each ray the distance to the first triangle, inf for none, and its number; every triangle is tried (Möller and Trumbore)."""
    directions = directions / np.linalg.norm(directions, axis=1)[:, None]
    a, b, c = (vertices[triangles[:, k]][None] for k in range(3))
    origins, rays = origins[:, None], directions[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        p = np.cross(rays, c - a)
        scale = 1.0 / np.einsum("rti,rti->rt", np.broadcast_to(b - a, p.shape), p)
        u = np.einsum("rti,rti->rt", origins - a, p) * scale
        q = np.cross(origins - a, b - a)
        v = np.einsum("rti,rti->rt", np.broadcast_to(rays, q.shape), q) * scale
        t = np.einsum("rti,rti->rt", np.broadcast_to(c - a, q.shape), q) * scale
        is_hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & np.isfinite(scale)
    t = np.where(is_hit, t, np.inf)
    return t.min(axis=1, initial=np.inf), t.argmin(axis=1) if t.shape[1] else np.zeros(len(t), int)


def mesh_volume(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """The volume by the divergence theorem."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


def mesh_area(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """The sum of the areas of triangles."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def is_closed(triangles: np.ndarray) -> bool:
    """Whether every directed edge comes once, and once the other way."""
    edges = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]).astype(np.int64)
    forward = {tuple(edge) for edge in edges.tolist()}
    return len(forward) == len(edges) and all((b, a) in forward for a, b in forward)


def raised(work: Callable[[], object]) -> BaseException:
    """What work raises; the test fails where it raises nothing."""
    try:
        result = work()
    except BaseException as error:  # a PanicException of PyO3 is no Exception
        return error
    raise AssertionError(f"expected an exception, found {result!r}")


def assert_refused(work: Callable[[], object], *kinds: type[BaseException]) -> None:
    """Work raises one of the ordinary exceptions, with a message of one line."""
    error = raised(work)
    assert type(error) in (kinds or (pc.PlanecutError, TypeError, OverflowError)), repr(error)
    message = str(error)
    assert message.strip() and "\n" not in message, repr(message)
    assert "panic" not in message.lower() and ".rs" not in message
