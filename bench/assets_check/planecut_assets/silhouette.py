"""Where the model is on a picture: of planecut's previews, and of screenshots with a transparent background."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageFilter

NEAR = 2
"""Pixels from the other mask's edge within which a difference is one of sampling and line width."""

DARKEST = 0.45
"""The part of its light that the floor keeps in the deepest shadow is 0.5; an outline's middle leaves less."""

ALIKE = 0.012
"""How far a pixel's colour may be from that of a shadow on the background, in display values from 0 to 1."""


@dataclass(frozen=True)
class Silhouette:
    """Two masks beside each other.

    `overlap`: their intersection over their union. `strays`: pixels in one of them that are farther than `NEAR` from
    the other. `pixels`: those of the union.
    """

    overlap: float
    strays: int
    pixels: int

    def __str__(self) -> str:
        return f"overlap {self.overlap:.4f}, {self.strays} of {self.pixels} pixels away from the edges"


def compare_masks(ours: np.ndarray, others: np.ndarray) -> Silhouette:
    """How alike they are."""
    union = int((ours | others).sum())
    strays = (ours & ~_grown(others)) | (others & ~_grown(ours))
    return Silhouette(int((ours & others).sum()) / max(union, 1), int(strays.sum()), union)


def mask_of_screenshot(path: Path) -> np.ndarray:
    """Where the picture is not transparent."""
    return np.asarray(Image.open(path).convert("RGBA"))[:, :, 3] >= 128


def background_of(path: Path) -> np.ndarray:
    """Linear light of the preview of an empty model."""
    return _linear(_pixels(path))


def mask_of_preview(path: Path, background: np.ndarray) -> np.ndarray:
    """Where the preview of a painted model shows it: neither the background nor a shadow on it.

    A shadow makes the background darker but leaves its hue. A pixel is taken for it where one factor, from `DARKEST` to
    1, brings all three channels of the background close to it.
    """
    pixels = _pixels(path)
    factor = (_linear(pixels) * background).sum(axis=2) / (background * background).sum(axis=2)
    shadow = _display(background * np.clip(factor, DARKEST, 1.0)[:, :, None])
    return np.abs(shadow - pixels).max(axis=2) > ALIKE


def _grown(mask: np.ndarray) -> np.ndarray:
    grown = Image.fromarray(mask.astype(np.uint8) * 255).filter(ImageFilter.MaxFilter(2 * NEAR + 1))
    return np.asarray(grown) > 0


def _pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB"), float) / 255.0


def _linear(display: np.ndarray) -> np.ndarray:
    return np.where(display <= 0.04045, display / 12.92, ((display + 0.055) / 1.055) ** 2.4)


def _display(linear: np.ndarray) -> np.ndarray:
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1.0 / 2.4) - 0.055)
