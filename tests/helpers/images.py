"""Measurements of pictures: sizes, colours, a perceptual hash, and positions of texts."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from curvcli.errors import MissingExtraError
from curvcli.output.pictures.render import require_opengl
from curvcli.output.pictures.sheet import Sheet

Pixels = NDArray[np.uint8]


@pytest.fixture(scope="module")
def opengl() -> None:
    """Skips what cannot be drawn on this machine."""
    try:
        require_opengl()
    except MissingExtraError as error:
        pytest.skip(str(error))


def decoded(png: bytes) -> tuple[Pixels, dict[str, str]]:
    """The pixels (height, width, 3) and the texts of a PNG."""
    from PIL import Image

    with Image.open(io.BytesIO(png)) as image:
        texts = {key: str(value) for key, value in image.info.items() if isinstance(value, str)}
        return np.asarray(image.convert("RGB")), texts


def near(pixels: Pixels, color: tuple[int, int, int], tolerance: int = 24) -> NDArray[np.bool_]:
    """Mask of the pixels with about this colour."""
    return (np.abs(pixels.astype(int) - color) <= tolerance).all(axis=-1)


def difference_hash(pixels: Pixels, side: int = 16) -> NDArray[np.bool_]:
    """Perceptual hash: cells of a coarse grid that are brighter than their left neighbour."""
    grey = pixels.astype(float).mean(axis=2)
    rows = np.array_split(np.arange(grey.shape[0]), side)
    columns = np.array_split(np.arange(grey.shape[1]), side + 1)
    cells = np.array([[grey[np.ix_(row, column)].mean() for column in columns] for row in rows])
    # Cells that differ by less than a grey value are alike; rounding must not decide.
    return np.diff(np.round(cells / 2), axis=1) > 0


def boxes(sheet: Sheet) -> list[tuple[str, Any]]:
    """Every text of a sheet with its box in pixels, the labels of its axes included."""
    renderer = sheet.canvas.get_renderer()
    texts = list(sheet.figure.texts)
    for axes in sheet.figure.axes:
        for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            ticks = axis.get_major_ticks()
            texts += [tick.label1 for tick in ticks if low - 1e-9 <= tick.get_loc() <= high + 1e-9]
    return [(text.get_text(), text.get_window_extent(renderer)) for text in texts if text.get_text()]


def collisions(sheet: Sheet) -> list[str]:
    """Texts that are cut off by the sheet's edge, or lie on each other."""
    found = boxes(sheet)
    wrong = [
        f"{text!r} leaves the sheet"
        for text, box in found
        if box.x0 < -1 or box.y0 < -1 or box.x1 > sheet.width + 1 or box.y1 > sheet.height + 1
    ]
    for place, (text, box) in enumerate(found):
        for other, second in found[place + 1 :]:
            wide = min(box.x1, second.x1) - max(box.x0, second.x0)
            high = min(box.y1, second.y1) - max(box.y0, second.y0)
            if wide > 1 and high > 0.35 * min(box.height, second.height):
                wrong.append(f"{text!r} lies on {other!r}")
    return wrong
