"""Do faces of different bodies lie in one plane? Then manifold3d's union may keep sheets of no thickness between them."""

import numpy as np

from .leaf import Leaf

_SAME_PLANE = 1e-8
"""Difference of two unit normals, or of two offsets relative to the model's size, up to which planes count as one."""


Box = tuple[np.ndarray, np.ndarray]
"""Lowest and highest corner."""


def any_coincident_faces(leaves: list[Leaf], span: Box, frame: Box | None) -> bool:
    """Whether faces of two bounded leaves lie in one plane, on either side of it, and their boxes meet.

    `span`: a box around all leaves. `frame`: that at which unbounded leaves were cut off; faces on it do not count.
    """
    low, high = span
    size = float(np.linalg.norm(high - low)) or 1.0
    planes, lows, highs, owners = _faces(leaves, 0.5 * (low + high), size)
    if frame is not None and len(planes):
        near = _SAME_PLANE * size
        on_frame = ((highs <= frame[0] + near) | (lows >= frame[1] - near)).any(1)
        planes, lows, highs, owners = planes[~on_frame], lows[~on_frame], highs[~on_frame], owners[~on_frame]
    if not len(planes):
        return False
    # Along a fixed direction in the space of planes, equal planes are neighbours.
    direction = np.array([0.5403, -0.3119, 0.6931, 0.3717])
    planes *= np.where(planes @ direction < 0, -1, 1)[:, None]
    key = planes @ direction
    order = np.argsort(key)
    planes, lows, highs, owners, key = planes[order], lows[order], highs[order], owners[order], key[order]
    margin = _SAME_PLANE * size
    for step in range(1, len(key)):
        first = np.nonzero(key[step:] - key[:-step] <= 4 * _SAME_PLANE)[0]
        if not len(first):
            return False
        second = first + step
        same = (np.abs(planes[first] - planes[second]) <= _SAME_PLANE).all(1) & (owners[first] != owners[second])
        meet = (lows[first] <= highs[second] + margin).all(1) & (lows[second] <= highs[first] + margin).all(1)
        if (same & meet).any():
            return True
    return False


def _faces(leaves: list[Leaf], middle: np.ndarray, size: float):
    """Planes `[n, d / size]` about the middle of the model, and of each the box of its face and the number of its leaf."""
    planes, lows, highs, owners = [], [], [], []
    for number, leaf in enumerate(leaves):
        for plane, corners in leaf.faces():
            planes.append([*plane[:3], (plane[3] - plane[:3] @ middle) / size])
            lows.append(corners.min(0))
            highs.append(corners.max(0))
            owners.append(number)
    return np.array(planes).reshape(-1, 4), *(np.array(a).reshape(-1, 3) for a in (lows, highs)), np.array(owners)
