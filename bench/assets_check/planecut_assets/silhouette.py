"""Where the model is on a picture: of planecut's previews, and of screenshots with a transparent background."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageFilter
from scipy import ndimage

NEAR = 2
"""Pixels from the other mask's edge within which a difference is one of sampling and line width."""

DARKEST = 0.45
"""The part of its light that the floor keeps in the deepest shadow (0.5), less than which an outline leaves (half of it)."""

ALIKE = 0.012
"""How far a pixel's colour may be from that of a shadow on the background, in display values from 0 to 1."""


@dataclass(frozen=True)
class Silhouette:
    """Two masks beside each other.

    `overlap`: their intersection over their union. `strays`: pixels in one of them that are farther than `NEAR` from the
    other and from its edge. `pixels`: those of the union. `undecided`: pixels that are left out.
    """

    overlap: float
    strays: int
    pixels: int
    undecided: int

    def __str__(self) -> str:
        return f"overlap {self.overlap:.4f}, {self.strays} of {self.pixels} pixels away from the edges"


def compare_masks(ours: np.ndarray, others: np.ndarray, undecided: np.ndarray) -> Silhouette:
    """How alike they are."""
    both, either = ours & others & ~undecided, (ours | others) & ~undecided
    strays = ((ours & ~_grown(others)) | (others & ~_grown(ours))) & ~_grown(undecided)
    union = int(either.sum())
    return Silhouette(int(both.sum()) / max(union, 1), int(strays.sum()), union, int(undecided.sum()))


def mask_of_screenshot(path: Path) -> np.ndarray:
    """Where the picture is not transparent."""
    return np.asarray(Image.open(path).convert("RGBA"))[:, :, 3] >= 128


def background_of(path: Path) -> np.ndarray:
    """Linear light of the preview of an empty model."""
    return _linear(_pixels(path))


def masks_of_preview(path: Path, background: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where a preview shows the model, neither the background nor a shadow on it; and where that cannot be told.

    A shadow makes the background darker but leaves its hue. A pixel is taken for it where one factor, from `DARKEST` to 1,
    brings all three channels of the background close to it. Patches of that which the model encloses are holes where they
    are the background itself; else they may as well be faces of just that hue.
    """
    pixels = _pixels(path)
    factor = (_linear(pixels) * background).sum(axis=2) / (background * background).sum(axis=2)
    shadow = _display(background * np.clip(factor, DARKEST, 1.0)[:, :, None])
    like_shadow = np.abs(shadow - pixels).max(axis=2) <= ALIKE
    patches, count = ndimage.label(like_shadow)
    shaded = ndimage.mean(np.abs(factor - 1.0) > ALIKE, patches, np.arange(count + 1)) > 0.0
    enclosed = np.ones(count + 1, bool)
    enclosed[np.unique(np.concatenate([patches[0], patches[-1], patches[:, 0], patches[:, -1]]))] = False
    enclosed[0] = False
    return ~like_shadow, (enclosed & shaded)[patches]


def _grown(mask: np.ndarray) -> np.ndarray:
    grown = Image.fromarray(mask.astype(np.uint8) * 255).filter(ImageFilter.MaxFilter(2 * NEAR + 1))
    return np.asarray(grown) > 0


def _pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB"), float) / 255.0


def _linear(display: np.ndarray) -> np.ndarray:
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)


def _display(linear: np.ndarray) -> np.ndarray:
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1.0 / 2.4) - 0.055)
