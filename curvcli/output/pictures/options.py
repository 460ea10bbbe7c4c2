"""Options of pictures: view, size and background; independent of the drawing libraries."""

from __future__ import annotations

import importlib.util
import math
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

from ...errors import MissingExtraError, UsageError

# Directions of view: azimuth about z from x, and elevation above the xy plane, in degrees.
VIEWS = {"iso": (-45.0, math.degrees(math.asin(1 / math.sqrt(3)))), "front": (-90.0, 0.0), "top": (-90.0, 90.0)}
FIT = "fit"
SMALLEST, LARGEST = 200, 8192
# Pixels of a panel with the surface: of the only one, and of one among several.
PANEL, SMALL_PANEL = (1200, 900), (800, 680)
_SMALLEST_PANEL = 180
# Pixels of the layout per inch of a page.
PIXELS_PER_INCH = 100
_NUMBER = r"[+-]?\d+(?:\.\d*)?"


@dataclass(frozen=True)
class PictureOptions:
    """Options of pictures.

    view: `iso`, `front`, `top`, `fit` (along the direction in which the surface is thinnest) or `AZ,EL` in degrees.
    up: the axis of the file that points up. size: pixels, None for a size by the number of panels.
    background: a name of matplotlib or #rrggbb. edges: true to draw the edges of all faces. dpi: pixels per inch of the
    surface on a page (.pdf, .svg), where 100 pixels of the size are an inch.
    """

    view: str = "iso"
    up: Literal["y", "z"] = "z"
    size: tuple[int, int] | None = None
    background: str = "white"
    edges: bool = False
    dpi: int = 300

    @property
    def finer(self) -> float:
        """Pixels of the surface on a page per pixel of the layout."""
        return self.dpi / PIXELS_PER_INCH


def parse_view(text: str) -> tuple[float, float] | None:
    """Azimuth and elevation in degrees, None for `fit`.

    Errors: UsageError.
    """
    name = text.strip().lower()
    if name == FIT:
        return None
    if name in VIEWS:
        return VIEWS[name]
    if re.fullmatch(rf"{_NUMBER},{_NUMBER}", name):
        azimuth, elevation = map(float, name.split(","))
        if abs(azimuth) <= 360 and abs(elevation) <= 90:
            return azimuth, elevation
    raise UsageError(
        f"--view {text}: expected {', '.join(VIEWS)}, {FIT}, or AZ,EL in degrees up to 360 and 90, such as 30,20"
    )


def parse_size(text: str | None) -> tuple[int, int] | None:
    """Width and height in pixels of `WxH`.

    Errors: UsageError.
    """
    if text is None:
        return None
    match = re.fullmatch(r"\s*(\d{1,5})\s*[xX×]\s*(\d{1,5})\s*", text)
    if match and all(SMALLEST <= int(side) <= LARGEST for side in match.groups()):
        return int(match[1]), int(match[2])
    raise UsageError(f"--size {text}: expected WxH with sides of {SMALLEST} to {LARGEST} pixels, as 1200x900")


def check_picture_options(
    options: PictureOptions, panels: int = 1, *, surface: bool = True, page: bool = False
) -> None:
    """Refuse, before any work, a missing library, an unknown colour or view, or too small a size.

    surface: true if the surface is drawn, not only histograms. page: true if it is drawn at `options.dpi`.
    Errors: UsageError; MissingExtraError without the libraries that draw.
    """
    require_pictures(surface)
    parse_view(options.view)
    background_rgb(options.background)
    count = max(1, panels)
    across, down, size = arrange(count, options.size, PANEL if count == 1 else SMALL_PANEL)
    wide = options.finer * max(size[0] / across, size[1] / down)
    if page and wide > LARGEST:
        raise UsageError(
            f"--dpi {options.dpi}: the surface would be {wide:,.0f} pixels long, at most {LARGEST:,} can be drawn; "
            f"--dpi {int(options.dpi * LARGEST / wide)} is the most here"
        )


def arrange(count: int, size: tuple[int, int] | None, panel: tuple[int, int]) -> tuple[int, int, tuple[int, int]]:
    """Columns and rows for so many panels, and the size of the sheet in pixels.

    Errors: UsageError if the panels would be too small to read.
    """
    if size is None:
        columns = next(n for n in range(1, count + 1) if n * n * 4 >= count * 3 or n == count)
        columns = min(columns, 4)
        rows = -(-count // columns)
        return columns, rows, (min(columns * panel[0], 8192), min(rows * panel[1], 8192))
    shape = panel[0] / panel[1]
    options = [(n, -(-count // n)) for n in range(1, count + 1)]
    readable = [grid for grid in options if min(size[0] / grid[0], size[1] / grid[1]) >= _SMALLEST_PANEL]
    if not readable:
        across = math.ceil(math.sqrt(count))
        enough = f"{across * _SMALLEST_PANEL}x{-(-count // across) * _SMALLEST_PANEL}"
        raise UsageError(f"--size {size[0]}x{size[1]}: too small for {count} panels; {enough} is enough")
    columns, rows = max(readable, key=lambda grid: min(size[0] / grid[0] / shape, size[1] / grid[1]))
    return columns, rows, size


def background_rgb(color: str) -> tuple[float, float, float]:
    """Colour by name or as #rrggbb, from 0 to 1.

    Errors: UsageError.
    """
    from matplotlib.colors import to_rgb

    try:
        red, green, blue = to_rgb(color)
    except ValueError:
        raise UsageError(
            f"--background {color}: no such colour, expected a name such as white, black, or #rrggbb"
        ) from None
    return red, green, blue


def require_pictures(surface: bool = True) -> None:
    """Raise MissingExtraError if the libraries that draw a surface, or only histograms, are not installed."""
    if surface:
        _require("pictures need", "pyvista", "matplotlib")
    else:
        _require("histograms need", "matplotlib")


def import_apart(*libraries: str) -> None:
    """Import libraries on a separate stack.

    Errors: those of the imports.
    """
    with ThreadPoolExecutor(1) as other:
        for name in libraries:
            other.submit(importlib.import_module, name).result()


def _require(what: str, *libraries: str) -> None:
    missing = [name for name in libraries if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingExtraError(f"{what} {' and '.join(missing)}: `pip install 'curvcli[pictures]'`")
